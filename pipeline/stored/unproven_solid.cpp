// SPDX-License-Identifier: GPL-3.0-or-later
//
// The line is JSON, in the form of a geometry of a skeleton (formats/city_json/model.h), so that
// its rings and vertices are packed like those:
//
//   {"lattice":[kind,step and origin as mantissa and exponent...],"srid":7415,
//    "boundaries":[shells],"vertices":{"count":8,"solids":[],"others":[x,y,z,x,...]}}
//
// Coordinates are those on the lattice, divided by the largest whole number that divides all of an
// axis; these three stand as "units":[1,1,1000] before the boundaries if one of them is not 1.
// Lines that were stored before this form are a list of numbers with single spaces between them:
// the kind of the lattice; mantissa and exponent of its three steps and its origin's three
// coordinates; the EPSG code; the vertices; the vertices of the rings; the sizes of rings, facets
// and shells. Each list begins with its length; integer coordinates are differences to the vertex
// before.
#include "pipeline/stored/unproven_solid.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace watertight::pipeline {
namespace {

void append_number(std::string& out, double number) {
  constexpr double kLargestInteger = 0x1p53;
  std::array<char, 40> digits{};
  char* const end = digits.data() + digits.size();
  const bool is_integer = std::abs(number) < kLargestInteger && number == std::floor(number);
  const auto rest = is_integer ? std::to_chars(digits.data(), end, number, std::chars_format::fixed)
                               : std::to_chars(digits.data(), end, number);
  out.append(digits.data(), rest.ptr);
}

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

using Steps = std::array<std::int64_t, 3>;

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

/// Reads the text of JSON from the front. After a failure all numbers are 0.
class JsonCursor {
 public:
  explicit JsonCursor(std::string_view text) : text_(text) {}

  void expect(std::string_view text) {
    if (!take(text)) has_failed_ = true;
  }
  /// Takes this text if it comes next.
  bool take(std::string_view text) {
    if (has_failed_ || !text_.starts_with(text)) return false;
    text_.remove_prefix(text.size());
    return true;
  }
  template <class Number>
  Number number() {
    Number number{};
    const auto [rest, error] = std::from_chars(text_.data(), text_.data() + text_.size(), number);
    if (has_failed_ || error != std::errc{}) {
      has_failed_ = true;
      return Number{};
    }
    text_.remove_prefix(static_cast<std::size_t>(rest - text_.data()));
    return number;
  }
  /// Reads a list, whose elements `read` reads.
  template <class Read>
  void list(Read read) {
    expect("[");
    if (take("]")) return;
    do read();
    while (!has_failed_ && take(","));
    expect("]");
  }
  bool is_done() const { return !has_failed_ && text_.empty(); }
  bool has_failed() const { return has_failed_; }

