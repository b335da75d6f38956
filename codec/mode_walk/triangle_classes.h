// SPDX-License-Identifier: GPL-3.0-or-later
//
// Classes of how well a triangle continues a surface: all that the walk knows of the geometry. They
// follow from IEEE + - * / and sqrt in a fixed order, compared with constants, so that every
// machine finds the same classes. Part of the format (docs/format-walk.md, "The walk").
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "codec/entropy/context.h"
#include "geometry/point.h"
#include "geometry/vector3.h"

namespace watertight::codec::walk {

inline constexpr std::uint32_t kBendClasses = 12;
inline constexpr std::uint32_t kSideClasses = 3;
inline constexpr std::uint32_t kDeviationClasses = 6;
inline constexpr std::uint32_t kRadiusClasses = 10;
inline constexpr std::uint32_t kParallelogramClasses = 12;
inline constexpr std::uint32_t kSphereClasses = 21;
inline constexpr std::uint32_t kRatioClasses = 10;
inline constexpr std::uint32_t kGabrielClasses = 4;

/// An edge from a to b with the triangle (a, b, o) on one side.
struct Gate {
  Point a, b, o;
  geometry::Vector3 along{};   // b - a
  geometry::Vector3 normal{};  // along x (o - a)
  double length2 = 0;          // the squared length of `along`
  double normal2 = 0;          // the squared length of `normal`
  Gate(const Point& from, const Point& to, const Point& corner);
};

/// The classes of a triangle (b, a, w) beyond a gate.
struct Continuation {
  Context<kBendClasses> bend;            // angle between the normals, in twelfths of a half turn
  Context<kSideClasses> side;            // w is below the gate's plane, in it, above it
  Context<kDeviationClasses> deviation;  // distance of w from the gate's plane, in grid steps
  Context<kRadiusClasses> radius;  // circumradius divided by the gate's length, in steps of sqrt(2)
  /// Class of |w - (a + b - o)| / |gate|, in steps of sqrt(2).
  Context<kParallelogramClasses> parallelogram;
};
Continuation continuation(const Gate& gate, const Point& w);

/// The classes of a face between the tetrahedra on its two sides.
struct FaceShape {
  std::uint8_t sphere;   // angle between the circumspheres of its two tetrahedra
  std::uint8_t ratio;    // ratio of the radii of these circumspheres, in steps of sqrt(2)
  std::uint8_t gabriel;  // number of these radii above 1.3 times the face's, or infinite
};
/// The shape of a triangle that is no Delaunay face: classes that no face has. `edges`: 1 if the
/// triangle's edge at the start of the gate is a Delaunay edge, plus 2 if its edge at the end is
/// one.
constexpr FaceShape no_face(std::uint32_t edges) {
  return {static_cast<std::uint8_t>(kSphereClasses - 4 + edges), kRatioClasses - 1,
          kGabrielClasses - 1};
}
FaceShape face_shape(std::span<const Point> points, const Triangle& face,
                     const std::array<Index, 2>& apexes);

}  // namespace watertight::codec::walk
