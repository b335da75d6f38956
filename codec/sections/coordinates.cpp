// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/sections/coordinates.h"

#include <cmath>
#include <cstdint>
#include <string>

namespace watertight::codec {
namespace {

constexpr std::int64_t kLargest = std::int64_t{1} << 53;  // doubles hold every integer up to here

enum class Coordinates : std::uint8_t { integers = 0, doubles = 1 };

// A vertex takes at least three bytes: three differences of one byte each.
constexpr std::size_t kLeastVertexBytes = 3;

bool is_integer(double value) {
  return value >= -static_cast<double>(kLargest) && value <= static_cast<double>(kLargest) &&
         std::trunc(value) == value;
}

Error malformed_vertices(const char* what) {
  return {ErrorCode::malformed, std::string("the vertex section ") + what};
}

Status check_count(std::uint64_t count, std::size_t remaining, const Limits& limits) {
  if (count > limits.vertices) {
    return Error{ErrorCode::limit_exceeded, std::to_string(count) +
                                                " vertices in one solid; the limit is " +
                                                std::to_string(limits.vertices)};
  }
  if (count > remaining / kLeastVertexBytes) {
    return malformed_vertices("is too short for its number of vertices");
  }
  return Done{};
}

/// True unless the value is infinite, not a number, or -0.
bool is_coordinate(double value) {
  return std::isfinite(value) && !(value == 0 && std::signbit(value));
}

/// Reads integer coordinates. Keeps the last ones as int64, so that hostile differences cannot
/// overflow.
class IntegerReader {
 public:
  explicit IntegerReader(ByteReader& reader) : reader_(reader) {}

  bool next(Point& point, bool is_first) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_difference = !is_first && axis == 0;
      std::int64_t delta = 0;
      if (is_difference) {
        const std::uint64_t step = reader_.varint();
        if (step > static_cast<std::uint64_t>(2 * kLargest)) return false;
        delta = static_cast<std::int64_t>(step);
      } else {
        delta = reader_.zigzag();
        if (delta > 2 * kLargest || delta < -2 * kLargest) return false;
      }
      last_[axis] += delta;
      if (last_[axis] > kLargest || last_[axis] < -kLargest) return false;
      point[axis] = static_cast<double>(last_[axis]);
    }
    return !reader_.failed();
  }

 private:
  ByteReader& reader_;
  std::int64_t last_[3] = {0, 0, 0};
};

bool read_double(ByteReader& reader, double& value) {
  value = reader.f64();
  return !reader.failed() && is_coordinate(value);
}

}  // namespace

bool are_integers(std::span<const Point> points) {
  for (const Point& p : points) {
    if (!is_integer(p.x) || !is_integer(p.y) || !is_integer(p.z)) return false;
  }
  return true;
}

Bytes write_vertices(std::span<const Point> points) {
  ByteWriter writer;
  const bool integers = are_integers(points);
  writer.u8(static_cast<std::uint8_t>(integers ? Coordinates::integers : Coordinates::doubles));
  writer.varint(points.size());
  std::int64_t last[3] = {0, 0, 0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!integers) {
        writer.f64(points[i][axis]);
        continue;
      }
      const auto value = static_cast<std::int64_t>(points[i][axis]);
      const std::int64_t delta = value - last[axis];
      // Vertices are sorted, so that x never falls: its difference needs no sign.
      if (i > 0 && axis == 0) {
        writer.varint(static_cast<std::uint64_t>(delta));
      } else {
        writer.zigzag(delta);
      }
      last[axis] = value;
    }
  }
  return std::move(writer).bytes();
}

Result<std::vector<Point>> read_vertices(ByteView section, const Limits& limits) {
  ByteReader reader(section);
  const std::uint8_t kind = reader.u8();
  const std::uint64_t count = reader.varint();
  if (reader.failed() || kind > static_cast<std::uint8_t>(Coordinates::doubles)) {
    return malformed_vertices("does not start with a kind and a count");
  }
  if (auto status = check_count(count, reader.remaining(), limits); !status) return status.error();
  std::vector<Point> points(static_cast<std::size_t>(count));
  IntegerReader integers(reader);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point& p = points[i];
    bool is_good = true;
    if (kind == static_cast<std::uint8_t>(Coordinates::integers)) {
      is_good = integers.next(p, i == 0);
    } else {
      for (int axis = 0; axis < 3; ++axis) is_good = is_good && read_double(reader, p[axis]);
    }
    if (!is_good) return malformed_vertices("has a coordinate not finite or out of range");
    if (i > 0 && !(points[i - 1] < p)) return malformed_vertices("is not sorted");
  }
  if (reader.remaining() != 0) return malformed_vertices("is longer than its vertices");
  // Each solid has one form only: integers are never written as doubles.
  if (kind == static_cast<std::uint8_t>(Coordinates::doubles) && are_integers(points)) {
    return malformed_vertices("writes integers as doubles");
  }
  return points;
}

Bytes write_steiner_vertices(std::span<const Point> points) {
  ByteWriter writer;
  writer.varint(points.size());
  for (const Point& p : points) {
    unsigned flags = 0;
    for (int axis = 0; axis < 3; ++axis) flags |= (is_integer(p[axis]) ? 1U : 0U) << axis;
    writer.u8(static_cast<std::uint8_t>(flags));
    for (int axis = 0; axis < 3; ++axis) {
      if (is_integer(p[axis])) {
        writer.zigzag(static_cast<std::int64_t>(p[axis]));
      } else {
        writer.f64(p[axis]);
      }
    }
  }
  return std::move(writer).bytes();
}

Result<std::vector<Point>> read_steiner_vertices(ByteView section, const Limits& limits) {
  ByteReader reader(section);
  const std::uint64_t count = reader.varint();
  if (reader.failed()) return malformed_vertices("of Steiner points does not start with a count");
  if (auto status = check_count(count, reader.remaining(), limits); !status) return status.error();
  std::vector<Point> points(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point& p = points[i];
    const unsigned flags = reader.u8();
    bool is_good = flags < 8;
    for (int axis = 0; axis < 3 && is_good; ++axis) {
      if (((flags >> axis) & 1U) != 0) {
        const std::int64_t value = reader.zigzag();
        is_good = value <= kLargest && value >= -kLargest;
        p[axis] = static_cast<double>(value);
      } else {
        is_good = read_double(reader, p[axis]) && !is_integer(p[axis]);
      }
    }
    if (!is_good || reader.failed()) {
      return malformed_vertices("of Steiner points has a coordinate not finite or out of range");
    }
    if (i > 0 && !(points[i - 1] < p)) return malformed_vertices("of Steiner points is not sorted");
  }
  if (reader.remaining() != 0) return malformed_vertices("of Steiner points is longer than they");
  return points;
}

}  // namespace watertight::codec
