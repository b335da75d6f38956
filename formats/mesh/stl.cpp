// SPDX-License-Identifier: GPL-3.0-or-later
//
// STL as text and as binary. A triangle is three corners with coordinates; corners with exactly
// equal coordinates are one vertex. Normals and attribute bytes are not used. A binary coordinate
// is a 32-bit float and stands for the shortest decimal that reads back as that float, which is
// the number that its writer most likely had; the number in a text counts as written.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <optional>
#include <utility>

#include "base/ascii.h"
#include "base/quantity.h"
#include "formats/mesh/mesh_text.h"
#include "formats/surface.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

constexpr std::size_t kHeader = 84;  // bytes of the header: 80 of text and the number of triangles
constexpr std::size_t kTriangle = 50;
constexpr std::size_t kNormal = 12;

std::uint32_t word_at(ByteView bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8U |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16U |
         static_cast<std::uint32_t>(bytes[at + 3]) << 24U;
}

// Replaces each ring vertex by the first vertex with an equal key. Sorting, unlike hashing, cannot
// be slowed down by chosen coordinates.
template <class Key>
void weld(const std::vector<Key>& keys, SolidArrays& arrays) {
  struct Corner {
    Key key;
    Index number;
  };
  std::vector<Corner> corners;
  corners.reserve(keys.size());
  for (Index i = 0; i < keys.size(); ++i) corners.push_back({keys[i], i});
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    const auto order = a.key <=> b.key;
    return order != 0 ? order < 0 : a.number < b.number;
  });
  std::vector<Index> first(keys.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const bool is_same = i > 0 && corners[i].key == corners[i - 1].key;
    first[corners[i].number] = is_same ? first[corners[i - 1].number] : corners[i].number;
  }
  for (Index& vertex : arrays.ring_vertices) vertex = first[vertex];
}

void note_welding(Document& document) {
  document.notes.push_back(
      "corners with exactly equal coordinates read as one vertex; normals and attributes ignored");
}

// The bits of three floats; -0 becomes 0.
using FloatKey = std::array<std::uint32_t, 3>;

Result<Document> read_binary_stl(ByteView bytes, const Limits& limits) {
  const std::size_t count = (bytes.size() - kHeader) / kTriangle;
  if (count > limits.facets || count > (kNone - 1) / 3) {
    return Error{
        ErrorCode::limit_exceeded,
        std::to_string(count) + " triangles; the limit is " + std::to_string(limits.facets), 80};
  }
  std::vector<FloatKey> keys;
  keys.reserve(count * 3);
  SolidArrays arrays;
  for (std::size_t triangle = 0; triangle < count; ++triangle) {
    std::size_t at = kHeader + triangle * kTriangle + kNormal;
    for (int corner = 0; corner < 3; ++corner) {
      FloatKey key{};
      for (std::uint32_t& word : key) {
        word = word_at(bytes, at);
        if (!std::isfinite(std::bit_cast<float>(word))) {
          return Error{ErrorCode::malformed,
                       "triangle " + std::to_string(triangle) + ": a coordinate is not finite", at};
        }
        if (word == 0x80000000U) word = 0;
        at += 4;
      }
      arrays.ring_vertices.push_back(static_cast<Index>(keys.size()));
      keys.push_back(key);
    }
    arrays.end_ring();
    arrays.end_facet();
  }
  arrays.end_shell();
  weld(keys, arrays);

  DecimalVertices vertices;
  std::vector<Index> number_of(keys.size(), kNone);
  const std::vector<Index> used = number_by_first_use(arrays, number_of);
  vertices.positions.reserve(used.size());
  for (const Index corner : used) {
    std::array<GridNumber, 3> position;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis] = geometry::shortest_decimal(std::bit_cast<float>(keys[corner][axis]));
    }
    vertices.positions.push_back(position);
  }
  vertices.is_rounded.resize(used.size());
  auto solid =
      indexed_solid(std::move(arrays), vertices, SolidSource{"", "Mesh", "", 0, 0, ""}, limits);
  if (!solid) return std::move(solid).error();
  Document document;
  document.format = Format::stl;
  note_welding(document);
  if (count == 0) document.notes.push_back("the file has no triangles");
  document.features.emplace_back();
  document.features.back().solids.push_back(std::move(*solid));
  return document;
}

bool is_keyword(std::string_view word, std::string_view keyword) {
  return word.size() == keyword.size() &&
         std::equal(word.begin(), word.end(), keyword.begin(),
                    [](char a, char b) { return lower_case(a) == b; });
}

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// Reads the text form of STL:
// solid NAME { facet normal X Y Z outer loop { vertex X Y Z } endloop endfacet } endsolid NAME
class TextStlReader {
 public:
  TextStlReader(std::string_view text, const Limits& limits) : text_(text), limits_(limits) {}

  Result<Document> read() {
    document_.format = Format::stl;
    note_welding(document_);
    while (true) {
      const std::string_view word = next_word();
      if (word.empty()) break;
      if (!is_keyword(word, "solid")) return wrong(word, "solid");
      if (auto status = solid(); !status) return status.error();
    }
    if (document_.features.empty()) {
      // The document gets one empty solid, so that there is a feature to report about.
      document_.notes.push_back("the file has no triangles");
      if (auto status = add_feature({}); !status) return status.error();
    } else if (left_out_ > 0) {
      document_.notes.push_back(quantity(left_out_, "solid") + " without triangles left out");
    }
    return std::move(document_);
  }

