// SPDX-License-Identifier: GPL-3.0-or-later
//
// The functions of the bridge that compare a solid with another one, a place or a segment.
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/json_text.h"
#include "codec/blob.h"
#include "geometry/contact/distance.h"
#include "geometry/contact/shared_area.h"
#include "sql/judge.h"
#include "sql/reply.h"
#include "tessellate/facets.h"
#include "validate/groups.h"
#include "validate/report_json.h"

namespace watertight::sql {
namespace {

/// The solid of a blob, and the triangles of its facets.
class DecodedSurface {
 public:
  explicit DecodedSurface(Solid solid)
      : solid_(std::move(solid)), facets_(tessellate::triangulate_facets(solid_)) {}
  DecodedSurface(const DecodedSurface&) = delete;
  DecodedSurface& operator=(const DecodedSurface&) = delete;

  geometry::Surface surface() const { return {&facets_.divided_solid(solid_), facets_.triangles}; }

 private:
  Solid solid_;
  tessellate::FacetTriangles facets_;
};

/// Gives the surface of the solid of the job to `work`; a failure of the reply if it cannot be
/// decoded, or the time is over then.
template <class Work>
void with_surface(const wt_job& job, wt_reply* reply, const Work& work) {
  const CallLimits call(job);
  Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  const DecodedSurface surface(std::move(decoded->solid));
  work(surface.surface());
  if (const Status in_time = call.check(); !in_time) fail(reply, in_time.error());
}

/// The same with the surfaces of two solids, and a way to end the work.
template <class Work>
void with_surfaces(const wt_job& job, ByteView other, wt_reply* reply, const Work& work) {
  const CallLimits call(job);
  Result<Decoded> left = decode(bytes_of(job), call.of_input());
  if (!left) return fail(reply, call.of_reading(left.error()));
  Result<Decoded> right = decode(other, call.of_input());
  if (!right) return fail(reply, call.of_reading(right.error()));
  const DecodedSurface one(std::move(left->solid));
  const DecodedSurface another(std::move(right->solid));
  work(one.surface(), another.surface(), call.poll());
  if (const Status in_time = call.check(); !in_time) fail(reply, in_time.error());
}

/// How the solids of two blobs meet; "apart" after a failure of the reply.
wt_relation relation_of(const wt_job& job, ByteView other, wt_reply* reply) {
  const CallLimits call(job);
  std::vector<ValidSolid> solids;
  for (const ByteView blob : {bytes_of(job), other}) {
    const Result<Decoded> decoded = decode(blob, call.of_input());
    if (!decoded) return fail(reply, call.of_reading(decoded.error())), WT_APART;
    auto solid = judged(job, call, *decoded, reply);
    if (!solid) return WT_APART;
    solids.push_back(*std::move(solid));
  }
  const std::array<validate::GroupMember, 2> members{{{&solids[0]}, {&solids[1]}}};
  const std::array<Index, 2> cells{0, 1};
  std::array<validate::CellPair, 1> pair{{{0, 1}}};
  validate::GroupOptions options;
  options.do_steps_warn = false;
  options.limits = call.of_input();
  options.cancel = call.poll();
  const validate::GroupReport report = validate::check_cells(members, cells, pair, options);
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error()), WT_APART;
  if (!report.findings.empty()) return WT_OVERLAPPING;
  switch (pair[0].contact) {
    case validate::CellContact::area:
      return WT_TOUCHING_BY_AREA;
    case validate::CellContact::at_points:
      return WT_TOUCHING_AT_POINTS;
    case validate::CellContact::apart:
      return WT_APART;
    default:
      break;
  }
  fail(reply, "0A000", "the solids have no common grid on which they can be compared");
  return WT_APART;
}

/// Compares the parts of a building.
void parts_into(const wt_job& job, std::span<const ByteView> blobs, wt_reply* reply) {
  const CallLimits call(job);
  std::vector<ValidSolid> solids;
  for (const ByteView blob : blobs) {
    const Result<Decoded> decoded = decode(blob, call.of_input());
    if (!decoded) return fail(reply, call.of_reading(decoded.error()));
    auto solid = judged(job, call, *decoded, reply);
    if (!solid) return;
    solids.push_back(*std::move(solid));
  }
  std::vector<validate::GroupMember> members;
  for (const ValidSolid& solid : solids) members.push_back({&solid});
  validate::GroupOptions options;
  options.limits = call.of_input();
  options.cancel = call.poll();
  const validate::GroupReport report =
      validate::check_group(members, validate::GroupKind::building_parts, options);
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  if (report.verdict == Verdict::undecided) {
    const std::string reason = report.not_run.empty() ? "" : report.not_run[0].reason;
    return fail(reply, "0A000", "the solids cannot be compared: " + reason);
  }
  std::vector<validate::ReportJsonOptions> names(solids.size());
  JsonText json;
  json.open('[');
  for (Index i = 0; i < solids.size(); ++i) names[i].solid_number = i;
  for (const Finding& finding : report.findings) {
    const auto placed = [&](Index number) {
      return validate::PlacedSolid{&solids[number].solid(), &names[number]};
    };
    const Index other = finding.other ? finding.other->solid : finding.place.solid;
    json.raw(validate::finding_json(finding, placed(finding.place.solid), placed(other)));
  }
  answer(reply, as_bytes(json.close(']').take()));
}

geometry::Place place_of(const double* place) { return {place[0], place[1], place[2]}; }

}  // namespace
}  // namespace watertight::sql

