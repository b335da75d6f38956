// SPDX-License-Identifier: GPL-3.0-or-later
//
// POLY, the input of TetGen: nodes, then facets of polygons and hole points, then hole and region
// points of the volume. As in the validator val3dity, the first polygon of a facet is its exterior
// ring and the others are interior rings; TetGen itself would take them for segments and needs a
// point in each hole.
#include <cstdint>

#include "base/quantity.h"
#include "formats/mesh/one_shell_text.h"

namespace watertight::formats {
namespace {

class PolyReader : private OneShellText {
 public:
  PolyReader(std::string_view text, const Limits& limits)
      : OneShellText(Format::poly, text, limits) {}

  Result<Document> read() {
    if (auto status = nodes(); !status) return status.error();
    if (auto status = facets(); !status) return status.error();
    if (auto status = points("hole"); !status) return status.error();
    if (auto status = points("region"); !status) return status.error();
    if (lines_.next()) document_.notes.push_back("text after the last section skipped");
    return finish("Polyhedron");
  }

 private:
  // Reads "COUNT 3 ATTRIBUTES MARKERS", then "NUMBER X Y Z ..." for each node.
  Status nodes() {
    if (!lines_.next()) return lines_.ended("the number of nodes");
    const auto node_count = count(0, "nodes", limits_.vertices);
    if (!node_count) return node_count.error();
    if (lines_.words().size() > 1 && lines_.words()[1] != "3") {
      return wrong(1, "the nodes must have three dimensions");
    }
    if (*node_count == 0) {
      return Error{ErrorCode::unsupported,
                   "the nodes are in a separate .node file, which is not read",
                   lines_.line().offset};
    }
    for (std::uint64_t i = 0; i < *node_count; ++i) {
      if (!lines_.next()) return lines_.ended("node " + std::to_string(i));
      const auto number = unsigned_word(lines_.words()[0]);
      if (i == 0 && number && *number <= 1) first_node_ = *number;
      if (!number || *number != first_node_ + i) {
        return wrong(0, "nodes must be numbered 0, 1, 2, ... or 1, 2, 3, ...");
      }
      auto status = append_vertex(lines_.line(), lines_.words().subspan(1), vertices_);
      if (!status) return status;
    }
    return Done{};
  }

  Status facets() {
    if (!lines_.next()) return lines_.ended("the number of facets");
    const auto facet_count = count(0, "facets", limits_.facets);
    if (!facet_count) return facet_count.error();
    for (std::uint64_t i = 0; i < *facet_count; ++i) {
      if (auto status = facet(i); !status) return status;
    }
    return Done{};
  }

  // Reads "POLYGONS [HOLES [MARKER]]", then the polygons, then the hole points.
  Status facet(std::uint64_t number) {
    if (!lines_.next()) return lines_.ended("facet " + std::to_string(number));
    const auto polygon_count = count(0, "polygons");
    if (!polygon_count) return polygon_count.error();
    std::uint64_t hole_count = 0;
    if (lines_.words().size() > 1) {
      const auto holes = count(1, "hole points");
      if (!holes) return holes.error();
      hole_count = *holes;
    }
    for (std::uint64_t i = 0; i < *polygon_count; ++i) {
      if (auto status = polygon(number); !status) return status;
    }
    for (std::uint64_t i = 0; i < hole_count; ++i) {
      if (auto status = point("hole"); !status) return status;
    }
    arrays_.end_facet();
    return Done{};
  }

  // Reads "CORNERS A B C ...", which may go on in the next lines.
  Status polygon(std::uint64_t facet) {
    if (!lines_.next()) return lines_.ended("a polygon of facet " + std::to_string(facet));
    const auto corner_count = count(0, "corners");
    if (!corner_count) return corner_count.error();
    std::size_t word = 1;
    for (std::uint64_t i = 0; i < *corner_count; ++i) {
      if (word == lines_.words().size()) {
        if (!lines_.next()) return lines_.ended("a corner of facet " + std::to_string(facet));
        word = 0;
      }
      const auto node = unsigned_word(lines_.words()[word]);
      if (!node || *node < first_node_ || *node - first_node_ >= vertices_.positions.size()) {
        return wrong(word, "no node has this number (" +
                               quantity(vertices_.positions.size(), "node") + " from " +
                               std::to_string(first_node_) + ")");
      }
      arrays_.ring_vertices.push_back(static_cast<Index>(*node - first_node_));
      ++word;
    }
    if (word < lines_.words().size()) return wrong(word, "more corners than the polygon has");
    arrays_.end_ring();
    return Done{};
  }

  // Skips "NUMBER X Y Z ...".
  Status point(const std::string& what) {
    if (!lines_.next()) return lines_.ended("a " + what + " point");
    if (lines_.words().size() < 4) return wrong(0, "a " + what + " point needs three coordinates");
    return Done{};
  }

  // Skips a section of hole or region points, which many files leave out.
  Status points(const std::string& what) {
    if (!lines_.next()) return Done{};
    const auto point_count = count(0, what + " points");
    if (!point_count) return point_count.error();
    for (std::uint64_t i = 0; i < *point_count; ++i) {
      if (auto status = point(what); !status) return status;
    }
    if (*point_count > 0) {
      document_.notes.push_back(quantity(*point_count, what + " point") + " skipped");
    }
    return Done{};
  }

  std::uint64_t first_node_ = 0;
};

}  // namespace

Result<Document> read_poly(std::string_view text, const Limits& limits) {
  return PolyReader(text, limits).read();
}

}  // namespace watertight::formats