 private:
  // The next word; "" at the end of the text.
  std::string_view next_word() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  Error error(std::string_view word, std::string message) const {
    const std::size_t offset =
        word.empty() ? text_.size() : static_cast<std::size_t>(word.data() - text_.data());
    const auto lines =
        std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
    return Error{ErrorCode::malformed,
                 "line " + std::to_string(lines + 1) + ": " + std::move(message), offset};
  }

  Error wrong(std::string_view word, const std::string& expected) const {
    if (word.empty()) return error(word, "the file ends where '" + expected + "' should follow");
    return error(word, "'" + expected + "' should stand here");
  }

  Status expect(const std::string& keyword) {
    const std::string_view word = next_word();
    if (!is_keyword(word, keyword)) return wrong(word, keyword);
    return Done{};
  }

  // Takes the rest of the line as a name.
  std::string name() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view rest = text_.substr(at_, end - at_);
    at_ = end;
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    return std::string(rest);
  }

  Status solid() {
    std::string id = name();
    while (true) {
      const std::string_view word = next_word();
      if (is_keyword(word, "endsolid")) break;
      if (!is_keyword(word, "facet")) return wrong(word, "facet' or 'endsolid");
      if (auto status = facet(); !status) return status;
    }
    name();
    if (arrays_.ring_vertices.empty()) {
      ++left_out_;
      return Done{};
    }
    return add_feature(std::move(id));
  }

  Status facet() {
    if (auto status = expect("normal"); !status) return status;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = next_word();
      if (word.empty() || is_keyword(word, "outer"))
        return error(word, "a normal of three numbers");
    }
    for (const char* keyword : {"outer", "loop"}) {
      if (auto status = expect(keyword); !status) return status;
    }
    while (true) {
      const std::string_view word = next_word();
      if (is_keyword(word, "endloop")) break;
      if (!is_keyword(word, "vertex")) return wrong(word, "vertex' or 'endloop");
      if (auto status = vertex(); !status) return status;
    }
    arrays_.end_ring();
    arrays_.end_facet();
    if (arrays_.facet_offsets.size() - 1 > limits_.facets) {
      return Error{
          ErrorCode::limit_exceeded,
          "more triangles in one solid than the limit of " + std::to_string(limits_.facets), at_};
    }
    return expect("endfacet");
  }

  Status vertex() {
    std::array<GridNumber, 3> position;
    bool is_rounded = false;
    for (GridNumber& coordinate : position) {
      const std::string_view word = next_word();
      auto exact = exact_number(word);
      if (!exact) return error(word, exact.error().message);
      coordinate = exact->value;
      is_rounded = is_rounded || exact->is_rounded;
    }
    if (vertices_.positions.size() >= kNone - 1) {
      return Error{ErrorCode::limit_exceeded, "more corners than a 32-bit index can name", at_};
    }
    arrays_.ring_vertices.push_back(static_cast<Index>(vertices_.positions.size()));
    vertices_.positions.push_back(position);
    vertices_.is_rounded.push_back(is_rounded);
    return Done{};
  }

  Status add_feature(std::string id) {
    SolidArrays arrays = std::exchange(arrays_, SolidArrays{});
    DecimalVertices vertices = std::exchange(vertices_, DecimalVertices{});
    arrays.end_shell();
    weld(vertices.positions, arrays);
    auto solid =
        indexed_solid(std::move(arrays), vertices, SolidSource{id, "Mesh", "", 0, 0, ""}, limits_);
    if (!solid) return std::move(solid).error();
    Feature feature;
    feature.id = std::move(id);
    feature.solids.push_back(std::move(*solid));
    document_.features.push_back(std::move(feature));
    return Done{};
  }

  std::string_view text_;
  const Limits& limits_;
  std::size_t at_ = 0;
  std::size_t left_out_ = 0;
  SolidArrays arrays_;        // the facets of the open solid
  DecimalVertices vertices_;  // one vertex for each corner
  Document document_;
};

// Whether the bytes are a text that starts with "solid". Binary files may start so too, but no text
// has NUL bytes.
bool is_text_stl(ByteView bytes) {
  std::string_view text = as_text(bytes);
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text.size() >= 5 && is_keyword(text.substr(0, 5), "solid") &&
         text.substr(0, 512).find('\0') == std::string_view::npos;
}

}  // namespace

bool is_binary_stl(ByteView bytes) {
  return bytes.size() >= kHeader &&
         bytes.size() == kHeader + kTriangle * std::uint64_t{word_at(bytes, 80)};
}

std::vector<RingText> binary_stl_rings(ByteView bytes) {
  std::vector<RingText> rings((bytes.size() - kHeader) / kTriangle);
  for (std::size_t triangle = 0; triangle < rings.size(); ++triangle) {
    rings[triangle].at = kHeader + triangle * kTriangle + kNormal;
    rings[triangle].size = kTriangle - kNormal - 2;
    rings[triangle].ring = static_cast<Index>(triangle);
    rings[triangle].is_binary = true;
  }
  return rings;
}

Result<Document> read_stl(ByteView bytes, const Limits& limits) {
  if (is_binary_stl(bytes)) return read_binary_stl(bytes, limits);
  if (is_text_stl(bytes)) return TextStlReader(as_text(bytes), limits).read();
  if (bytes.size() < kHeader) {
    return Error{ErrorCode::malformed,
                 "neither a text that starts with 'solid' nor long enough for a binary STL",
                 bytes.size()};
  }
  const std::uint64_t count = word_at(bytes, 80);
  return Error{ErrorCode::malformed,
               "a binary STL of " + quantity(count, "triangle") + " has " +
                   std::to_string(kHeader + kTriangle * count) + " bytes, this file has " +
                   std::to_string(bytes.size()),
               std::min<std::uint64_t>(bytes.size(), kHeader + kTriangle * count)};
}

}  // namespace watertight::formats
