// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>

#include "base/quantity.h"
#include "formats/mesh/one_shell_text.h"

namespace watertight::formats {
namespace {

class OffReader : private OneShellText {
 public:
  OffReader(std::string_view text, const Limits& limits)
      : OneShellText(Format::off, text, limits) {}

  Result<Document> read() {
    if (auto status = head(); !status) return status.error();
    for (std::uint64_t i = 0; i < vertex_count_; ++i) {
      if (!lines_.next()) return lines_.ended("vertex " + std::to_string(i));
      if (auto status = append_vertex(lines_.line(), lines_.words(), vertices_); !status)
        return status.error();
    }
    for (std::uint64_t i = 0; i < facet_count_; ++i) {
      if (!lines_.next()) return lines_.ended("face " + std::to_string(i));
      if (auto status = facet(); !status) return status.error();
    }
    if (lines_.next()) document_.notes.push_back("text after the last face skipped");
    return finish("Mesh");
  }

 private:
  // Reads "OFF" with prefixes for texture, colour and normal, then the counts, on the same line or
  // the next.
  Status head() {
    if (!lines_.next()) return lines_.ended("its first word");
    const std::string_view word = lines_.words().front();
    if (word == "4OFF" || word == "nOFF" || word == "4nOFF") {
      return Error{
          ErrorCode::unsupported, "only OFF of three dimensions is read", lines_.line().offset, {}};
    }
    for (const std::string_view known :
         {"OFF", "COFF", "NOFF", "CNOFF", "NCOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"}) {
      if (word == known) return counts();
    }
    return error_at(lines_.line(), word, "the first word is not OFF");
  }

  Status counts() {
    std::size_t first = 1;  // index of the first count among the words of the line
    if (first < lines_.words().size() && lines_.words()[first] == "BINARY") {
      return Error{ErrorCode::unsupported, "binary OFF is not read", lines_.line().offset, {}};
    }
    if (first == lines_.words().size()) {
      if (!lines_.next()) return lines_.ended("the counts");
      first = 0;
    }
    const auto vertices = count(first, "vertices", limits_.vertices);
    if (!vertices) return vertices.error();
    const auto facets = count(first + 1, "faces", limits_.facets);
    if (!facets) return facets.error();
    vertex_count_ = *vertices;
    facet_count_ = *facets;
    return Done{};
  }

  // Reads a facet: the number of its vertices, then their indices. A colour may follow, which is
  // not read.
  Status facet() {
    const auto corners = unsigned_word(lines_.words()[0]);
    if (!corners || *corners > lines_.words().size() - 1) {
      return wrong(0, "the face has fewer vertices than it says");
    }
    for (std::uint64_t i = 1; i <= *corners; ++i) {
      const auto vertex = unsigned_word(lines_.words()[i]);
      if (!vertex || *vertex >= vertex_count_) {
        return wrong(i, "vertex index is out of range (" +
                            quantity(vertex_count_, "vertex", "vertices") + ')');
      }
      arrays_.ring_vertices.push_back(static_cast<Index>(*vertex));
    }
    arrays_.end_ring();
    arrays_.end_facet();
    return Done{};
  }

  std::uint64_t vertex_count_ = 0;
  std::uint64_t facet_count_ = 0;
};

}  // namespace

Result<Document> read_off(std::string_view text, const Limits& limits) {
  return OffReader(text, limits).read();
}

Result<std::string> write_off(std::span<const Feature> features) {
  const Solid* solid = nullptr;
  for (const Feature& feature : features) {
    for (const SubmittedSolid& submitted : feature.solids) {
      if (solid != nullptr) {
        return Error{ErrorCode::unsupported,
                     "an OFF file holds one solid, the document has several"};
      }
      solid = &submitted.solid;
    }
  }
  if (solid == nullptr) return Error{ErrorCode::unsupported, "there is no solid to write as off"};
  if (solid->shell_count() > 1) {
    return Error{ErrorCode::unsupported, "OFF has no cavities: the solid has inner shells"};
  }
  std::string out = "OFF\n" + std::to_string(solid->vertex_count()) + ' ' +
                    std::to_string(solid->facet_count()) + " 0\n";
  for (const Point& p : solid->vertices()) {
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) out += ' ';
      out += solid->lattice().world_text(p[axis], axis);
    }
    out += '\n';
  }
  for (Index facet = 0; facet < solid->facet_count(); ++facet) {
    const IndexRange rings = solid->rings_of(facet);
    if (rings.size() != 1) {
      return Error{ErrorCode::unsupported, "OFF has no facets with holes: facet " +
                                               std::to_string(facet) + " has " +
                                               std::to_string(rings.size()) + " rings"};
    }
    const auto ring = solid->ring(rings.begin);
    out += std::to_string(ring.size());
    for (const Index vertex : ring) out += ' ' + std::to_string(vertex);
    out += '\n';
  }
  return out;
}

}  // namespace watertight::formats
