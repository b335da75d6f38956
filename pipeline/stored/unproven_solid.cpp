// SPDX-License-Identifier: GPL-3.0-or-later
//
// The line is a list of numbers with single spaces between them: the kind of the lattice; mantissa
// and exponent of its three steps and its origin's three coordinates; the EPSG code; the vertices;
// the vertices of the rings; the sizes of rings, facets and shells. Each list begins with its
// length. Integer coordinates are written as differences to the vertex before, which compress well,
// and doubles in the shortest digits that read back as the same doubles.
#include "pipeline/stored/unproven_solid.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace watertight::pipeline {
namespace {

constexpr double kLargestInteger = 0x1p53;

class NumberWriter {
 public:
  template <class Number>
  void add(Number number) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    if (!text_.empty()) text_ += ' ';
    text_.append(digits.data(), end);
  }
  /// The sizes of the ranges between offsets.
  void add_sizes(const std::vector<Index>& offsets) {
    add(offsets.size() - 1);
    for (std::size_t i = 1; i < offsets.size(); ++i) add(offsets[i] - offsets[i - 1]);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Reads numbers from the front. After a failure all numbers are 0.
class NumberReader {
 public:
  explicit NumberReader(std::string_view text) : text_(text) {}

  template <class Number>
  Number take() {
    Number number{};
    const char* const end = text_.data() + text_.size();
    const auto [rest, error] = std::from_chars(text_.data(), end, number);
    const bool is_separated = rest == end || *rest == ' ';
    if (has_failed_ || error != std::errc{} || !is_separated) {
      has_failed_ = true;
      return Number{};
    }
    text_.remove_prefix(static_cast<std::size_t>(rest - text_.data()) + (rest == end ? 0 : 1));
    is_at_end_ = rest == end;
    return number;
  }
  /// The length of a list whose elements take two characters each at least: `per_element` times.
  std::size_t take_length(std::size_t per_element) {
    const auto length = take<std::uint64_t>();
    if (length > text_.size() / per_element + 1) has_failed_ = true;
    return has_failed_ ? 0 : static_cast<std::size_t>(length);
  }
  std::vector<Index> take_sizes() {
    std::vector<Index> offsets{0};
    const std::size_t count = take_length(1);
    for (std::size_t i = 0; i < count && !has_failed_; ++i) {
      const std::uint64_t end = offsets.back() + std::uint64_t{take<Index>()};
      if (end > std::numeric_limits<Index>::max()) has_failed_ = true;
      offsets.push_back(static_cast<Index>(end));
    }
    return offsets;
  }
  bool has_failed() const { return has_failed_; }
  bool is_done() const { return !has_failed_ && is_at_end_; }

 private:
  std::string_view text_;
  bool has_failed_ = false;
  bool is_at_end_ = false;
};

bool is_integer(double value) {
  return std::abs(value) < kLargestInteger && value == std::floor(value);
}

/// Whether all coordinates can be written as integers.
bool are_integers(std::span<const Point> points) {
  for (const Point& p : points) {
    if (!is_integer(p.x) || !is_integer(p.y) || !is_integer(p.z)) return false;
  }
  return true;
}

using Steps = std::array<std::int64_t, 3>;

void add_vertices(NumberWriter& writer, std::span<const Point> points) {
  const bool integers = are_integers(points);
  writer.add(points.size());
  writer.add(integers ? 1 : 0);
  Steps last{};
  for (const Point& p : points) {
    const std::array<double, 3> place{p.x, p.y, p.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!integers) {
        writer.add(place[axis]);
        continue;
      }
      const auto value = static_cast<std::int64_t>(place[axis]);
      writer.add(value - last[axis]);
      last[axis] = value;
    }
  }
}

std::vector<Point> take_vertices(NumberReader& reader) {
  const std::size_t count = reader.take_length(6);
  const bool integers = reader.take<int>() == 1;
  std::vector<Point> points;
  points.reserve(count);
  Steps last{};
  for (std::size_t i = 0; i < count && !reader.has_failed(); ++i) {
    std::array<double, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!integers) {
        place[axis] = reader.take<double>();
        continue;
      }
      // Hostile differences may leave the range; the sum wraps and is no integer double then.
      last[axis] =
          static_cast<std::int64_t>(static_cast<std::uint64_t>(last[axis]) +
                                    static_cast<std::uint64_t>(reader.take<std::int64_t>()));
      place[axis] = static_cast<double>(last[axis]);
    }
    points.push_back({place[0], place[1], place[2]});
  }
  return points;
}

}  // namespace

std::string write_unproven(const Solid& solid) {
  NumberWriter writer;
  const geometry::Lattice& lattice = solid.lattice();
  writer.add(static_cast<int>(lattice.kind));
  for (const auto& numbers : {lattice.step, lattice.origin}) {
    for (const geometry::GridNumber& number : numbers) {
      writer.add(number.mantissa);
      writer.add(number.exponent);
    }
  }
  writer.add(solid.srid());
  const SolidArrays& arrays = solid.arrays();
  add_vertices(writer, arrays.vertices);
  writer.add(arrays.ring_vertices.size());
  for (const Index vertex : arrays.ring_vertices) writer.add(vertex);
  for (const auto* offsets : {&arrays.ring_offsets, &arrays.facet_offsets, &arrays.shell_offsets}) {
    writer.add_sizes(*offsets);
  }
  return writer.take();
}

Result<Solid> read_unproven(std::string_view line, const Limits& limits) {
  NumberReader reader(line);
  geometry::Lattice lattice;
  const int kind = reader.take<int>();
  if (kind < 0 || kind > static_cast<int>(geometry::LatticeKind::float64)) {
    return Error{ErrorCode::malformed, "an unproven solid on an unknown lattice"};
  }
  lattice.kind = static_cast<geometry::LatticeKind>(kind);
  for (auto* numbers : {&lattice.step, &lattice.origin}) {
    for (geometry::GridNumber& number : *numbers) {
      number.mantissa = reader.take<std::int64_t>();
      number.exponent = reader.take<std::int32_t>();
    }
  }
  const auto srid = reader.take<std::uint32_t>();
  SolidArrays arrays;
  arrays.vertices = take_vertices(reader);
  const std::size_t corners = reader.take_length(2);
  arrays.ring_vertices.reserve(corners);
  for (std::size_t i = 0; i < corners && !reader.has_failed(); ++i) {
    arrays.ring_vertices.push_back(reader.take<Index>());
  }
  for (auto* offsets : {&arrays.ring_offsets, &arrays.facet_offsets, &arrays.shell_offsets}) {
    *offsets = reader.take_sizes();
  }
  if (!reader.is_done()) {
    return Error{ErrorCode::malformed, "truncated or malformed numbers of an unproven solid"};
  }
  return Solid::make(std::move(arrays), lattice, srid, limits);
}

}  // namespace watertight::pipeline
