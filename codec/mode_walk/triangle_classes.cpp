// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/triangle_classes.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace watertight::codec::walk {
namespace {

using Vector = geometry::Vector3;
using geometry::cross;
using geometry::difference;
using geometry::dot;
using geometry::operator-;

/// cos(k pi / 12) for k = 1 to 11.
constexpr std::array<double, 11> kBends{0.96592582628906828,  0.86602540378443865,
                                        0.70710678118654752,  0.5,
                                        0.25881904510252076,  0.0,
                                        -0.25881904510252076, -0.5,
                                        -0.70710678118654752, -0.86602540378443865,
                                        -0.96592582628906828};
/// The bounds of the angle between two spheres are the same cosines.
constexpr auto& kSphereBends = kBends;

// Fixed by the format (docs/format-walk.md, "Contexts of Candidate and Distant").
constexpr double kFlat = 1e-18;  // the greatest squared distance from a plane, in grid steps, that
                                 // counts as 0
constexpr std::array<double, 4> kSquaredDistances{1, 9, 100,
                                                  2500};  // squared distances, in grid steps
constexpr int kLeastRadius = -2;         // log2 of the square at which the first class ends
constexpr int kLeastParallelogram = -6;  // log2 of the square at which the first class ends
constexpr double kGabriel2 = 1.69;       // square of the ratio of radii from which a side counts
constexpr std::array<double, 4> kShares2{0.64, 0.36, 0.16, 0.04};  // squares of ratios of radii

/// The number of descending bounds that lie above x.
template <std::size_t size>
std::uint32_t class_below(const std::array<double, size>& bounds, double x) {
  std::uint32_t result = 0;
  while (result < size && !(x >= bounds[result])) ++result;
  return result;
}

/// floor(log2(x)) - least, clamped to the classes; x <= 0 is in the first class.
template <std::uint32_t classes>
Context<classes> octave(double x, int least) {
  if (!(x > 0)) return Context<classes>(0U);
  const int exponent = static_cast<int>((std::bit_cast<std::uint64_t>(x) >> 52) & 2047U) - 1023;
  return capped<classes>(exponent - least);
}

/// The squared radius of the sphere through the origin, b, c and d, and its centre; a radius of 0
/// if rounding leaves no volume.
struct Sphere {
  Vector centre{};
  double radius2 = 0;
};

Sphere circumsphere(const Vector& b, const Vector& c, const Vector& d) {
  const Vector cd = cross(c, d);
  const Vector db = cross(d, b);
  const Vector bc = cross(b, c);
  const double volume = 2 * dot(b, cd);
  Sphere sphere;
  if (volume == 0) return sphere;
  const double b2 = dot(b, b);
  const double c2 = dot(c, c);
  const double d2 = dot(d, d);
  for (std::size_t i = 0; i < 3; ++i) {
    sphere.centre[i] = (b2 * cd[i] + c2 * db[i] + d2 * bc[i]) / volume;
  }
  sphere.radius2 = dot(sphere.centre, sphere.centre);
  return sphere;
}

}  // namespace

Gate::Gate(const Point& from, const Point& to, const Point& corner)
    : a(from),
      b(to),
      o(corner),
      along(difference(to, from)),
      normal(cross(along, difference(corner, from))),
      length2(dot(along, along)),
      normal2(dot(normal, normal)) {}

Continuation continuation(const Gate& gate, const Point& w) {
  const Vector from_a = difference(w, gate.a);
  const Vector from_b = difference(w, gate.b);
  const Vector normal = cross(from_b, gate.along);
  const double normal2 = dot(normal, normal);
  const double product = dot(gate.normal, normal);
  const double both = std::sqrt(gate.normal2 * normal2);
  const double height = dot(gate.normal, from_a);
  const double height2 = height * height;
  const Vector off{from_a[0] - (gate.b.x - gate.o.x), from_a[1] - (gate.b.y - gate.o.y),
                   from_a[2] - (gate.b.z - gate.o.z)};

  const bool is_flat = height2 <= kFlat * gate.normal2;
  std::uint32_t deviation = 0;
  if (!is_flat) {
    deviation = 1;
    for (const double distance2 : kSquaredDistances) {
      if (height2 > distance2 * gate.normal2) ++deviation;
    }
  }
  const double sides = dot(from_a, from_a) * dot(from_b, from_b);
  return {.bend = Context<kBendClasses>(both > 0 ? class_below(kBends, product / both)
                                                 : kBendClasses - 1),
          .side = Context<kSideClasses>(is_flat      ? 1U
                                        : height < 0 ? 0U
                                                     : 2U),
          .deviation = Context<kDeviationClasses>(deviation),
          .radius = normal2 > 0 ? octave<kRadiusClasses>(sides / (4 * normal2), kLeastRadius)
                                : Context<kRadiusClasses>(kRadiusClasses - 1),
          .parallelogram =
              octave<kParallelogramClasses>(dot(off, off) / gate.length2, kLeastParallelogram)};
}

FaceShape face_shape(std::span<const Point> points, const Triangle& face,
                     const std::array<Index, 2>& apexes) {
  const Point& origin = points[face[0]];
  const Vector b = difference(points[face[1]], origin);
  const Vector c = difference(points[face[2]], origin);
  const Vector bc = difference(points[face[2]], points[face[1]]);
  const Vector normal = cross(b, c);
  const double normal2 = dot(normal, normal);
  const double radius2 = normal2 > 0 ? dot(b, b) * dot(c, c) * (dot(bc, bc) / (4 * normal2)) : 0;
  std::array<Sphere, 2> spheres;
  std::uint32_t larger = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (apexes[i] != kNone) spheres[i] = circumsphere(b, c, difference(points[apexes[i]], origin));
    if (spheres[i].radius2 == 0 || spheres[i].radius2 > kGabriel2 * radius2) ++larger;
  }
  FaceShape shape{};
  shape.gabriel = static_cast<std::uint8_t>(larger);
  const double r0 = spheres[0].radius2;
  const double r1 = spheres[1].radius2;
  const double least = std::min(r0, r1);
  const double most = std::max(r0, r1);
  if (least > 0) {
    const Vector between = spheres[0].centre - spheres[1].centre;
    const double cosine = (r0 + r1 - dot(between, between)) / (2 * std::sqrt(r0 * r1));
    shape.sphere = static_cast<std::uint8_t>(class_below(kSphereBends, cosine));
    shape.ratio = static_cast<std::uint8_t>(octave<kRatioClasses - 2>(most / least, 0).value);
  } else {
    // A face of the hull has only one circumsphere. Its class is the squared ratio of the radius of
    // the face to the radius of that sphere.
    const double share = most > 0 ? radius2 / most : 0;
    shape.sphere = static_cast<std::uint8_t>(kBendClasses + class_below(kShares2, share));
    shape.ratio = static_cast<std::uint8_t>(kRatioClasses - 2);
  }
  return shape;
}

}  // namespace watertight::codec::walk
