// SPDX-License-Identifier: GPL-3.0-or-later
#include "geopackage/shape_bytes.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace watertight::geopackage {
namespace {

using formats::CityShapes;
using Position = std::array<double, 3>;

constexpr std::uint32_t kUnknownSystem = 0xFFFFFFFF;  // -1: Cartesian, not defined

// Types of well-known binary (OGC 06-103r4, section 8.2.3), with 1000 for z.
constexpr std::uint32_t kPoint = 1001;
constexpr std::uint32_t kLineString = 1002;
constexpr std::uint32_t kPolygon = 1003;
constexpr std::uint32_t kMultiPoint = 1004;
constexpr std::uint32_t kMultiLineString = 1005;
constexpr std::uint32_t kMultiPolygon = 1006;
constexpr std::uint32_t kCollection = 1007;

class ShapeWriter {
 public:
  /// Begins with the header (OGC 12-128r18, section 2.1.3): little-endian, the box with z.
  ShapeWriter(std::uint32_t srid, const Position& min, const Position& max) {
    constexpr std::uint8_t kLittleEndianBoxWithZ = 1U | 2U << 1U;
    bytes_.append(as_bytes("GP"));
    bytes_.u8(0);  // the version
    bytes_.u8(kLittleEndianBoxWithZ);
    bytes_.u32(srs_id_of(srid));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bytes_.f64(min[axis]);
      bytes_.f64(max[axis]);
    }
  }

  void begin(std::uint32_t type) {
    bytes_.u8(1);  // little-endian
    bytes_.u32(type);
  }
  void count(std::size_t number) { bytes_.u32(static_cast<std::uint32_t>(number)); }
  void position(const Position& position) {
    for (const double number : position) bytes_.f64(number);
  }
  Bytes take() { return std::move(bytes_).bytes(); }

 private:
  static std::uint32_t srs_id_of(std::uint32_t srid) { return srid == 0 ? kUnknownSystem : srid; }

  ByteWriter bytes_;
};

void write_polygons(ShapeWriter& writer, const CityShapes& shapes) {
  writer.begin(kMultiPolygon);
  writer.count(shapes.polygons.size());
  for (const CityShapes::Polygon& polygon : shapes.polygons) {
    writer.begin(kPolygon);
    writer.count(polygon.size());
    for (const CityShapes::Ring& ring : polygon) {
      writer.count(ring.size() + 1);
      for (const std::size_t index : ring) writer.position(shapes.positions[index]);
      writer.position(shapes.positions[ring.front()]);
    }
  }
}

void write_lines(ShapeWriter& writer, const CityShapes& shapes) {
  writer.begin(kMultiLineString);
  writer.count(shapes.lines.size());
  for (const CityShapes::Ring& line : shapes.lines) {
    writer.begin(kLineString);
    writer.count(line.size());
    for (const std::size_t index : line) writer.position(shapes.positions[index]);
  }
}

void write_points(ShapeWriter& writer, const CityShapes& shapes) {
  writer.begin(kMultiPoint);
  writer.count(shapes.points.size());
  for (const std::size_t index : shapes.points) {
    writer.begin(kPoint);
    writer.position(shapes.positions[index]);
  }
}

/// Gives `shape` the box around the positions that the shapes use.
void find_box(const CityShapes& shapes, ShapeBytes& shape) {
  shape.min.fill(std::numeric_limits<double>::infinity());
  shape.max.fill(-std::numeric_limits<double>::infinity());
  const auto add = [&](std::size_t index) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = shapes.positions[index][axis];
      shape.min[axis] = std::min(shape.min[axis], value);
      shape.max[axis] = std::max(shape.max[axis], value);
    }
  };
  for (const CityShapes::Polygon& polygon : shapes.polygons) {
    for (const CityShapes::Ring& ring : polygon) std::for_each(ring.begin(), ring.end(), add);
  }
  for (const CityShapes::Ring& line : shapes.lines) std::for_each(line.begin(), line.end(), add);
  std::for_each(shapes.points.begin(), shapes.points.end(), add);
}

}  // namespace

std::optional<ShapeBytes> shape_bytes(const CityShapes& shapes, std::uint32_t srid) {
  const std::size_t kinds = (shapes.polygons.empty() ? 0U : 1U) + (shapes.lines.empty() ? 0U : 1U) +
                            (shapes.points.empty() ? 0U : 1U);
  if (kinds == 0) return std::nullopt;
  ShapeBytes shape;
  find_box(shapes, shape);
  ShapeWriter writer(srid, shape.min, shape.max);
  if (kinds > 1) {
    writer.begin(kCollection);
    writer.count(kinds);
  }
  if (!shapes.polygons.empty()) write_polygons(writer, shapes);
  if (!shapes.lines.empty()) write_lines(writer, shapes);
  if (!shapes.points.empty()) write_points(writer, shapes);
  if (kinds == 1 && !shapes.polygons.empty()) shape.type = ShapeType::multi_polygon;
  shape.bytes = writer.take();
  return shape;
}

ShapeBytes point_bytes(const Position& position, std::uint32_t srid) {
  ShapeWriter writer(srid, position, position);
  writer.begin(kPoint);
  writer.position(position);
  return {writer.take(), position, position, ShapeType::point};
}

}  // namespace watertight::geopackage
