// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids of many faces, and patches of many degrees, made by code.
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "surfaces/curves/elementary.h"
#include "surfaces/invert_point.h"
#include "tests/unit/surfaces/checked_solid.h"

namespace watertight {
namespace {

using surfaces::BoundaryRepresentation;
using surfaces::EdgeLoop;
using surfaces::Frame;
using surfaces::Surface;
using surfaces::Vector3;
using surfaces::operator+;
using surfaces::operator*;

constexpr double kTurn = 2 * std::numbers::pi;
const Vector3 kUp{0, 0, 1};

/// A regular prism whose edges are rounded: all points no farther than `fillet` from a prism of
/// radius 2 and height 1. 6 n + 2 faces: planes, cylinders, and spheres at the corners.
class RoundedPrism {
 public:
  RoundedPrism(Index sides, double fillet) : n_(sides), fillet_(fillet) {
    for (Index i = 0; i < n_; ++i) {
      const double corner = kTurn * i / n_;
      const double side = kTurn * (i + 0.5) / n_;
      corners_.push_back({2 * std::cos(corner), 2 * std::sin(corner), 0});
      normals_.push_back({std::cos(side), std::sin(side), 0});
    }
    make_vertices();
    make_edges();
    make_faces();
    solid.shells.emplace_back();
    for (Index f = 0; f < solid.faces.size(); ++f) solid.shells[0].push_back(f);
  }

  /// By the formula of Steiner for parallel bodies.
  test::Wanted wanted() const {
    const double side = 4 * std::sin(kTurn / 2 / n_);
    const double base = n_ * 2 * std::sin(kTurn / n_);
    const double area = 2 * base + n_ * side;
    const double edges = n_ * side * kTurn / 2 + kTurn;  // lengths times outer angles
    return {base + area * fillet_ + edges / 2 * fillet_ * fillet_ +
                2 * kTurn / 3 * fillet_ * fillet_ * fillet_,
            area + edges * fillet_ + 2 * kTurn * fillet_ * fillet_};
  }

  BoundaryRepresentation solid;

 private:
  // Vertices of corner i at the bottom (0) or top (1): on the side before it, on the side after it,
  // and on the cap.
  Index vertex(Index i, Index end, Index which) const { return 6 * (i % n_) + 3 * end + which; }
  // Edges of corner i: the arc between the sides, and from each side to the cap; a vertical line at
  // each side. Of side i: a line along the side and along the cap.
  Index arc(Index i, Index end, Index which) const { return 12 * (i % n_) + 3 * end + which; }
  Index upright(Index i, Index which) const { return 12 * (i % n_) + 6 + which; }
  Index along(Index i, Index end, Index which) const { return 12 * (i % n_) + 8 + 2 * end + which; }

  Vector3 centre(Index i, Index end) const {
    return corners_[i % n_] + kUp * (end == 0 ? -0.5 : 0.5);
  }
  const Vector3& before(Index i) const { return normals_[(i + n_ - 1) % n_]; }
  const Vector3& after(Index i) const { return normals_[i % n_]; }
  static Vector3 outwards(Index end) { return kUp * (end == 0 ? -1.0 : 1.0); }

  void make_vertices() {
    for (Index i = 0; i < n_; ++i) {
      for (Index end = 0; end < 2; ++end) {
        for (const Vector3& direction : {before(i), after(i), outwards(end)}) {
          solid.vertices.push_back(centre(i, end) + direction * fillet_);
        }
      }
    }
  }

  void add_arc(Index i, Index end, Index from, Index to, const Vector3& x, const Vector3& y) {
    const Frame frame = surfaces::frame_of(centre(i, end), surfaces::cross(x, y), x);
    solid.edges.push_back({vertex(i, end, from), vertex(i, end, to),
                           surfaces::ellipse(frame, fillet_, fillet_), true});
  }

  void make_edges() {
    for (Index i = 0; i < n_; ++i) {
      for (Index end = 0; end < 2; ++end) {
        add_arc(i, end, 0, 1, before(i), after(i));
        add_arc(i, end, 0, 2, before(i), outwards(end));
        add_arc(i, end, 1, 2, after(i), outwards(end));
      }
      for (Index which = 0; which < 2; ++which) {
        solid.edges.push_back({vertex(i, 0, which), vertex(i, 1, which), {}, true});
      }
      for (Index end = 0; end < 2; ++end) {
        solid.edges.push_back({vertex(i, end, 1), vertex(i + 1, end, 0), {}, true});
        solid.edges.push_back({vertex(i, end, 2), vertex(i + 1, end, 2), {}, true});
      }
    }
  }

  void add_face(std::optional<Surface> surface, EdgeLoop loop, Index end = 1) {
    if (end == 0) surfaces::turn(loop);
    solid.faces.push_back({"face", std::move(surface), true, {std::move(loop)}, 0, ""});
  }

