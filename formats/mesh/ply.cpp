// SPDX-License-Identifier: GPL-3.0-or-later
//
// PLY as text and as binary of both byte orders. The elements "vertex" (x, y, z) and "face"
// (vertex_indices or vertex_index) are read, everything else is skipped. A binary float or double
// stands for the shortest decimal that reads back as the same value; numbers in text count as
// written.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/quantity.h"
#include "formats/mesh/mesh_text.h"
#include "formats/mesh/ply_header.h"
#include "formats/surface.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

/// The values of a text, one word each.
class TextValues {
 public:
  TextValues(ByteView bytes, std::size_t begin) : text_(as_text(bytes)), at_(begin) {}

  std::size_t position() const { return at_; }
  bool is_at_end() {
    skip_blanks();
    return at_ == text_.size();
  }
  /// The largest number of values that can still follow.
  std::uint64_t most_left(PlyType) const { return (text_.size() - at_ + 1) / 2; }

  bool skip(PlyType) { return !next_word().empty(); }
  bool skip(PlyType type, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (!skip(type)) return false;
    }
    return true;
  }

  Result<std::int64_t> integer(PlyType) {
    const std::string_view word = next_word();
    std::int64_t value = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || status != std::errc() || end != word.data() + word.size()) {
      return wrong(word, "not an integer");
    }
    return value;
  }

  Result<ExactNumber> number(PlyType) {
    const std::string_view word = next_word();
    auto exact = exact_number(word);
    if (!exact) return wrong(word, exact.error().message);
    return exact;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }
  std::string_view next_word() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  Error wrong(std::string_view word, std::string message) const {
    if (word.empty()) return {ErrorCode::malformed, "the file ends within its data", text_.size()};
    return {ErrorCode::malformed, std::move(message),
            static_cast<std::size_t>(word.data() - text_.data())};
  }

  std::string_view text_;
  std::size_t at_;
};

/// The values of a binary file.
class BinaryValues {
 public:
  BinaryValues(ByteView bytes, std::size_t begin, bool is_big_endian)
      : bytes_(bytes), at_(begin), is_big_endian_(is_big_endian) {}

  std::size_t position() const { return at_; }
  bool is_at_end() const { return at_ == bytes_.size(); }
  std::uint64_t most_left(PlyType type) const { return (bytes_.size() - at_) / size_of(type); }

  bool skip(PlyType type) { return skip(type, 1); }
  bool skip(PlyType type, std::uint64_t count) {
    if (count > most_left(type)) return false;
    at_ += static_cast<std::size_t>(count) * size_of(type);
    return true;
  }

  Result<std::int64_t> integer(PlyType type) {
    const auto bits = next(type);
    if (!bits) return ended();
    switch (type) {
      case PlyType::int8:
        return std::int64_t{static_cast<std::int8_t>(*bits)};
      case PlyType::int16:
        return std::int64_t{static_cast<std::int16_t>(*bits)};
      case PlyType::int32:
        return std::int64_t{static_cast<std::int32_t>(*bits)};
      default:
        return static_cast<std::int64_t>(*bits);
    }
  }

  Result<ExactNumber> number(PlyType type) {
    if (is_integer(type)) {
      const auto value = integer(type);
      if (!value) return value.error();
      return exact_number(std::to_string(*value));
    }
    const auto bits = next(type);
    if (!bits) return ended();
    const std::size_t offset = at_ - size_of(type);
    if (type == PlyType::float32) {
      const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(*bits));
      if (!std::isfinite(value)) return not_finite(offset);
      return ExactNumber{geometry::shortest_decimal(value), false};
    }
    const auto value = std::bit_cast<double>(*bits);
    if (!std::isfinite(value)) return not_finite(offset);
    return ExactNumber{geometry::shortest_decimal(value), false};
  }

 private:
  std::optional<std::uint64_t> next(PlyType type) {
    const std::size_t size = size_of(type);
    if (bytes_.size() - at_ < size) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = is_big_endian_ ? size - 1 - i : i;
      bits |= static_cast<std::uint64_t>(bytes_[at_ + i]) << (8 * place);
    }
    at_ += size;
    return bits;
  }
  Error ended() const {
    return {ErrorCode::malformed, "the file ends within its data", bytes_.size()};
  }
  static Error not_finite(std::size_t offset) {
    return {ErrorCode::malformed, "a coordinate is not finite", offset};
  }

  ByteView bytes_;
  std::size_t at_;
  bool is_big_endian_;
};

