// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/examined_solid.h"

#include <algorithm>
#include <tuple>

namespace watertight::validate {

void FindingCollector::add(Finding finding) {
  const FindingKind* kind = find_kind(finding.code);
  if (kind != nullptr) finding.severity = kind->severity;
  if (finding.severity == Severity::error) has_errors_ = true;
  if (count_[finding.code]++ >= most_) {
    ++omitted_;
    return;
  }
  findings_.push_back(std::move(finding));
}

bool FindingCollector::has_errors_up_to_level(int level) const {
  return std::any_of(count_.begin(), count_.end(), [&](const auto& entry) {
    const FindingKind* kind = find_kind(entry.first);
    return entry.second > 0 && kind != nullptr && kind->severity == Severity::error &&
           finding_level(entry.first) <= level;
  });
}

void FindingCollector::move_to(Report& report) && {
  // kNone is the largest index, and kNone + 1 is 0, so a place without a facet comes first.
  const auto whole_first = [&](const Finding& a, const Finding& b) {
    const auto shift = [](Place p) {
      return Place{p.shell + 1, p.facet + 1, p.ring + 1, p.vertex + 1};
    };
    return std::tuple(finding_level(a.code), shift(a.place), a.code,
                      shift(a.other.value_or(Place{}))) <
           std::tuple(finding_level(b.code), shift(b.place), b.code,
                      shift(b.other.value_or(Place{})));
  };
  std::stable_sort(findings_.begin(), findings_.end(), whole_first);
  if (findings_.size() > most_) {
    omitted_ += findings_.size() - most_;
    findings_.resize(most_);
  }
  report.findings = std::move(findings_);
  report.findings_omitted = omitted_;
  report.not_run = std::move(skipped_);
}

ExaminedSolid::ExaminedSolid(const Solid& submitted, const Tolerances& tolerances,
                             const Limits& limits, CancelPoll cancel,
                             const geometry::Placement* placement)
    : findings(limits.findings),
      submitted_(submitted),
      cancel_(std::move(cancel)),
      merged_(geometry::merge_equal_vertices(submitted)),
      triangles_(tessellate::triangulate_facets(merged_.solid)),
      tolerances_(tolerances),
      limits_(limits),
      metric_map_(merged_.solid, placement),
      shell_of_(submitted.facet_count(), 0),
      first_submitted_(merged_.solid.vertex_count(), kNone),
      is_faulty_(submitted.facet_count(), false),
      is_not_planar_(submitted.facet_count(), false) {
  for (Index shell = 0; shell < submitted.shell_count(); ++shell) {
    const IndexRange facets = submitted.facets_of(shell);
    for (Index facet = facets.begin; facet < facets.end; ++facet) shell_of_[facet] = shell;
  }
  for (Index vertex = 0; vertex < submitted.vertex_count(); ++vertex) {
    const Index merged = merged_.vertex_of[vertex];
    if (merged != kNone && first_submitted_[merged] == kNone) first_submitted_[merged] = vertex;
  }
}

std::array<double, 3> ExaminedSolid::metres(Index from, Index to) const {
  return metres(solid().vertices()[from], solid().vertices()[to]);
}

Place ExaminedSolid::at_shell(Index shell) const {
  Place place;
  place.shell = shell;
  return place;
}

Place ExaminedSolid::at_facet(Index facet) const {
  Place place;
  place.shell = shell_of_[facet];
  place.facet = facet;
  return place;
}

Place ExaminedSolid::at_ring(Index facet, Index ring_in_facet) const {
  Place place = at_facet(facet);
  place.ring = ring_in_facet;
  return place;
}

Place ExaminedSolid::at_corner(Index facet, Index ring_in_facet, std::size_t position) const {
  Place place = at_ring(facet, ring_in_facet);
  const Index ring = solid().rings_of(facet).begin + ring_in_facet;
  Index corner = solid().arrays().ring_offsets[ring];
  corner += static_cast<Index>(position % solid().ring(ring).size());
  if (triangles_.divided) corner = triangles_.divided->corner_of[corner];
  place.vertex = submitted_.arrays().ring_vertices[corner];
  return place;
}

bool ExaminedSolid::is_inserted(Index corner) const {
  if (!triangles_.divided || corner == 0) return false;
  const std::vector<Index>& corner_of = triangles_.divided->corner_of;
  return corner_of[corner] == corner_of[corner - 1];
}

bool ExaminedSolid::is_shell_faulty(Index shell) const {
  const IndexRange facets = solid().facets_of(shell);
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    if (is_faulty_[facet]) return true;
  }
  return false;
}

bool ExaminedSolid::is_cancelled() {
  constexpr std::uint32_t kInterval = 1U << 10U;
  return polls_++ % kInterval == 0 ? ask_cancelled() : was_cancelled_;
}

bool ExaminedSolid::ask_cancelled() {
  if (!was_cancelled_ && cancel_) was_cancelled_ = cancel_();
  return was_cancelled_;
}

void ExaminedSolid::index_junctions() {
  owners_.clear();
  if (junctions_.empty()) return;
  std::sort(junctions_.begin(), junctions_.end());
  std::vector<bool> is_lacked(solid().vertex_count(), false);
  for (const auto& [facet, vertex] : junctions_) is_lacked[vertex] = true;
  for (Index facet = 0; facet < solid().facet_count(); ++facet) {
    const IndexRange rings = solid().rings_of(facet);
    for (Index r = rings.begin; r < rings.end; ++r) {
      for (const Index vertex : solid().ring(r)) {
        if (is_lacked[vertex]) owners_.emplace_back(vertex, facet);
      }
    }
  }
  std::sort(owners_.begin(), owners_.end());
}

/// True if facet `with` has a vertex that lies inside an edge of facet `without`, which lacks it.
bool ExaminedSolid::is_junction(Index without, Index with) const {
  const auto begin =
      std::lower_bound(junctions_.begin(), junctions_.end(), std::pair(without, Index{0}));
  const auto end = std::lower_bound(begin, junctions_.end(), std::pair(without + 1, Index{0}));
  if (begin == end) return false;
  const SolidArrays& arrays = solid().arrays();
  const IndexRange rings = solid().rings_of(with);
  const std::span<const Index> corners =
      std::span<const Index>(arrays.ring_vertices)
          .subspan(arrays.ring_offsets[rings.begin],
                   arrays.ring_offsets[rings.end] - arrays.ring_offsets[rings.begin]);
  if (corners.size() < static_cast<std::size_t>(end - begin)) {
    return std::any_of(corners.begin(), corners.end(), [&](Index vertex) {
      return std::binary_search(begin, end, std::pair(without, vertex));
    });
  }
  return std::any_of(begin, end, [&](const auto& lacked) {
    return std::binary_search(owners_.begin(), owners_.end(), std::pair(lacked.second, with));
  });
}

bool ExaminedSolid::is_junction_contact(geometry::ContactClass contact, Index a, Index b) const {
  if (contact != geometry::ContactClass::vertex_edge &&
      contact != geometry::ContactClass::edge_overlap)
    return false;
  return is_junction(a, b) || is_junction(b, a);
}

}  // namespace watertight::validate
