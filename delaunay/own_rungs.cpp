// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/own_rungs.h"

#include <algorithm>
#include <array>
#include <utility>

#include "delaunay/canonical/small_delaunay.h"
#include "delaunay/canonical/sort_by_vertices.h"
#include "delaunay/canonical_delaunay.h"
#include "delaunay/constrained/constrained_delaunay.h"
#include "delaunay/recovery/recover_faces.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/intersection/box_partition.h"
#include "tessellate/flatness.h"

namespace watertight::delaunay {
namespace {

/// A Delaunay tetrahedralization of a boundary has about 7 tetrahedra for each vertex; far more
/// means a degenerate set for which rung 0 must not use up the memory.
constexpr std::uint64_t kTetrahedraPerVertex = 256;
/// The rounds after which all facets that are not flat keep their canonical triangles.
constexpr int kMostPartings = 8;

RungResult missing_faces(std::size_t missing, std::size_t all, const char* faces) {
  return {std::nullopt, RungOutcome::not_delaunay,
          "refused: " + std::to_string(missing) + " of " + std::to_string(all) +
              " boundary triangles are not " + faces};
}

/// The reason of an error as the outcome of a rung.
RungResult failed_rung(const Error& error) {
  if (error.code == ErrorCode::cancelled) {
    return {std::nullopt, RungOutcome::cancelled, "cancelled: cancelled by the caller"};
  }
  const bool is_limit = error.code == ErrorCode::limit_exceeded;
  return {std::nullopt, is_limit ? RungOutcome::memory_limit : RungOutcome::engine_error,
          "refused: " + error.message};
}

void keep_bent_facets(const Solid& solid, std::vector<bool>& is_kept) {
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    if (!tessellate::is_flat(solid, facet)) is_kept[facet] = true;
  }
}

/// True for each facet that is not flat and whose triangles are not its canonical ones.
std::vector<bool> bent_otherwise(const Solid& solid, const tessellate::FacetTriangles& canonical,
                                 const FollowingTriangles& following) {
  std::vector<bool> is_bent(solid.facet_count(), false);
  std::vector<Triangle> known;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    known.clear();
    for (Index t = canonical.first[facet]; t < canonical.first[facet + 1]; ++t) {
      known.push_back(rotated(canonical.triangles[t]));
    }
    std::sort(known.begin(), known.end());
    const auto own =
        std::span(following.triangles)
            .subspan(following.first[facet], following.first[facet + 1] - following.first[facet]);
    is_bent[facet] = !std::ranges::equal(known, own) && !tessellate::is_flat(solid, facet);
  }
  return is_bent;
}

/// Adds each facet of which a triangle crosses another one to `is_kept`. The canonical triangles of
/// a valid solid do not cross, nor do those of facets in a plane; those that follow the Delaunay
/// tetrahedralization may. False if there is none to add. Errors: cancelled.
Result<bool> part_crossing_triangles(const Solid& solid,
                                     const tessellate::FacetTriangles& canonical,
                                     const FollowingTriangles& following,
                                     std::vector<bool>& is_kept, const CancelPoll& is_cancelled) {
  const std::vector<bool> is_bent = bent_otherwise(solid, canonical, following);
  if (std::ranges::find(is_bent, true) == is_bent.end()) return false;
  Box near_bent;
  for (Index i = 0; i < following.triangles.size(); ++i) {
    if (!is_bent[following.facet_of[i]]) continue;
    for (const Index vertex : following.triangles[i]) near_bent.include(solid.vertices()[vertex]);
  }
  std::vector<Triangle> triangles;
  std::vector<Index> facet_of;
  // Triangles of one group do not cross: those of the other facets, and faces.
  std::vector<Index> group_of;
  for (Index i = 0; i < following.triangles.size(); ++i) {
    const Index facet = following.facet_of[i];
    const auto& [a, b, c] = following.triangles[i];
    const std::array corners{solid.vertices()[a], solid.vertices()[b], solid.vertices()[c]};
    if (!geometry::box_of(corners).overlaps(near_bent)) continue;
    triangles.push_back(following.triangles[i]);
    facet_of.push_back(facet);
    const bool is_face = following.delaunay_face[i] != kNone;
    group_of.push_back(!is_bent[facet] ? 0 : is_face ? 1 : i + 2);
  }
  geometry::IntersectionOptions options;
  options.cancel = is_cancelled;
  options.group_of = group_of;
  const auto crossing = geometry::intersecting_pairs(solid.vertices(), triangles, options);
  if (!crossing) return crossing.error();
  bool has_changed = false;
  for (const geometry::IntersectingPair& pair : *crossing) {
    for (const Index triangle : {pair.first, pair.second}) {
      const Index facet = facet_of[triangle];
      if (is_bent[facet] && !is_kept[facet]) is_kept[facet] = has_changed = true;
    }
  }
  return has_changed;
}

}  // namespace

