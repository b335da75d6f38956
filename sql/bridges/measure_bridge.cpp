// SPDX-License-Identifier: GPL-3.0-or-later
//
// The functions of the bridge that measure and compare solids of blobs.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "codec/blob.h"
#include "geometry/mass/mass.h"
#include "sql/faces.h"
#include "sql/make_value.h"
#include "sql/reply.h"
#include "tessellate/facets.h"

namespace watertight::sql {
namespace {

/// Gives the solid of a blob to `work`; a failure of the reply if it cannot be decoded, or the time
/// is over then.
template <class Work>
void with_solid(const wt_job& job, wt_reply* reply, const Work& work) {
  const CallLimits call(job);
  const Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  work(decoded->solid);
  if (const Status in_time = call.check(); !in_time) fail(reply, in_time.error());
}

/// Gives the solid of a blob and the triangles of its facets to `work`.
template <class Work>
void with_triangles(const wt_job& job, wt_reply* reply, const Work& work) {
  with_solid(job, reply, [&](const Solid& solid) {
    const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
    work(facets.divided_solid(solid), std::span<const Triangle>(facets.triangles));
  });
}

void measures_into(const wt_job& job, wt_measures* measures, wt_reply* reply) {
  with_solid(job, reply, [=](const Solid& solid) {
    // Without triangles: volume and area, which stand in the value, are not asked for.
    const geometry::Measures measured = geometry::measure(solid, {});
    std::ranges::copy(measured.box_min, measures->box_min);
    std::ranges::copy(measured.box_max, measures->box_max);
    measures->vertices = measured.vertices;
    measures->facets = measured.facets;
    measures->rings = measured.rings;
    measures->shells = measured.shells;
  });
}

void genus_into(const wt_job& job, std::int64_t* genus, wt_reply* reply) {
  with_solid(job, reply, [=](const Solid& solid) { *genus = measures_of(solid).genus; });
}

void centroid_into(const wt_job& job, double* centre, wt_reply* reply) {
  with_triangles(job, reply, [=](const Solid& solid, std::span<const Triangle> triangles) {
    std::ranges::copy(geometry::centroid(solid, triangles), centre);
  });
}

void volume_below_into(const wt_job& job, double height, double* volume, wt_reply* reply) {
  with_triangles(job, reply, [=](const Solid& solid, std::span<const Triangle> triangles) {
    *volume = geometry::volume_below(solid, triangles, height);
  });
}

void contains_into(const wt_job& job, const double* place, wt_reply* reply) {
  const std::array<double, 3> at{place[0], place[1], place[2]};
  with_triangles(job, reply, [=](const Solid& solid, std::span<const Triangle> triangles) {
    reply->truth = geometry::locate(solid, triangles, at) >= 0;
  });
}

void faces_into(const wt_job& job, wt_reply* reply) {
  with_solid(job, reply, [=](const Solid& solid) {
    const std::vector<wt_face> faces = faces_of(solid);
    answer(reply,
           {reinterpret_cast<const std::uint8_t*>(faces.data()), faces.size() * sizeof(wt_face)});
  });
}

/// compare(), as a number; 0 after a failure of the reply.
int compare_blobs(const wt_job& job, ByteView other, wt_reply* reply) {
  const CallLimits call(job);
  const Result<Decoded> left = decode(bytes_of(job), call.of_input());
  const Result<Decoded> right = decode(other, call.of_input());
  Result<int> order = 0;
  if (!left || !right) {
    order = call.of_reading(left ? right.error() : left.error());
  } else {
    order = compare(left->solid, right->solid);
  }
  if (order) return *order;
  fail(reply, order.error());
  return 0;
}

}  // namespace
}  // namespace watertight::sql

using watertight::sql::guarded;

void wt_bridge_measures(const wt_job* job, wt_measures* measures, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::measures_into(*job, measures, reply); });
}

void wt_bridge_genus(const wt_job* job, int64_t* genus, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::genus_into(*job, genus, reply); });
}

void wt_bridge_centroid(const wt_job* job, double centroid[3], wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::centroid_into(*job, centroid, reply); });
}

void wt_bridge_volume_below(const wt_job* job, double height, double* volume,
                            wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::volume_below_into(*job, height, volume, reply); });
}

void wt_bridge_contains(const wt_job* job, const double place[3], wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::contains_into(*job, place, reply); });
}

void wt_bridge_faces(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::faces_into(*job, reply); });
}

int wt_bridge_compare(const wt_job* job, const uint8_t* other, size_t other_size,
                      wt_reply* reply) noexcept {
  int order = 0;
  guarded(reply, [&] { order = watertight::sql::compare_blobs(*job, {other, other_size}, reply); });
  return order;
}
