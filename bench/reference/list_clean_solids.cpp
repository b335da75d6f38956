// SPDX-License-Identifier: GPL-3.0-or-later
//
// list_clean_solids FILE...: prints one line for each solid: file, object, geometry, ordinal,
// number of unmatched edges, number of intersecting pairs, verdict. A solid is "clean" if every
// directed edge of the boundary is met exactly once by its reverse, and PMP finds no intersecting
// pair in the canonical triangulation. The oracle shares the reader and the triangulation with the
// validator, but no rule.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/input.h"
#include "bench/reference/pmp_oracle.h"
#include "tessellate/facets.h"

using namespace watertight;

namespace {

/// The numbers of wrong edges of the boundary: edges not used exactly twice (open), and edges used
/// twice in the same direction (misoriented).
struct EdgeCount {
  std::size_t open = 0;
  std::size_t misoriented = 0;
};

EdgeCount count_edges(const Solid& solid) {
  // For each edge, its uses forward and backward.
  std::map<std::pair<Index, Index>, std::pair<int, int>> uses;
  for (Index ring = 0; ring < solid.ring_count(); ++ring) {
    const auto vertices = solid.ring(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Index from = vertices[i];
      const Index to = vertices[(i + 1) % vertices.size()];
      // Merging has collapsed the edge; its facet has no triangulation then.
      if (from == to) continue;
      auto& use = uses[std::minmax(from, to)];
      ++(from < to ? use.first : use.second);
    }
  }
  EdgeCount count;
  for (const auto& [edge, use] : uses) {
    if (use.first + use.second != 2) {
      ++count.open;
    } else if (use.first != 1) {
      ++count.misoriented;
    }
  }
  return count;
}

/// The number of triangles with the same three vertices as another, which PMP does not report as
/// intersecting.
std::size_t count_equal_triangles(std::vector<Triangle> triangles) {
  for (Triangle& triangle : triangles) std::sort(triangle.begin(), triangle.end());
  std::sort(triangles.begin(), triangles.end());
  std::size_t equal = 0;
  for (std::size_t i = 1; i < triangles.size(); ++i)
    equal += triangles[i] == triangles[i - 1] ? 1U : 0U;
  return equal;
}

void list_solid(const std::string& file, const SubmittedSolid& submitted) {
  const Solid solid = geometry::merge_equal_vertices(submitted.solid).solid;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  const auto untriangulated = static_cast<std::size_t>(std::count_if(
      facets.state.begin(), facets.state.end(),
      [](tessellate::FacetState state) { return state != tessellate::FacetState::triangulated; }));
  const EdgeCount edges = count_edges(solid);
  const std::size_t pairs = count_pmp_intersections(solid.vertices(), facets.triangles) +
                            count_equal_triangles(facets.triangles);
  const bool is_clean = edges.open == 0 && edges.misoriented == 0 && pairs == 0 &&
                        untriangulated == 0 && solid.facet_count() > 0;
  std::printf("%s,%s,%u,%u,%zu,%zu,%zu,%zu,%s\n", file.c_str(), submitted.source.object_id.c_str(),
              submitted.source.geometry, submitted.source.ordinal, edges.open, edges.misoriented,
              untriangulated, pairs, is_clean ? "clean" : "dirty");
}

}  // namespace

int main(int argc, char** argv) {
  std::printf(
      "file,object,geometry,ordinal,open_edges,misoriented_edges,untriangulated_facets,"
      "intersecting_pairs,"
      "verdict\n");
  for (int i = 1; i < argc; ++i) {
    const std::string name = std::filesystem::path(argv[i]).filename().string();
    const auto document = bench::read_file(argv[i]);
    if (!document) {
      std::fprintf(stderr, "%s: %s\n", argv[i], to_string(document.error()).c_str());
      return 2;
    }
    for (const Feature& feature : document->features) {
      for (const SubmittedSolid& solid : feature.solids) list_solid(name, solid);
    }
  }
}
