// SPDX-License-Identifier: GPL-3.0-or-later
#include "sql/make_value.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/canonical_form.h"
#include "sql/solid_value.h"
#include "tessellate/facets.h"

namespace watertight::sql {
namespace {

template <class Number>
void put(Bytes& value, std::size_t offset, Number number) {
  std::memcpy(value.data() + offset, &number, sizeof number);
}

/// The largest float that is not above a number.
float float_below(double number) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  if (number > kLargest) return kLargest;
  if (number < -kLargest) return -std::numeric_limits<float>::infinity();
  const auto nearest = static_cast<float>(number);
  return nearest > number ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
                          : nearest;
}

/// -1, 0 or 1 for two lists: the shorter one first, then the first elements that differ.
template <class List>
int order_of(const List& left, const List& right) {
  if (left.size() != right.size()) return left.size() < right.size() ? -1 : 1;
  const auto [one, other] = std::mismatch(left.begin(), left.end(), right.begin());
  if (one == left.end()) return 0;
  return *one < *other ? -1 : 1;
}

int order_of_lattices(const Lattice& left, const Lattice& right) {
  if (left.kind != right.kind) return left.kind < right.kind ? -1 : 1;
  const int order = order_of(left.step, right.step);
  return order != 0 ? order : order_of(left.origin, right.origin);
}

}  // namespace

geometry::Measures measures_of(const Solid& solid) {
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  return geometry::measure(facets.divided_solid(solid), facets.triangles);
}

Result<Bytes> make_value(const Solid& solid, ByteView blob) {
  const auto boundary = OrientedBoundary::make(solid);
  if (!boundary) return boundary.error();
  const geometry::Measures measures = measures_of(solid);
  Bytes value(WATERTIGHT_SOLID_BLOB + blob.size());
  value[0] = WATERTIGHT_SOLID_LAYOUT;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(value, WATERTIGHT_SOLID_BOX + 4 * axis, float_below(measures.box_min[axis]));
    put(value, WATERTIGHT_SOLID_BOX + 12 + 4 * axis, -float_below(-measures.box_max[axis]));
  }
  put(value, WATERTIGHT_SOLID_VOLUME, measures.volume);
  put(value, WATERTIGHT_SOLID_AREA, measures.area);
  put(value, WATERTIGHT_SOLID_HASH, geometry::solid_hash(*boundary));
  put(value, WATERTIGHT_SOLID_SRID, solid.srid());
  std::memcpy(value.data() + WATERTIGHT_SOLID_BLOB, blob.data(), blob.size());
  return value;
}

Result<int> compare(const Solid& left, const Solid& right) {
  const auto one = OrientedBoundary::make(left);
  if (!one) return one.error();
  const auto other = OrientedBoundary::make(right);
  if (!other) return other.error();
  if (left.srid() != right.srid()) return left.srid() < right.srid() ? -1 : 1;
  if (const int order = order_of_lattices(left.lattice(), right.lattice()); order != 0) {
    return order;
  }
  const geometry::CanonicalSolid first = geometry::canonical_form(*one);
  const geometry::CanonicalSolid second = geometry::canonical_form(*other);
  const geometry::SolidArrays& a = first.boundary.solid().arrays();
  const geometry::SolidArrays& b = second.boundary.solid().arrays();
  if (const int order = order_of(a.vertices, b.vertices); order != 0) return order;
  for (const auto part :
       {&geometry::SolidArrays::ring_vertices, &geometry::SolidArrays::ring_offsets,
        &geometry::SolidArrays::facet_offsets, &geometry::SolidArrays::shell_offsets}) {
    if (const int order = order_of(a.*part, b.*part); order != 0) return order;
  }
  return 0;
}

}  // namespace watertight::sql
