// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/corner_contexts.h"

#include <algorithm>

namespace watertight::codec::parallelogram {

using namespace parallelogram;

CloseContexts corner_contexts(const CornerView& view) {
  const SurfaceFront& front = view.front;
  const std::vector<Vector>& centres = view.centres;
  const Gate& gate = front[view.corner];
  const Gate& after = front[gate.next];
  const Gate& before = front[gate.previous];
  const Vector& u = centres[gate.start];
  const Vector& v = centres[gate.end];
  const Vector& w = centres[after.end];
  const Vector& apex = centres[gate.apex];
  const Vector& next_apex = centres[after.apex];
  const auto angle = [](const Vector& at, const Vector& a, const Vector& b) {
    return angle_between(a - at, b - at);
  };

  // The triangle that would close the corner, and what it would leave at its other corners.
  const double room = gate.room;
  const double angle_u = angle(u, v, w);
  const double angle_v = angle(v, u, w);
  const double angle_w = angle(w, u, v);
  const double room_u = before.room - angle_u;
  const double room_w = after.room - angle_w;
  const Vector normal = cross(w - v, u - v);
  const double area = length(normal);
  const double span = length(w - u);
  const double side_u = length(u - v);
  const double side_w = length(w - v);
  const double sides = 0.5 * (side_u + side_w) + 1e-3;
  const double edge = view.mean_edge + 1e-3;
  const double near_edge = (side_u + side_w + length(apex - u) + length(apex - v) +
                            length(next_apex - v) + length(next_apex - w)) /
                               6 +
                           1e-3;

  // Its neighbours: how they bend away, how large they are.
  const Vector first = cross(apex - u, v - u);
  const Vector second = cross(next_apex - v, w - v);
  const std::uint32_t bend = cosine_bucket(normal, first * -1.0);
  const std::uint32_t next_bend = cosine_bucket(normal, second * -1.0);
  const double near_area = 0.5 * (length(first) + length(second)) + 1;

  // The sum of the two angles opposite an edge: for the two edges that the triangle shares with
  // known ones, and for its third edge, as if the triangle beyond that ended at the next vertex of
  // the front. In a Delaunay triangulation of a plane no such sum exceeds a half turn.
  const double opposite_u = angle(apex, u, v) + angle_w;
  const double opposite_w = angle(next_apex, v, w) + angle_u;
  const double opposite = std::max(opposite_u, opposite_w);
  const double least_opposite = std::min(opposite_u, opposite_w);
  const double over = angle_v + std::max(angle(centres[before.start], u, w),
                                         angle(centres[front[after.next].end], u, w));

  // The distances of the expected tips from the vertices that a closing triangle would have.
  const double miss_u = length(view.tip - w) / sides;
  const double miss_w = length(view.next_tip - u) / sides;
  const double miss = std::min(miss_u, miss_w);
  const double most_missed = std::max(miss_u, miss_w);

  const auto degree_of = [&](Index vertex) { return std::min(front.degree(vertex), kDegrees - 1); };
  const std::uint32_t degree = degree_of(gate.end);
  const std::uint32_t degree_u = degree_of(gate.start);
  const std::uint32_t degree_w = degree_of(after.end);
  // How many triangles are missing at v if they are as wide as the known ones.
  const double missing = room * front.degree(gate.end) / (2 * kHalfTurn - room + 0.01);

  const std::uint32_t rooms = bucket(room * 8, kRooms);
  const std::uint32_t ratio = log_bucket(span / sides, 6, kRatios);
  const std::uint32_t spans = bucket(span / edge * 12, 32);
  const std::uint32_t least = bucket(std::min(room_u, room_w) * 4 + 2, 14);
  const std::uint32_t overs = bucket((over - 2.2) * 10, 20);
  const std::uint32_t turn = bucket(angle(v, u, view.tip) / (room + 0.01) * 12, 16);
  const std::uint32_t next_turn = bucket(angle(v, w, view.next_tip) / (room + 0.01) * 12, 16);
  return {
      bucket(angle_v * 5, kAngles) * kRatios + ratio,
      (bend * kCosines + next_bend) * 16 + rooms / 2,
      (degree * kDegrees + std::min(degree_u, degree_w)) * kDegrees + std::max(degree_u, degree_w),
      (least * kDegrees + (room_u < room_w ? degree_u : degree_w)) * kDegrees + degree,
      rooms * kRatios + log_bucket(span / edge, 6, kRatios),
      bucket(span / near_edge * 12, 32) * kRooms + rooms,
      spans * kDegrees + degree,
      bucket(std::min(side_u, side_w) / edge * 8, 24) * 24 +
          bucket(std::max(side_u, side_w) / edge * 8, 24),
      spans / 2 * 16 + bucket((opposite - 1.2) * 5, 16),
      (spans / 2 * 16 + bucket(angle_v * 5, kAngles)) * 16 + bucket(missing * 4, 16),
      log_bucket(area / near_area, 8, 16) * 16 + rooms / 2,
      log_bucket(area / (edge * edge), 10, 20) * 16 + rooms / 2,
      bucket((opposite - 2.2) * 10, 20) * 20 + overs,
      bucket((least_opposite - 1.2) * 10, 20) * 20 + overs,
      turn * 16 + next_turn,
      log_bucket(miss, 8, 14) * 14 + log_bucket(most_missed, 8, 14),
      (bucket(missing * 4, 12) * 12 + bucket(miss * 8, 12)) * 12 + bucket((opposite - 2) * 5, 12),
      view.answers};
}

}  // namespace watertight::codec::parallelogram
