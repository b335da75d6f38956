// SPDX-License-Identifier: GPL-3.0-or-later
//
// The submitted solid in the form that the rules examine, with equal vertices merged and edges
// split where rings touch; its canonical triangulation, its units, and the findings so far.
// Internal to validate/.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "geometry/crs/crs.h"
#include "geometry/intersection/triangle_triangle.h"
#include "tessellate/facets.h"
#include "validate/finding_kinds.h"
#include "validate/overlap/metric_map.h"
#include "validate/report.h"

namespace watertight::validate {

/// Collects findings in the order in which rules add them, at most a given number for each code.
class FindingCollector {
 public:
  explicit FindingCollector(std::uint64_t most) : most_(most) {}

  /// Adds a finding and sets its severity to that of its code.
  void add(Finding finding);
  /// Counts findings that were not made as omitted.
  void omit(std::uint64_t count) { omitted_ += count; }
  void skip(std::vector<int> codes, std::string reason) {
    skipped_.push_back({std::move(codes), std::move(reason)});
  }
  const std::vector<Finding>& all() const { return findings_; }
  bool has_errors() const { return has_errors_; }
  bool has(int code) const { return count_.count(code) != 0; }
  bool has_errors_up_to_level(int level) const;

  /// Moves the findings to a report, ordered by level, place and code; at most `most`.
  void move_to(Report& report) &&;

 private:
  std::uint64_t most_ = 0;
  std::uint64_t omitted_ = 0;
  bool has_errors_ = false;
  std::map<int, std::uint64_t> count_;
  std::vector<Finding> findings_;
  std::vector<SkippedRule> skipped_;
};

class ExaminedSolid {
 public:
  /// The object keeps a reference to `submitted`. With a placement, metres are those of the placed
  /// solid.
  ExaminedSolid(const Solid& submitted, const Tolerances& tolerances, const Limits& limits,
                CancelPoll cancel = {}, const geometry::Placement* placement = nullptr);

  /// True if the caller has cancelled the validation. For long loops: calls `cancel` only at every
  /// 1024th call.
  bool is_cancelled();
  /// As is_cancelled(), but calls `cancel` each time: for searches that ask rarely.
  bool ask_cancelled();
  bool was_cancelled() const { return was_cancelled_; }

  const Solid& submitted() const { return submitted_; }
  /// The submitted solid with equal vertices merged.
  const Solid& merged() const { return merged_.solid; }
  /// The merged solid with divided rings, which all rules examine. Findings name places in the
  /// submitted solid.
  const Solid& solid() const { return triangles_.divided_solid(merged_.solid); }
  /// True if a corner of solid() splits an edge and is no corner of the submitted ring.
  bool is_inserted(Index corner) const;
  const std::vector<Index>& merged_of() const { return merged_.vertex_of; }
  const tessellate::FacetTriangles& triangles() const { return triangles_; }
  const Tolerances& tolerances() const { return tolerances_; }
  const Limits& limits() const { return limits_; }
  const std::string& unit_note() const { return metric_map_.note(); }
  Index shell_of(Index facet) const { return shell_of_[facet]; }

  /// The vector in metres from one merged vertex to another.
  std::array<double, 3> metres(Index from, Index to) const;
  std::array<double, 3> metres(const Point& from, const Point& to) const {
    return metric_map_.metres(from, to);
  }
  const MetricMap& metric_map() const { return metric_map_; }

  // Places in the submitted solid.
  Place at_shell(Index shell) const;
  Place at_facet(Index facet) const;
  Place at_ring(Index facet, Index ring_in_facet) const;
  /// The place of the vertex at a position of a ring of solid(). If that vertex splits an edge, the
  /// place of the start of the submitted edge.
  Place at_corner(Index facet, Index ring_in_facet, std::size_t position) const;
  /// The first of the submitted vertices that became the given merged vertex.
  Index submitted_vertex(Index merged) const { return first_submitted_[merged]; }
  std::array<double, 3> world(Index merged) const { return solid().world(merged); }
  std::array<double, 3> world(const Point& p) const { return solid().lattice().world(p); }

  /// Marks a facet as having an error at ring or facet level.
  void mark_faulty(Index facet) { is_faulty_[facet] = true; }
  bool is_faulty(Index facet) const { return is_faulty_[facet]; }
  bool is_shell_faulty(Index shell) const;

  /// Marks a triangulated facet whose points are not all in one plane, exactly.
  void mark_not_planar(Index facet) { is_not_planar_[facet] = true; }
  bool is_not_planar(Index facet) const { return is_not_planar_[facet]; }

  /// Notes that a vertex lies inside an edge of a facet that lacks it (reported as 302).
  void note_junction(Index facet, Index vertex) { junctions_.emplace_back(facet, vertex); }
  /// Must be called after the last note_junction() and before is_junction_contact().
  void index_junctions();
  /// True if the contact of two facets is one at a T-junction, which is already reported as 302.
  bool is_junction_contact(geometry::ContactClass contact, Index a, Index b) const;

  FindingCollector findings;

 private:
  bool is_junction(Index without, Index with) const;

  const Solid& submitted_;
  CancelPoll cancel_;
  std::uint32_t polls_ = 0;
  bool was_cancelled_ = false;
  geometry::MergedSolid merged_;
  tessellate::FacetTriangles triangles_;
  Tolerances tolerances_;
  Limits limits_;
  MetricMap metric_map_;
  std::vector<Index> shell_of_;
  std::vector<Index> first_submitted_;
  std::vector<bool> is_faulty_;
  std::vector<bool> is_not_planar_;
  std::vector<std::pair<Index, Index>> junctions_;  // a facet and a vertex that it lacks
  std::vector<std::pair<Index, Index>>
      owners_;  // a vertex of junctions_ and a facet that has this vertex
};

}  // namespace watertight::validate