 private:
  std::string_view text_;
  bool has_failed_ = false;
};

/// Appends elements between brackets, with commas between them.
template <class Append>
void append_list(std::string& out, IndexRange range, Append append) {
  out += '[';
  for (Index i = range.begin; i < range.end; ++i) {
    if (i > range.begin) out += ',';
    append(i);
  }
  out += ']';
}

void append_boundaries(std::string& out, const Solid& solid) {
  append_list(out, {0, static_cast<Index>(solid.shell_count())}, [&](Index shell) {
    append_list(out, solid.facets_of(shell), [&](Index facet) {
      append_list(out, solid.rings_of(facet), [&](Index ring) {
        const std::span<const Index> vertices = solid.ring(ring);
        append_list(out, {0, static_cast<Index>(vertices.size())},
                    [&](Index i) { out += std::to_string(vertices[i]); });
      });
    });
  });
}

SolidArrays read_boundaries(JsonCursor& cursor) {
  SolidArrays arrays;
  arrays.ring_offsets = {0};
  arrays.facet_offsets = {0};
  arrays.shell_offsets = {0};
  const auto end = [](std::vector<Index>& offsets, std::size_t size) {
    offsets.push_back(static_cast<Index>(size));
  };
  cursor.list([&] {
    cursor.list([&] {
      cursor.list([&] {
        cursor.list([&] { arrays.ring_vertices.push_back(cursor.number<Index>()); });
        end(arrays.ring_offsets, arrays.ring_vertices.size());
      });
      end(arrays.facet_offsets, arrays.ring_offsets.size() - 1);
    });
    end(arrays.shell_offsets, arrays.facet_offsets.size() - 1);
  });
  return arrays;
}

/// For each axis the largest whole number that divides all coordinates; 1 if all are 0 or one is
/// no integer.
using Units = std::array<std::int64_t, 3>;
constexpr Units kNoUnits{1, 1, 1};
constexpr double kIntegersEnd = 0x1p53;

Units units_of(const Solid& solid) {
  Units units{};
  for (const Point& point : solid.vertices()) {
    for (int axis = 0; axis < 3; ++axis) {
      const double value = point[axis];
      const bool is_integer = std::abs(value) < kIntegersEnd && value == std::floor(value);
      std::int64_t& unit = units[static_cast<std::size_t>(axis)];
      if (!is_integer) return kNoUnits;
      unit = std::gcd(unit, static_cast<std::int64_t>(value));
    }
  }
  for (std::int64_t& unit : units) unit = std::max<std::int64_t>(unit, 1);
  return units;
}

Error malformed_line() {
  return Error{ErrorCode::malformed, "truncated or malformed numbers of an unproven solid"};
}

Result<geometry::LatticeKind> kind_of(int kind) {
  if (kind >= 0 && kind <= static_cast<int>(geometry::LatticeKind::float64)) {
    return static_cast<geometry::LatticeKind>(kind);
  }
  return Error{ErrorCode::malformed, "an unproven solid on an unknown lattice"};
}

Result<Solid> read_json(std::string_view line, const Limits& limits) {
  JsonCursor cursor(line);
  geometry::Lattice lattice;
  cursor.expect(R"({"lattice":[)");
  const auto kind = kind_of(cursor.number<int>());
  if (!kind) return kind.error();
  lattice.kind = *kind;
  for (auto* numbers : {&lattice.step, &lattice.origin}) {
    for (geometry::GridNumber& number : *numbers) {
      cursor.expect(",");
      number.mantissa = cursor.number<std::int64_t>();
      cursor.expect(",");
      number.exponent = cursor.number<std::int32_t>();
    }
  }
  cursor.expect(R"(],"srid":)");
  const auto srid = cursor.number<std::uint32_t>();
  Units units = kNoUnits;
  if (cursor.take(R"(,"units":[)")) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis > 0) cursor.expect(",");
      units[axis] = cursor.number<std::int64_t>();
    }
    cursor.expect("]");
  }
  cursor.expect(R"(,"boundaries":)");
  SolidArrays arrays = read_boundaries(cursor);
  cursor.expect(R"(,"vertices":{"count":)");
  const auto count = cursor.number<std::uint64_t>();
  cursor.expect(R"(,"solids":[],"others":)");
  std::vector<double> coordinates;
  cursor.list([&] { coordinates.push_back(cursor.number<double>()); });
  cursor.expect("}}");
  if (!cursor.is_done() || count > coordinates.size() || coordinates.size() != 3 * count) {
    return malformed_line();
  }
  arrays.vertices.reserve(count);
  for (std::size_t i = 0; i < coordinates.size(); i += 3) {
    arrays.vertices.push_back({coordinates[i] * static_cast<double>(units[0]),
                               coordinates[i + 1] * static_cast<double>(units[1]),
                               coordinates[i + 2] * static_cast<double>(units[2])});
  }
  return Solid::make(std::move(arrays), lattice, srid, limits);
}

}  // namespace

std::string write_unproven(const Solid& solid) {
  const Units units = units_of(solid);
  std::string out = R"({"lattice":[)";
  const geometry::Lattice& lattice = solid.lattice();
  out += std::to_string(static_cast<int>(lattice.kind));
  for (const auto& numbers : {lattice.step, lattice.origin}) {
    for (const geometry::GridNumber& number : numbers) {
      out.append(",").append(std::to_string(number.mantissa));
      out.append(",").append(std::to_string(number.exponent));
    }
  }
  out.append(R"(],"srid":)").append(std::to_string(solid.srid()));
  if (units != kNoUnits) {
    out += R"(,"units":)";
    append_list(out, {0, 3}, [&](Index axis) { out += std::to_string(units[axis]); });
  }
  out += R"(,"boundaries":)";
  append_boundaries(out, solid);
  out.append(R"(,"vertices":{"count":)").append(std::to_string(solid.vertex_count()));
  out += R"(,"solids":[],"others":)";
  const std::span<const Point> points = solid.vertices();
  append_list(out, {0, static_cast<Index>(3 * points.size())}, [&](Index i) {
    append_number(out, points[i / 3][static_cast<int>(i % 3)] / static_cast<double>(units[i % 3]));
  });
  return out + "}}";
}

Result<Solid> read_unproven(std::string_view line, const Limits& limits) {
  if (line.starts_with('{')) return read_json(line, limits);
  NumberReader reader(line);
  geometry::Lattice lattice;
  const auto kind = kind_of(reader.take<int>());
  if (!kind) return kind.error();
  lattice.kind = *kind;
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
  if (!reader.is_done()) return malformed_line();
  return Solid::make(std::move(arrays), lattice, srid, limits);
}

}  // namespace watertight::pipeline
