// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mesh/mesh_places.h"

#include <algorithm>
#include <span>

#include "formats/mesh/mesh_text.h"
#include "formats/mesh/ply_header.h"

namespace watertight::formats {
namespace {

using Words = std::span<const std::string_view>;

class PlaceFinder {
 public:
  PlaceFinder(std::string_view text, std::uint64_t first_number) : text_(text) {
    found_.first_number = first_number;
  }

  void vertex(std::string_view first, std::string_view last) {
    const std::uint64_t at = place_of(first);
    found_.places.push_back({IndexedPlace::Kind::vertex, at, place_of(last) + last.size() - at});
  }
  void corner(std::string_view digits) {
    found_.places.push_back({IndexedPlace::Kind::corner, place_of(digits), digits.size()});
  }
  IndexedPlaces found() && { return std::move(found_); }

 private:
  std::uint64_t place_of(std::string_view word) const {
    return static_cast<std::uint64_t>(word.data() - text_.data());
  }

  std::string_view text_;
  IndexedPlaces found_;
};

std::optional<IndexedPlaces> obj_places(std::string_view text) {
  const bool has_joined_lines =
      text.find("\\\n") != std::string_view::npos || text.find("\\\r") != std::string_view::npos;
  if (has_joined_lines) return std::nullopt;
  PlaceFinder finder(text, 1);
  for (TextLines lines(text); lines.next();) {
    const Words words = lines.words();
    if (words[0] == "v" && words.size() > 3) finder.vertex(words[1], words[3]);
    if (words[0] != "f") continue;
    for (const std::string_view word : words.subspan(1)) {
      finder.corner(word.substr(0, word.find('/')));
    }
  }
  return std::move(finder).found();
}

/// The facets of OFF, and those of PLY whose first property is the list: a count, then as many
/// numbers. False at the end of the text or at something else.
bool add_facets(TextLines& lines, std::uint64_t count, PlaceFinder& finder) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!lines.next()) return false;
    const auto corners = unsigned_word(lines.words()[0]);
    if (!corners || *corners >= lines.words().size()) return false;
    for (const std::string_view word : lines.words().subspan(1, *corners)) finder.corner(word);
  }
  return true;
}

bool add_vertices(TextLines& lines, std::uint64_t count, PlaceFinder& finder) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!lines.next() || lines.words().size() < 3) return false;
    finder.vertex(lines.words()[0], lines.words()[2]);
  }
  return true;
}

std::optional<IndexedPlaces> off_places(std::string_view text) {
  TextLines lines(text);
  if (!lines.next()) return std::nullopt;
  Words counts = lines.words().subspan(1);
  if (counts.empty()) {
    if (!lines.next()) return std::nullopt;
    counts = lines.words();
  }
  if (counts.size() < 2) return std::nullopt;
  const auto vertices = unsigned_word(counts[0]);
  const auto facets = unsigned_word(counts[1]);
  if (!vertices || !facets) return std::nullopt;
  PlaceFinder finder(text, 0);
  const bool is_whole =
      add_vertices(lines, *vertices, finder) && add_facets(lines, *facets, finder);
  return is_whole ? std::optional(std::move(finder).found()) : std::nullopt;
}

bool has_position_first(const PlyElement& element) {
  const auto& properties = element.properties;
  return properties.size() > 2 && properties[0].name == "x" && properties[1].name == "y" &&
         properties[2].name == "z";
}

bool has_corners_first(const PlyElement& element) {
  return !element.properties.empty() && element.properties[0].list_length.has_value() &&
         element.properties[0].name.starts_with("vertex_ind");
}

/// The bytes of an element without lists.
std::uint64_t size_of(const PlyElement& element) {
  std::uint64_t size = 0;
  for (const PlyProperty& property : element.properties) size += size_of(property.type);
  return size;
}

/// Binary elements, whose faces are their corners alone.
std::optional<IndexedPlaces> binary_places(ByteView bytes, const PlyHeader& header) {
  constexpr std::uint64_t kPosition = 12;
  constexpr std::uint64_t kCorner = 4;
  const PlyElement& vertices = header.elements[0];
  const PlyElement& faces = header.elements[1];
  const auto is_float = [](const PlyProperty& p) { return p.type == PlyType::float32; };
  const auto is_list = [](const PlyProperty& p) { return p.list_length.has_value(); };
  const bool is_usual =
      std::all_of(vertices.properties.begin(), vertices.properties.begin() + 3, is_float) &&
      std::ranges::none_of(vertices.properties, is_list) && faces.properties.size() == 1 &&
      size_of(faces.properties[0].type) == kCorner &&
      *faces.properties[0].list_length == PlyType::uint8;
  if (!is_usual) return std::nullopt;
  IndexedPlaces found;
  found.is_binary = true;
  std::uint64_t at = header.data_begin;
  for (std::uint64_t i = 0; i < vertices.count && at < bytes.size(); ++i) {
    found.places.push_back({IndexedPlace::Kind::vertex, at, kPosition});
    at += size_of(vertices);
  }
  for (std::uint64_t i = 0; i < faces.count; ++i) {
    if (at >= bytes.size()) return std::nullopt;
    const std::uint64_t corners = bytes[at++];
    for (std::uint64_t j = 0; j < corners; ++j, at += kCorner)
      found.places.push_back({IndexedPlace::Kind::corner, at, kCorner});
  }
  return at <= bytes.size() ? std::optional(std::move(found)) : std::nullopt;
}

/// Of the usual kind: vertices with their position first, then faces with their corners first.
std::optional<IndexedPlaces> ply_places(ByteView bytes) {
  const auto header = read_ply_header(bytes);
  if (!header || header->encoding == PlyEncoding::big_endian || header->elements.size() < 2) {
    return std::nullopt;
  }
  const PlyElement& vertices = header->elements[0];
  const PlyElement& faces = header->elements[1];
  const bool is_usual = vertices.name == "vertex" && has_position_first(vertices) &&
                        faces.name == "face" && has_corners_first(faces);
  if (!is_usual) return std::nullopt;
  if (header->encoding == PlyEncoding::little_endian) return binary_places(bytes, *header);
  const std::string_view text = as_text(bytes);
  TextLines lines(text.substr(header->data_begin));
  PlaceFinder finder(text, 0);
  const bool is_whole =
      add_vertices(lines, vertices.count, finder) && add_facets(lines, faces.count, finder);
  return is_whole ? std::optional(std::move(finder).found()) : std::nullopt;
}

}  // namespace

std::optional<IndexedPlaces> indexed_places(ByteView bytes, Format format) {
  switch (format) {
    case Format::obj:
      return obj_places(as_text(bytes));
    case Format::off:
      return off_places(as_text(bytes));
    case Format::ply:
      return ply_places(bytes);
    default:
      return std::nullopt;
  }
}

}  // namespace watertight::formats
