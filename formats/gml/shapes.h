// SPDX-License-Identifier: GPL-3.0-or-later
// Turns the geometry elements of a GML document into the facets of its solids: follows references,
// applies orientations, reads positions. Internal to formats/.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "formats/gml/model.h"
#include "geometry/lattice/lattice.h"
#include "geometry/placement.h"
#include "geometry/solid.h"

namespace watertight::formats {

/// The element of a ring of a solid.
struct GmlRing {
  Index node = kNone;  // kNone: the exterior ring of a polygon without one
  bool is_reversed = false;
};

/// How a facet got into its shell: a property of a collection of surfaces.
struct GmlMember {
  Index link = kNone;        // kNone: the shell is the polygon itself
  bool is_reversed = false;  // the collection is passed in the opposite orientation
};

/// A solid whose ring vertices are indices into GmlPositions::values, counted from
/// `first_position`, each used once.
struct GmlSolid {
  SolidArrays arrays;
  std::size_t first_position = 0;
  std::vector<Index> unclosed_rings;
  std::vector<Index> facets;       // the node of each facet
  std::vector<GmlMember> members;  // one for each facet
  std::vector<GmlRing> rings;      // one for each ring of `arrays`
  Index system = kNone;
  XmlPlace place;
};

/// The positions of all solids of a feature.
struct GmlPositions {
  std::vector<std::array<GridNumber, 3>> values;
  std::vector<Index> rounded;
};

class GmlShapes {
 public:
  /// `model` must outlive this object. The document's `byte_count` limits how much xlinks may
  /// repeat.
  GmlShapes(const GmlModel& model, std::uint64_t byte_count, const Limits& limits);

  /// The element that a link holds or refers to.
  /// Errors: malformed (no such gml:id, or several), unsupported (another document).
  Result<Index> resolve(const GmlLink& link);

  /// Fails, with the element's place, when the element cannot be used.
  Status check(Index node) const;

  /// Reads the shells of a Solid and appends its positions to `positions`.
  Result<GmlSolid> solid(Index node, GmlPositions& positions);

  /// Reads a surface, a collection of surfaces or a polygon as one shell, and appends its positions
  /// to `positions`.
  Result<GmlSolid> surface_alone(Index node, GmlPositions& positions);

  /// Counts steps of work. Errors: limit_exceeded after more steps than a document of this size
  /// needs without references.
  Status spend(std::uint64_t steps, XmlPlace place);

  /// Marks an element as being followed; false when it is already followed, and so contains itself.
  bool enter(Index node);
  void leave(Index node) { is_entered_[node] = false; }

  /// The EPSG code of a system; 0 for kNone.
  std::uint32_t srid(Index system) const { return system == kNone ? 0 : srids_[system]; }
  /// The latitude of the pole, in the system's unit, if positions have latitude first; else 0.
  double pole_of_first_axis(Index system) const { return system == kNone ? 0 : poles_[system]; }
  /// Whether two systems have the same code and order of axes; kNone is the same as any system.
  bool is_same_system(Index a, Index b) const;

  /// The name of an element in messages: "Solid 'id'", or "Solid" without gml:id.
  std::string title(Index node) const;

 private:
  struct Step {
    Index node;
    Index link;  // the next link to follow
    bool is_reversed;
    GmlMember member;  // the property through which the element got into its shell
  };

  Status shell(const GmlLink& link, GmlSolid& solid, GmlPositions& positions);
  Status shell_of(Index node, GmlSolid& solid, GmlPositions& positions);
  Status follow(std::vector<Step>& path, Index first, GmlSolid& solid, GmlPositions& positions);
  Status surface(std::vector<Step>& path, Index node, bool is_reversed, GmlMember member,
                 GmlSolid& solid, GmlPositions& positions);
  Status facet(Index node, bool is_reversed, GmlSolid& solid, GmlPositions& positions);
  Status ring(const GmlLink& link, bool is_reversed, GmlSolid& solid, GmlPositions& positions);
  Status read_positions(const GmlNode& ring, GmlPositions& positions);
  Status close_ring(const GmlNode& ring, std::size_t first, GmlSolid& solid,
                    GmlPositions& positions);
  Error wrong(XmlPlace place, std::string_view message) const;

  const GmlModel& model_;
  const Limits& limits_;
  std::uint64_t allowed_steps_;
  std::uint64_t steps_ = 0;
  std::vector<std::pair<std::string_view, Index>> by_id_;  // sorted
  std::vector<bool> is_entered_;
  std::vector<std::uint32_t> srids_;
  std::vector<double> poles_;
};

/// Reads the matrix "1 0 0 0 ...", row by row. The placement's shift is that of the matrix alone.
/// Errors: malformed.
Result<geometry::Placement> read_placement(std::string_view text);

}  // namespace watertight::formats