using watertight::CancelPoll;
using watertight::geometry::Surface;
using watertight::sql::guarded;

wt_relation wt_bridge_relation(const wt_job* job, const uint8_t* other, size_t other_size,
                               wt_reply* reply) noexcept {
  wt_relation relation = WT_APART;
  guarded(reply, [&] {
    relation = watertight::sql::relation_of(*job, {other, other_size}, reply);
  });
  return relation;
}

void wt_bridge_parts(const wt_job* job, const wt_blob_view* blobs, size_t count,
                     wt_reply* reply) noexcept {
  guarded(reply, [=] {
    std::vector<watertight::ByteView> views;
    for (std::size_t i = 0; i < count; ++i) views.emplace_back(blobs[i].bytes, blobs[i].size);
    watertight::sql::parts_into(*job, views, reply);
  });
}

void wt_bridge_shared_area(const wt_job* job, const uint8_t* other, size_t other_size,
                           double tolerance, double* area, wt_reply* reply) noexcept {
  guarded(reply, [=] {
    watertight::sql::with_surfaces(
        *job, {other, other_size}, reply,
        [=](const Surface& one, const Surface& another, const CancelPoll& is_cancelled) {
          *area = watertight::geometry::shared_area(one, another, tolerance, is_cancelled);
        });
  });
}

void wt_bridge_distance(const wt_job* job, const uint8_t* other, size_t other_size,
                        double* distance, wt_reply* reply) noexcept {
  guarded(reply, [=] {
    watertight::sql::with_surfaces(
        *job, {other, other_size}, reply,
        [=](const Surface& one, const Surface& another, const CancelPoll& is_cancelled) {
          *distance = watertight::geometry::distance(one, another, is_cancelled);
        });
  });
}

void wt_bridge_distance_of_place(const wt_job* job, const double place[3], double* distance,
                                 wt_reply* reply) noexcept {
  guarded(reply, [=] {
    watertight::sql::with_surface(*job, reply, [=](const Surface& surface) {
      *distance = watertight::geometry::distance(surface, watertight::sql::place_of(place));
    });
  });
}

void wt_bridge_meets_segment(const wt_job* job, const double from[3], const double to[3],
                             wt_reply* reply) noexcept {
  guarded(reply, [=] {
    watertight::sql::with_surface(*job, reply, [=](const Surface& surface) {
      reply->truth = watertight::geometry::meets_segment(surface, watertight::sql::place_of(from),
                                                         watertight::sql::place_of(to));
    });
  });
}
