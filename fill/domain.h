// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of a hole that a triangle of the filling leaves open on one of its sides. Internal to
// fill/.
// Source: Zou, Ju and Carr 2013, section 3.2.1. Departure: a loop that a triangle reaches is passed
// in its own sense, unless both are asked for, so that the filling fits the shell's orientation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fill/borders.h"
#include "fill/candidates.h"

namespace watertight::fill {

/// The most loops of one hole: their sets fit into 8 bits, weak edges into 64.
inline constexpr std::size_t kMostLoops = 6;

/// The sense in which the boundary of a domain follows a loop.
enum class Sense : std::uint8_t { none = 0, forward = 1, backward = 2 };

/// A spanning edge, and the input segment from its head to the tail of the next spanning edge.
struct Span {
  Vertex tail = 0;
  Vertex head = 0;
  Vertex behind = kNoVertex;  // the third vertex of the triangle on the other side
  Sense sense = Sense::none;  // none: the segment is a single vertex
  EdgeNumber edge = kNoEdge;
};

/// The number of edges from one vertex to another one of its loop in a sense.
inline std::uint32_t steps_along(const Borders& borders, Sense sense, Vertex from, Vertex to) {
  return sense == Sense::backward ? borders.steps(to, from) : borders.steps(from, to);
}

/// A closed boundary of spanning edges and input segments, which has the domain on its left, and
/// the loops inside that no triangle has reached. A segment whose ends are one vertex and that has
/// a sense is a whole loop, so that this vertex is on the boundary twice.
struct Domain {
  std::uint8_t size = 0;       // the number of spanning edges
  std::uint8_t untouched = 0;  // a bit for each loop
  std::array<Span, kMostLoops> spans;

  const Span& after(std::size_t i) const { return spans[i + 1 < size ? i + 1 : 0]; }
};

/// Whether a domain lies between an edge and a segment of one loop, with no loop inside.
inline bool is_segment(const Domain& domain) { return domain.size == 1 && domain.untouched == 0; }

/// The length of the segment after a spanning edge, in edges.
std::uint32_t segment_length(const Borders& borders, const Domain& domain, std::size_t i);

enum class DomainKind : std::uint8_t {
  open,     // triangles are needed
  closing,  // its one spanning edge is a loop's edge: nothing is needed
  gluing,   // its two spanning edges are one edge: nothing is needed
  dead      // no triangulation exists: an edge would be used too often, or a loop is left over
};
DomainKind kind_of(const Borders& borders, const Domain& domain);

/// What is left of a domain on one side of a triangle.
struct Part {
  Domain domain;
  DomainKind kind = DomainKind::open;
  std::uint32_t number = 0;  // in the table of domains, once it was looked up
};

/// What is left of a domain beside a triangle on its first spanning edge.
struct Split {
  Vertex third = 0;
  std::uint8_t count = 0;  // 1 where the triangle reaches a loop inside, else 2
  std::array<Part, 2> parts;
};

struct SplitOptions {
  bool has_both_senses = false;  // loops inside may be passed against their sense
  bool has_angles = true;        // domains know the triangles behind their spanning edges
};

/// Appends all ways in which the triangle on the first spanning edge and a third vertex divides a
/// domain, except those with a dead part. The first spanning edge of a part is
/// one of the triangle's: edges that were there before keep the triangles behind them, so that
/// there are far fewer different domains than if they took turns.
class Splitter {
 public:
  Splitter(const Borders& borders, const Candidates& candidates, const SplitOptions& options)
      : borders_(borders), candidates_(candidates), options_(options) {}
  void append(const Domain& domain, Vertex third, std::vector<Split>& splits) const;

 private:
  struct Sides {
    Span first;   // from the tail of the access edge to the third vertex
    Span second;  // from the third vertex to the head of the access edge
  };
  void reach_loop(const Domain& domain, const Sides& sides, std::vector<Split>& splits) const;
  void reach_boundary(const Domain& domain, const Sides& sides, std::vector<Split>& splits) const;
  void divide(const Domain& domain, const Sides& sides, std::size_t segment, bool is_at_start,
              bool is_at_end, std::vector<Split>& splits) const;
  void append_living(Split split, std::vector<Split>& splits) const;

  const Borders& borders_;
  const Candidates& candidates_;
  SplitOptions options_;
};

}  // namespace watertight::fill
