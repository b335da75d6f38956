// SPDX-License-Identifier: GPL-3.0-or-later
//
// Families at the ends of the range of numbers: integers near 2^53, and doubles from 1e-300 to
// 1e300.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/verdict/exact.h"
#include "bench/verdict/families.h"
#include "bench/verdict/surface.h"

namespace watertight::verdict {
namespace {

/// A slim box from 0 to about `top` (2^50 to 2^53) with a slanted top facet, and a tetrahedron as
/// cavity whose corners are on the top facet and on the sides near the top.
Shape tall_box(Random& random) {
  const double top =
      std::ldexp(1, 50 + static_cast<int>(random.below(3))) + random.within(0, 1'000'000) + 100;
  const double width = 8;
  const double along_x = random.within(-2, 2);
  const double along_y = random.within(-2, 2);
  const auto roof = [&](double x, double y) { return top + along_x * x + along_y * y; };
  Shell box = solids::box({0, 0, 0}, {width, width, top});
  std::array<Point, 4> cavity;
  for (Facet& facet : box) {
    for (Point& p : facet[0]) p.z = p.z == 0 ? 0 : roof(p.x, p.y);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = random.within(1, 7);
    const double y = random.within(1, 7);
    cavity[i] = {x, y, roof(x, y) - random.within(1, 6)};
    if (i < 2 && !one_in(random, 5)) cavity[i] = {x, y, roof(x, y)};
    if (i >= 2 && !one_in(random, 5)) {
      const double side = i == 2 ? 0 : width;
      cavity[i] = {x, side, roof(x, side) - random.within(0, 3)};
    }
  }
  return {box, as_cavity(outward_tetrahedron(cavity))};
}

bool is_flat(const Shell& tetrahedron) {
  const Ring& base = tetrahedron[0][0];
  for (const Facet& facet : tetrahedron) {
    for (const Point& p : facet[0]) {
      const Vector a = exact(base[0]);
      const Vector normal = cross(difference(exact(base[1]), a), difference(exact(base[2]), a));
      if (sgn(dot(normal, difference(exact(p), a))) != 0) return false;
    }
  }
  return true;
}

Shape room_and_tetrahedra(Random& random) {
  Shape shape{solids::box({0, 0, 0}, {24, 24, 24})};
  for (std::uint64_t k = random.below(3); k > 0; --k) {
    shape.push_back(as_cavity(touching_tetrahedron(random, 24)));
  }
  return shape;
}

Shape touching_shells(Random& random) {
  return one_in(random, 2) ? room_and_tetrahedra(random) : pit_and_cavity(random);
}

Solid solid_of_world(const Solid& solid, const geometry::LatticePoints& points) {
  SolidArrays arrays = solid.arrays();
  arrays.vertices = points.points;
  return solids::solid_of(std::move(arrays), points.lattice);
}

bool is_planar(const Solid& solid) {
  const SurfaceModel model = model_of(solid);
  return std::all_of(model.facets.begin(), model.facets.end(),
                     [](const FacetModel& facet) { return facet.is_planar; });
}

/// The solid with coordinates times a power of ten, exactly, as decimals.
Solid scaled_decimals(const Solid& solid, int exponent) {
  std::vector<std::array<GridNumber, 3>> places;
  for (const Point& p : solid.vertices()) {
    const auto number = [&](double value) {
      char text[64];
      std::snprintf(text, sizeof text, "%.0fe%d", value, exponent);
      return geometry::parse_decimal(text).value();
    };
    places.push_back({number(p.x), number(p.y), number(p.z)});
  }
  return solid_of_world(solid, geometry::lattice_of_decimals(places).value());
}

/// The solid with coordinates times powers of two, one for each axis, on the lattice that the
/// doubles get. That lattice may have their shortest decimals, so that facets are not quite planar;
/// the oracle judges these facets. In metres the difference matters for large solids only, which
/// are taken as decimals instead.
Sample scaled(const Solid& solid, Random& random) {
  const int common = static_cast<int>(random.between(-990, 970));
  std::array<int, 3> exponent{common, common, common};
  if (one_in(random, 3)) {
    for (int& e : exponent) e += static_cast<int>(random.between(-4, 4));
  }
  std::vector<std::array<double, 3>> places;
  for (const Point& p : solid.vertices()) {
    places.push_back(
        {std::ldexp(p.x, exponent[0]), std::ldexp(p.y, exponent[1]), std::ldexp(p.z, exponent[2])});
  }
  Sample sample = sample_of(solid_of_world(solid, geometry::lattice_of_doubles(places).value()));
  if (common > -10 && !is_planar(sample.members.front())) {
    sample.members.front() = scaled_decimals(solid, common * 3 / 10);
  }
  sample.may_be_undecided = common < -470 || common > 460;  // 2^-470 is about 1e-141
  return sample;
}

/// A cube of 1000 x 10^k with one corner raised by a thousandth of its size. A quarter of that is
/// the distance from the best plane: 203 for k >= 0, no finding below k = -2. The fold is less than
/// a degree at any size.
Sample folded_cube(Random& random) {
  const int exponent = one_in(random, 4) ? static_cast<int>(random.between(0, 200))
                                         : static_cast<int>(random.between(-280, -3));
  Shell box = solids::box({0, 0, 0}, {1000, 1000, 1000});
  const Point raised{random.within(0, 1) * 1000, random.within(0, 1) * 1000, 1000};
  for (Facet& facet : box) {
    for (Point& p : facet[0]) {
      if (p == raised) p.z = 1001;
    }
  }
  AffineMap map = solids::axis_permutation(random, one_in(random, 2));
  if (one_in(random, 2)) map.matrix[0] = {-map.matrix[0][0], -map.matrix[0][1], -map.matrix[0][2]};
  Sample sample = sample_of(scaled_decimals(placed({box}, map, 0, random), exponent));
  Truth truth;
  if (exponent >= 0) truth.codes = {203};
  truth.reason = exponent >= 0 ? "a corner is far from the plane" : "";
  sample.truth = truth;
  sample.may_be_undecided = exponent < -143 || exponent > 147;  // beyond 1e-140 and 1e150 m
  return sample;
}

}  // namespace

Sample make_large_integers(Random& random) {
  AffineMap map = solids::axis_permutation(random, one_in(random, 2));
  if (one_in(random, 2)) {
    Shape shape = tall_box(random);
    while (is_flat(shape[1])) shape = tall_box(random);
    Sample sample = sample_of(placed(shape, map, 0, random));
    sample.may_be_undecided = true;  // the extents differ by a factor of more than 2^40
    return sample;
  }
  // The solid is small, but far from the origin of the lattice.
  for (std::int64_t& shift : map.shift) {
    const std::int64_t power = std::int64_t{1} << (50 + random.below(3));
    shift = one_in(random, 2) ? power + random.between(0, 1'000'000) : 0;
  }
  Sample sample = sample_of(placed(touching_shells(random), map, 0, random));
  sample.may_be_undecided = true;  // no Steiner point fits between integers of this size
  return sample;
}

Sample make_scales(Random& random) {
  if (one_in(random, 2)) return folded_cube(random);
  return scaled(placed(touching_shells(random), any_map(random), 0, random), random);
}

}  // namespace watertight::verdict