  void make_faces() {
    for (Index i = 0; i < n_; ++i) {
      const Frame upright_axis = surfaces::frame_of(corners_[i], kUp, before(i));
      add_face(surfaces::cylinder(upright_axis, fillet_), {{arc(i, 0, 0), true},
                                                           {upright(i, 1), true},
                                                           {arc(i, 1, 0), false},
                                                           {upright(i, 0), false}});
      add_face({}, {{along(i, 0, 0), true},
                    {upright(i + 1, 0), true},
                    {along(i, 1, 0), false},
                    {upright(i, 1), false}});
      for (Index end = 0; end < 2; ++end) {
        add_face(surfaces::sphere(surfaces::frame_of(centre(i, end), kUp, before(i)), fillet_),
                 {{arc(i, end, 0), true}, {arc(i, end, 2), true}, {arc(i, end, 1), false}}, end);
        const Vector3 way = corners_[(i + 1) % n_] + corners_[i] * -1.0;
        add_face(surfaces::cylinder(surfaces::frame_of(centre(i, end), way, after(i)), fillet_),
                 {{along(i, end, 0), true},
                  {arc(i + 1, end, 1), true},
                  {along(i, end, 1), false},
                  {arc(i, end, 2), false}},
                 end);
      }
    }
    for (Index end = 0; end < 2; ++end) {
      EdgeLoop cap;
      for (Index i = 0; i < n_; ++i) cap.push_back({along(i, end, 1), true});
      add_face({}, std::move(cap), end);
    }
  }

  Index n_;
  double fillet_;
  std::vector<Vector3> corners_;  // in the plane between bottom and top
  std::vector<Vector3> normals_;  // of the sides
};

/// A patch over about a unit square, with weights from 0.5 to 2.
Surface random_patch(std::size_t degree_u, std::size_t degree_v, std::mt19937& random) {
  std::uniform_real_distribution<double> height(-0.4, 0.4);
  std::uniform_real_distribution<double> weight(0.5, 2);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  surfaces::BezierPatch patch{degree_u + 1, {}};
  for (std::size_t k = 0; k <= degree_v; ++k) {
    for (std::size_t i = 0; i <= degree_u; ++i) {
      const Vector3 place{(static_cast<double>(i) + shift(random)) / static_cast<double>(degree_u),
                          (static_cast<double>(k) + shift(random)) / static_cast<double>(degree_v),
                          height(random)};
      patch.points.push_back(surfaces::weighted(place, weight(random)));
    }
  }
  return Surface{{0, 1}, {0, 1}, {std::move(patch)}, {}, {}};
}

/// The patch as a face between its four sides; no solid.
BoundaryRepresentation face_of(const Surface& surface) {
  BoundaryRepresentation solid;
  const surfaces::BezierPatch& patch = surface.patches[0];
  const std::size_t columns = patch.columns;
  const std::size_t rows = patch.rows();
  std::array<surfaces::BezierCurve, 4> sides;
  for (std::size_t i = 0; i < columns; ++i) {
    sides[0].points.push_back(patch.points[i]);
    sides[2].points.push_back(patch.points[rows * columns - 1 - i]);
  }
  for (std::size_t k = 0; k < rows; ++k) {
    sides[1].points.push_back(patch.points[(k + 1) * columns - 1]);
    sides[3].points.push_back(patch.points[(rows - 1 - k) * columns]);
  }
  EdgeLoop loop;
  for (Index side = 0; side < 4; ++side) {
    solid.vertices.push_back(sides[side].points.front().place());
    solid.edges.push_back({side, (side + 1) % 4, {{0, 1}, {sides[side]}, false}, true});
    loop.push_back({side, true});
  }
  solid.faces.push_back({"patch", surface, true, {std::move(loop)}, 0, ""});
  solid.shells = {{0}};
  return solid;
}

}  // namespace

TEST_CASE("a prism with rounded edges, 200 faces, becomes a valid solid") {
  const RoundedPrism prism(33, 0.125);
  REQUIRE(prism.solid.faces.size() == 200);
  for (const double chord : {0.02, 0.002}) {
    const auto result = test::check(prism.solid, chord, prism.wanted());
    CHECK(result.measures.faces == 200);
    CHECK(result.measures.turned == 0);
  }
}

TEST_CASE("a box with rounded edges becomes a valid solid") {
  const RoundedPrism box(4, 0.25);
  REQUIRE(box.solid.faces.size() == 26);
  test::check(box.solid, 0.001, box.wanted());
}

TEST_CASE("triangles of rational patches of degree 2 to 5 are nowhere farther off than the chord") {
  std::mt19937 random(21);
  for (std::size_t u = 2; u <= 5; ++u) {
    for (std::size_t v = 2; v <= 5; ++v) {
      CAPTURE(u, v);
      const Surface surface = random_patch(u, v, random);
      surfaces::TessellateOptions options;
      options.chord = 0.01;
      // A point that is nearer than the chord need not be the nearest one.
      const surfaces::Inverter inverter(surface, options.chord);
      std::optional<surfaces::Parameters> last;
      const auto result = surfaces::tessellate(face_of(surface), options);
      REQUIRE(result);
      REQUIRE(result->left_out.empty());
      CHECK(result->measures.chord_error <= options.chord);
      CHECK(test::farthest(
                *result,
                [&](const Vector3& place) {
                  const auto found = inverter.invert(place, last);
                  last = found.at;
                  return found.gap;
                },
                test::Points::ten) <= options.chord);
    }
  }
}

}  // namespace watertight
