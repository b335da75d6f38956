// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/corner_contexts.h"
#include "codec/mode_parallelogram/vectors.h"

#include <algorithm>

namespace watertight::codec::parallelogram {
namespace {

// The classes were fitted on meshes and are fixed by the format. bench/dead-ends.md lists contexts
// that were tried beside these.
constexpr std::uint32_t kDegrees = 10;
// Angles. `per_unit` is the number of classes for each radian.
constexpr Scale<32> kRooms{.per_unit = 8};
constexpr Scale<16> kAngles{.per_unit = 5};
constexpr Scale<16> kCoarseOpposites{.per_unit = 5, .from = 1.2};
constexpr Scale<12> kFewOpposites{.per_unit = 5, .from = 2};
constexpr Scale<20> kGreaterOpposites{.per_unit = 10, .from = 2.2};
constexpr Scale<20> kLesserOpposites{.per_unit = 10, .from = 1.2};
// Classes of the room that the closing triangle leaves at its end u or w.
constexpr std::uint32_t kRests = 14;
constexpr double kRestsPerRadian = 4;
constexpr double kRestZero = 2;  // the class of no room
// Classes of how many triangles fit into the room of a corner.
constexpr Scale<16> kMissing{.per_unit = 4};
constexpr Scale<12> kFewMissing{.per_unit = 4};
// Ratios of two lengths (spans, sides, misses), and ratios of an angle to the room of a corner
// (turns).
constexpr Scale<32> kSpans{.per_unit = 12};
constexpr Scale<24> kSides{.per_unit = 8};
constexpr Scale<16> kTurns{.per_unit = 12};
constexpr Scale<12> kMisses{.per_unit = 8};
// Logarithms of ratios of two lengths: the number of classes, and the class of the ratio 1.
constexpr std::uint32_t kRatios = 12;
constexpr int kRatioZero = 6;
constexpr std::uint32_t kMissRatios = 14;
constexpr int kMissZero = 8;
// Logarithms of ratios of two areas: the number of classes, and the class of the ratio 1.
constexpr std::uint32_t kNearAreas = 16;
constexpr int kNearAreaZero = 8;
constexpr std::uint32_t kMeanAreas = 20;
constexpr int kMeanAreaZero = 10;
// Values that keep divisors above 0.
constexpr double kLeastLength = 1e-3;
constexpr double kLeastRoom = 0.01;
constexpr double kLeastArea = 1;

/// The vertices around a corner, and the triangle that would close it: u v w. The letters are those
/// of the format's text.
struct Corner {
  explicit Corner(const CornerView& view)
      : gate(view.front[view.corner]),
        after(view.front[gate.next]),
        before(view.front[gate.previous]),
        u(view.centres[gate.start]),
        v(view.centres[gate.end]),
        w(view.centres[after.end]),
        apex(view.centres[gate.apex]),
        next_apex(view.centres[after.apex]),
        angle_u(angle(u, v, w)),
        angle_v(angle(v, u, w)),
        angle_w(angle(w, u, v)) {}

  static double angle(const Vector& at, const Vector& a, const Vector& b) {
    return angle_between(a - at, b - at);
  }

