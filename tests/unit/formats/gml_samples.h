// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small GML documents for the tests of the GML reader.
#pragma once

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/document.h"
#include "samples.h"

namespace watertight::test {

inline Result<Document> read_gml_text(const std::string& text) { return read(text, Format::gml); }

inline Document gml_of(const std::string& text) {
  auto document = read_gml_text(text);
  if (!document) FAIL(to_string(document.error()));
  return std::move(*document);
}

inline Error gml_error(const std::string& text) {
  const auto document = read_gml_text(text);
  REQUIRE_FALSE(document);
  CHECK(document.error().byte_offset.has_value());
  CHECK(document.error().message.starts_with("line "));
  return document.error();
}

/// Why the first solid that could not be read could not be; the document itself is read.
inline std::string unreadable(const std::string& text) {
  const Document document = gml_of(text);
  std::vector<const SubmittedSolid*> solids;
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& solid : feature.solids) solids.push_back(&solid);
  }
  for (const SubmittedSolid* solid : solids) {
    if (solid->unreadable.empty()) continue;
    CHECK(solid->unreadable.starts_with("line "));
    CHECK(solid->source.line > 0);
    CHECK(solid->solid.shell_count() == 0);
    return solid->unreadable;
  }
  return "";
}

inline bool says(std::string_view text, std::string_view words) {
  return text.find(words) != std::string_view::npos;
}

inline bool says(const Error& error, std::string_view words) {
  return error.message.find(words) != std::string::npos;
}

/// `content` in an element with the namespaces g (GML 3.2) and x (XLink).
inline std::string model(const std::string& content) {
  return R"(<CityModel xmlns:g="http://www.opengis.net/gml/3.2" )"
         R"(xmlns:x="http://www.w3.org/1999/xlink">)" +
         content + "</CityModel>";
}

/// A building with one solid.
inline std::string building(const std::string& solid, const std::string& id = "b") {
  return "<cityObjectMember><Building g:id=\"" + id + "\"><lod2Solid>" + solid +
         "</lod2Solid></Building></cityObjectMember>";
}

inline std::string polygon(const std::string& positions, const std::string& attributes = "") {
  return "<g:Polygon" + attributes + "><g:exterior><g:LinearRing><g:posList>" + positions +
         "</g:posList></g:LinearRing></g:exterior></g:Polygon>";
}

inline std::string member(const std::string& surface) {
  std::string text = "<g:surfaceMember>";
  return text.append(surface).append("</g:surfaceMember>");
}

inline std::string member_of(const std::string& id) {
  std::string text = "<g:surfaceMember x:href=\"#";
  return text.append(id).append("\"/>");
}

inline std::string solid_of(const std::string& members, const std::string& attributes = "") {
  return "<g:Solid" + attributes + "><g:exterior><g:Shell>" + members +
         "</g:Shell></g:exterior></g:Solid>";
}

inline const std::string kBase = polygon("0 0 0 0 1 0 1 0 0 0 0 0");
inline const std::string kSides = member(polygon("0 0 0 1 0 0 0 0 1 0 0 0")) +
                                  member(polygon("1 0 0 0 1 0 0 0 1 1 0 0")) +
                                  member(polygon("0 1 0 0 0 0 0 0 1 0 1 0"));
inline const std::string kTetrahedron = solid_of(member(kBase) + kSides);

/// True if every edge is used once in each direction.
inline bool is_closed(const Solid& solid) {
  std::vector<std::pair<Index, Index>> edges;
  for (Index ring = 0; ring < solid.ring_count(); ++ring) {
    const auto vertices = solid.ring(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      edges.emplace_back(vertices[i], vertices[(i + 1) % vertices.size()]);
    }
  }
  std::vector<std::pair<Index, Index>> twins;
  for (const auto& [a, b] : edges) twins.emplace_back(b, a);
  std::sort(edges.begin(), edges.end());
  std::sort(twins.begin(), twins.end());
  return edges == twins && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

}  // namespace watertight::test