OwnRungs::OwnRungs(const Solid& solid, const tessellate::FacetTriangles& triangles, bool is_divided,
                   const CancelPoll& is_cancelled)
    : solid_(solid), triangles_(triangles), is_divided_(is_divided), is_cancelled_(is_cancelled) {
  const AxisScale scale = equal_units(solid);
  points_ = solid.vertices();
  if (scale == scale_) return;
  auto points = scaled(points_, scale);
  // Points of a small grid take a fraction of the time of others.
  if (!points || (is_small_grid(points_) && !is_small_grid(*points))) return;
  scale_ = scale;
  scaled_ = *std::move(points);
  points_ = scaled_;
}

/// Makes the facets' triangles that follow the canonical Delaunay tetrahedralization, which is made
/// first if it is not there, but for facets that keep their canonical ones.
std::optional<Error> OwnRungs::follow(const std::vector<bool>& is_kept) {
  following_.reset();
  if (!delaunay_) {
    Result<CanonicalDelaunay> made =
        canonical_delaunay(points_, 4096 + kTetrahedraPerVertex * points_.size(), is_cancelled_);
    if (!made) return made.error();
    delaunay_ = *std::move(made);
  }
  Result<FollowingTriangles> followed =
      follow_delaunay(solid_, triangles_, *delaunay_, is_kept, is_cancelled_);
  if (!followed) return followed.error();
  following_ = *std::move(followed);
  return std::nullopt;
}

RungResult OwnRungs::delaunay(const std::vector<bool>& is_kept) {
  if (const auto error = follow(is_kept)) return failed_rung(*error);
  if (following_->missing_total > 0) {
    return missing_faces(following_->missing_total, following_->triangles.size(), "Delaunay faces");
  }
  const FollowingTriangles following = *std::exchange(following_, std::nullopt);
  const auto points = solid_.vertices();
  CanonicalDelaunay delaunay = *std::exchange(delaunay_, std::nullopt);
  return {with_faces({points.begin(), points.end()}, std::move(delaunay.tetrahedra),
                     following.triangles, following.facet_of),
          {},
          {}};
}

RungResult OwnRungs::recovered(const std::vector<bool>& is_taken_apart) {
  // Edges of other shells that lie on a facet are edges of its canonical triangles only.
  std::vector<bool> is_kept = is_taken_apart;
  is_kept.resize(solid_.facet_count());
  bool is_due = !following_ || is_divided_;
  for (int round = 0; round <= kMostPartings; ++round) {
    if (is_due) {
      if (const auto error = follow(is_kept)) return failed_rung(*error);
    }
    is_due = part_equal_triangles(following_->triangles, following_->facet_of, is_kept);
    if (!is_due) {
      const Result<bool> has_parted =
          part_crossing_triangles(solid_, triangles_, *following_, is_kept, is_cancelled_);
      if (!has_parted) return failed_rung(has_parted.error());
      is_due = *has_parted;
    }
    if (!is_due) break;
    if (round + 1 == kMostPartings) keep_bent_facets(solid_, is_kept);
  }
  const FollowingTriangles following = *std::exchange(following_, std::nullopt);
  std::vector<Index> missing;
  for (Index i = 0; i < following.triangles.size(); ++i) {
    if (following.delaunay_face[i] == kNone) missing.push_back(i);
  }
  std::vector<geometry::Tetrahedron> tetrahedra = std::move(delaunay_->tetrahedra);
  delaunay_.reset();
  Result<RecoveredFaces> recovered =
      recover_faces(points_, std::move(tetrahedra), following.triangles, missing, is_cancelled_);
  if (!recovered) return failed_rung(recovered.error());
  if (recovered->missing > 0) return constrained(is_taken_apart);
  unscale(recovered->points, scale_);
  std::vector<Index> facet_of;
  for (const Index source : recovered->source) facet_of.push_back(following.facet_of[source]);
  return {with_faces(std::move(recovered->points), std::move(recovered->tetrahedra),
                     recovered->triangles, facet_of),
          {},
          {}};
}

/// The second half of rung 1, for what flips do not recover.
RungResult OwnRungs::constrained(const std::vector<bool>& is_taken_apart) {
  Result<ConstrainedDelaunay> constrained =
      constrained_delaunay(solid_, triangles_, is_taken_apart, is_cancelled_);
  if (!constrained) return failed_rung(constrained.error());
  if (constrained->missing > 0) {
    return missing_faces(constrained->missing, constrained->triangles.size(), "recovered");
  }
  return {with_faces(std::move(constrained->points), std::move(constrained->tetrahedra),
                     constrained->triangles, constrained->facet_of),
          {},
          {}};
}

/// A tetrahedralization of which the triangles of facets are faces.
Tetrahedralization OwnRungs::with_faces(std::vector<Point> points,
                                        std::vector<geometry::Tetrahedron> tetrahedra,
                                        const std::vector<Triangle>& triangles,
                                        const std::vector<Index>& facet_of) const {
  Tetrahedralization own;
  own.points = std::move(points);
  own.input_count = solid_.vertex_count();
  own.tetrahedra = std::move(tetrahedra);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    own.constrained.push_back({sorted(triangles[t]), facet_of[t]});
  }
  std::sort(own.constrained.begin(), own.constrained.end());
  return own;
}

}  // namespace watertight::delaunay