  const Gate& gate;
  const Gate& after;
  const Gate& before;
  const Vector& u;
  const Vector& v;
  const Vector& w;
  const Vector& apex;
  const Vector& next_apex;
  double angle_u;
  double angle_v;
  double angle_w;
};

/// Degrees of the vertices of the closing triangle.
struct Degrees {
  Context<kDegrees> u;
  Context<kDegrees> v;
  Context<kDegrees> w;
  Context<kDegrees> lesser;   // the lesser degree of u and w
  Context<kDegrees> greater;  // the greater degree of u and w
};

Degrees degrees_at(const Corner& at, const SurfaceFront& front) {
  const auto u = capped<kDegrees>(front.degree(at.gate.start));
  const auto v = capped<kDegrees>(front.degree(at.gate.end));
  const auto w = capped<kDegrees>(front.degree(at.after.end));
  return {u, v, w, u.value < w.value ? u : w, u.value < w.value ? w : u};
}

struct Lengths {
  double span;       // the length of the third edge u w of the closing triangle
  double side_u;     // the length of u v, which is an edge of a known triangle too
  double side_w;     // the length of v w, which is an edge of a known triangle too
  double mean_side;  // the mean of side_u and side_w
  double mean_edge;  // the mean length of the edges of the surface
  double near_edge;  // the mean length of the edges of the two known triangles
};

Lengths lengths_at(const Corner& at, double mean_edge) {
  const double side_u = length(at.u - at.v);
  const double side_w = length(at.w - at.v);
  return {.span = length(at.w - at.u),
          .side_u = side_u,
          .side_w = side_w,
          .mean_side = 0.5 * (side_u + side_w) + kLeastLength,
          .mean_edge = mean_edge + kLeastLength,
          .near_edge = (side_u + side_w + length(at.apex - at.u) + length(at.apex - at.v) +
                        length(at.next_apex - at.v) + length(at.next_apex - at.w)) /
                           6 +
                       kLeastLength};
}

/// The closing triangle beside its known neighbours: its area, and how it bends away from them.
struct Areas {
  double own;
  double near;  // the mean area of the two known triangles
  Context<kCosines> bend;
  Context<kCosines> next_bend;
};

Areas areas_at(const Corner& at) {
  const Vector normal = cross(at.w - at.v, at.u - at.v);
  const Vector first = cross(at.apex - at.u, at.v - at.u);
  const Vector second = cross(at.next_apex - at.v, at.w - at.v);
  return {.own = length(normal),
          .near = 0.5 * (length(first) + length(second)) + kLeastArea,
          .bend = cosine_bucket(normal, first * -1.0),
          .next_bend = cosine_bucket(normal, second * -1.0)};
}

/// The sum of the two angles opposite an edge: for the two edges that the closing triangle shares
/// with known ones, and for its third edge, as if the triangle beyond this edge ended at the next
/// vertex of the front. In a Delaunay triangulation of a plane no such sum exceeds a half turn.
struct Opposites {
  double greater;
  double lesser;
  double third;
};

Opposites opposites_at(const Corner& at, const CornerView& view) {
  const double u = Corner::angle(at.apex, at.u, at.v) + at.angle_w;
  const double w = Corner::angle(at.next_apex, at.v, at.w) + at.angle_u;
  const Vector& behind = view.centres[at.before.start];
  const Vector& ahead = view.centres[view.front[at.after.next].end];
  return {.greater = std::max(u, w),
          .lesser = std::min(u, w),
          .third = at.angle_v +
                   std::max(Corner::angle(behind, at.u, at.w), Corner::angle(ahead, at.u, at.w))};
}

}  // namespace

ContextsOf<kClose> corner_contexts(const CornerView& view) {
  const Corner at(view);
  const Degrees degree = degrees_at(at, view.front);
  const Lengths lengths = lengths_at(at, view.mean_edge);
  const Areas area = areas_at(at);
  const Opposites opposite = opposites_at(at, view);
  const double span = lengths.span;
  const double edge = lengths.mean_edge;

  const double room = at.gate.room;
  const double rest_u = at.before.room - at.angle_u;
  const double rest_w = at.after.room - at.angle_w;
  // The number of triangles that are missing at v if they are as wide as the known ones.
  const double missing =
      room * view.front.degree(at.gate.end) / (2 * kHalfTurn - room + kLeastRoom);
  // The distances of the expected tips from the vertices that a closing triangle would have.
  const double miss_u = length(view.tip - at.w) / lengths.mean_side;
  const double miss_w = length(view.next_tip - at.u) / lengths.mean_side;
  const double miss = std::min(miss_u, miss_w);

  const auto rooms = kRooms(room);
  const auto half_rooms = halved(rooms);
  const auto wide = kAngles(at.angle_v);
  const auto rest = bucket<kRests>(std::min(rest_u, rest_w) * kRestsPerRadian + kRestZero);
  const auto spans = kSpans(span / edge);
  const auto thirds = kGreaterOpposites(opposite.third);
  const double turn = Corner::angle(at.v, at.u, view.tip) / (room + kLeastRoom);
  const double next_turn = Corner::angle(at.v, at.w, view.next_tip) / (room + kLeastRoom);
  return {combine(wide, log_bucket<kRatios>(span / lengths.mean_side, kRatioZero)),
          combine(area.bend, area.next_bend, half_rooms),
          combine(degree.v, degree.lesser, degree.greater),
          combine(rest, rest_u < rest_w ? degree.u : degree.w, degree.v),
          combine(rooms, log_bucket<kRatios>(span / edge, kRatioZero)),
          combine(kSpans(span / lengths.near_edge), rooms),
          combine(spans, degree.v),
          combine(kSides(std::min(lengths.side_u, lengths.side_w) / edge),
                  kSides(std::max(lengths.side_u, lengths.side_w) / edge)),
          combine(halved(spans), kCoarseOpposites(opposite.greater)),
          combine(halved(spans), wide, kMissing(missing)),
          combine(log_bucket<kNearAreas>(area.own / area.near, kNearAreaZero), half_rooms),
          combine(log_bucket<kMeanAreas>(area.own / (edge * edge), kMeanAreaZero), half_rooms),
          combine(kGreaterOpposites(opposite.greater), thirds),
          combine(kLesserOpposites(opposite.lesser), thirds),
          combine(kTurns(turn), kTurns(next_turn)),
          combine(log_bucket<kMissRatios>(miss, kMissZero),
                  log_bucket<kMissRatios>(std::max(miss_u, miss_w), kMissZero)),
          combine(kFewMissing(missing), kMisses(miss), kFewOpposites(opposite.greater)),
          view.answers};
}

}  // namespace watertight::codec::parallelogram