template <class Values>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, Values values, const Limits& limits)
      : header_(header),
        values_(std::move(values)),
        limits_(limits),
        vertex_count_(count_vertices()) {}

  Result<Document> read() {
    for (const PlyElement& element : header_.elements) {
      if (auto status = check_count(element); !status) return status.error();
      Status status = Done{};
      if (element.name == "vertex") {
        status = vertices(element);
      } else if (element.name == "face") {
        status = faces(element);
      } else if (element.name == "tristrips") {
        status = Error{ErrorCode::unsupported, "triangle strips are not read", values_.position()};
      } else {
        status = others(element);
      }
      if (!status) return status.error();
    }
    if (!values_.is_at_end()) document_.notes.push_back("data after the last element skipped");
    return finish();
  }

 private:
  static Error in_element(Error error, const PlyElement& element, std::uint64_t number) {
    error.message = element.name + ' ' + std::to_string(number) + ": " + error.message;
    return error;
  }

  Error ended() const {
    return {ErrorCode::malformed, "the file ends within its data", values_.position()};
  }

  // Every element takes at least the bytes of its first property, unless it has none.
  Status check_count(const PlyElement& element) const {
    if (element.properties.empty()) return Done{};
    const PlyProperty& first = element.properties.front();
    if (element.count > values_.most_left(first.list_length.value_or(first.type))) {
      return Error{ErrorCode::malformed,
                   "more elements '" + element.name + "' (" + std::to_string(element.count) +
                       ") than the rest of the file can hold",
                   values_.position()};
    }
    return Done{};
  }

  Result<std::uint64_t> list_length(const PlyProperty& property) {
    const std::size_t offset = values_.position();
    const auto length = values_.integer(*property.list_length);
    if (!length) return length.error();
    if (*length < 0) return Error{ErrorCode::malformed, "a list of negative length", offset};
    if (static_cast<std::uint64_t>(*length) > values_.most_left(property.type)) {
      return Error{ErrorCode::malformed,
                   "a list of " + std::to_string(*length) +
                       " items, more than the rest of the file can hold",
                   offset};
    }
    return static_cast<std::uint64_t>(*length);
  }

  Status skip(const PlyProperty& property) {
    if (!property.list_length) {
      if (!values_.skip(property.type)) return ended();
      return Done{};
    }
    const auto length = list_length(property);
    if (!length) return length.error();
    if (!values_.skip(property.type, *length)) return ended();
    return Done{};
  }

  Status others(const PlyElement& element) {
    if (element.properties.empty()) return Done{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        if (auto status = skip(property); !status) return in_element(status.error(), element, i);
      }
    }
    return Done{};
  }

  Status vertices(const PlyElement& element) {
    if (element.count > limits_.vertices) return beyond(element, limits_.vertices);
    std::array<std::size_t, 3> place_of{};
    constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto place = element.property(kAxes[axis]);
      if (!place || element.properties[*place].list_length) {
        return Error{ErrorCode::malformed,
                     "the element 'vertex' has no property " + std::string(kAxes[axis]),
                     element.offset};
      }
      place_of[axis] = *place;
    }
    vertices_.positions.reserve(element.count);
    vertices_.is_rounded.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (auto status = vertex(element, place_of); !status) {
        return in_element(status.error(), element, i);
      }
    }
    return Done{};
  }

  Status vertex(const PlyElement& element, const std::array<std::size_t, 3>& place_of) {
    std::array<GridNumber, 3> position;
    bool is_rounded = false;
    for (std::size_t place = 0; place < element.properties.size(); ++place) {
      const PlyProperty& property = element.properties[place];
      const auto axis = static_cast<std::size_t>(
          std::find(place_of.begin(), place_of.end(), place) - place_of.begin());
      if (axis == 3) {
        if (auto status = skip(property); !status) return status;
        continue;
      }
      auto exact = values_.number(property.type);
      if (!exact) return std::move(exact).error();
      position[axis] = exact->value;
      is_rounded = is_rounded || exact->is_rounded;
    }
    vertices_.positions.push_back(position);
    vertices_.is_rounded.push_back(is_rounded);
    return Done{};
  }

  Error beyond(const PlyElement& element, std::uint64_t limit) const {
    return Error{ErrorCode::limit_exceeded,
                 std::to_string(element.count) + " elements '" + element.name + "'; the limit is " +
                     std::to_string(limit),
                 values_.position()};
  }

  Status faces(const PlyElement& element) {
    if (element.count > limits_.facets) return beyond(element, limits_.facets);
    auto corners = element.property("vertex_indices");
    if (!corners) corners = element.property("vertex_index");
    if (!corners || !element.properties[*corners].list_length ||
        !is_integer(element.properties[*corners].type)) {
      return Error{ErrorCode::malformed,
                   "the element 'face' has no list of integers vertex_indices", element.offset};
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t place = 0; place < element.properties.size(); ++place) {
        const PlyProperty& property = element.properties[place];
        auto status = place == *corners ? face(property) : skip(property);
        if (!status) return in_element(status.error(), element, i);
      }
      arrays_.end_ring();
      arrays_.end_facet();
    }
    return Done{};
  }

  // Reads the ring of a face. The vertices may come after the faces, but their number is known.
  Status face(const PlyProperty& property) {
    const auto length = list_length(property);
    if (!length) return length.error();
    for (std::uint64_t i = 0; i < *length; ++i) {
      const std::size_t offset = values_.position();
      const auto index = values_.integer(property.type);
      if (!index) return index.error();
      if (*index < 0 || static_cast<std::uint64_t>(*index) >= vertex_count_) {
        return Error{ErrorCode::malformed,
                     "vertex index " + std::to_string(*index) + " is out of range (" +
                         quantity(vertex_count_, "vertex", "vertices") + ')',
                     offset};
      }
      arrays_.ring_vertices.push_back(static_cast<Index>(*index));
    }
    return Done{};
  }

  // The number of vertices, at most the limit; more vertices are refused when they are read.
  std::uint64_t count_vertices() const {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") return std::min<std::uint64_t>(element.count, limits_.vertices);
    }
    return 0;
  }

  Result<Document> finish() {
    document_.format = Format::ply;
    return one_shell_document(std::move(document_), "Mesh", std::move(arrays_), vertices_, limits_);
  }

  const PlyHeader& header_;
  Values values_;
  const Limits& limits_;
  std::uint64_t vertex_count_;
  DecimalVertices vertices_;
  SolidArrays arrays_;
  Document document_;
};

}  // namespace

Result<Document> read_ply(ByteView bytes, const Limits& limits) {
  const auto header = read_ply_header(bytes);
  if (!header) return header.error();
  if (header->encoding == PlyEncoding::text) {
    return PlyReader(*header, TextValues(bytes, header->data_begin), limits).read();
  }
  const bool is_big_endian = header->encoding == PlyEncoding::big_endian;
  return PlyReader(*header, BinaryValues(bytes, header->data_begin, is_big_endian), limits).read();
}

}  // namespace watertight::formats
