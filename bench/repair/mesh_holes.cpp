// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cuts holes into a mesh, many of them with an island, and fills them all.
//
//   mesh_holes FILE HOLES ISLANDS
//
// HOLES places are chosen at random, no two of which touch. At ISLANDS of them the facets of three
// rings around a disc go and the disc stays; at the others a disc goes. Prints the seconds of
// fill_holes(), the methods, and the verdict of the exact tests on the result.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bench/input.h"
#include "repair/repair.h"
#include "tests/random.h"
#include "validate/finding_kinds.h"

using namespace watertight;

namespace {

/// The facets around each vertex.
std::vector<std::vector<std::size_t>> stars_of(const repair::EditedSolid& mesh) {
  std::vector<std::vector<std::size_t>> stars(mesh.vertices.size());
  const auto& facets = mesh.shells[0];
  for (std::size_t i = 0; i < facets.size(); ++i) {
    for (const Index vertex : facets[i].rings[0]) stars[vertex].push_back(i);
  }
  return stars;
}

/// The facets around a vertex, ring by ring.
class Rings {
 public:
  Rings(const repair::EditedSolid& mesh, const std::vector<std::vector<std::size_t>>& stars,
        Index center)
      : mesh_(mesh), stars_(stars), vertices_{center} {}

  /// The facets of the next ring. `vertices()` are those of all rings until now.
  std::set<std::size_t> next() {
    std::set<std::size_t> ring;
    for (const Index vertex : vertices_) {
      for (const std::size_t facet : stars_[vertex]) {
        if (!facets_.contains(facet)) ring.insert(facet);
      }
    }
    for (const std::size_t facet : ring) {
      const auto& corners = mesh_.shells[0][facet].rings[0];
      vertices_.insert(corners.begin(), corners.end());
    }
    facets_.insert(ring.begin(), ring.end());
    return ring;
  }
  const std::set<Index>& vertices() const { return vertices_; }

 private:
  const repair::EditedSolid& mesh_;
  const std::vector<std::vector<std::size_t>>& stars_;
  std::set<Index> vertices_;
  std::set<std::size_t> facets_;
};

/// The mesh less the facets at random places.
repair::EditedSolid with_holes(repair::EditedSolid mesh, std::size_t holes, std::size_t islands) {
  const auto stars = stars_of(mesh);
  test::Random random(61);
  std::set<Index> taken;
  std::set<std::size_t> gone;
  std::size_t made = 0;
  for (std::size_t attempt = 0; made < holes && attempt < 1000 * holes; ++attempt) {
    Rings rings(mesh, stars, static_cast<Index>(random.below(mesh.vertices.size())));
    const bool has_island = made < islands;
    std::set<std::size_t> own;
    for (int ring = 0; ring < (has_island ? 5 : 3); ++ring) {
      const auto facets = rings.next();
      if (!has_island || ring >= 2) own.insert(facets.begin(), facets.end());
    }
    const bool is_free = std::ranges::none_of(rings.vertices(),
                                              [&](Index vertex) { return taken.contains(vertex); });
    if (!is_free) continue;
    rings.next();  // no two holes touch
    taken.insert(rings.vertices().begin(), rings.vertices().end());
    gone.insert(own.begin(), own.end());
    ++made;
  }
  std::vector<repair::EditedFacet> kept;
  for (std::size_t i = 0; i < mesh.shells[0].size(); ++i) {
    if (!gone.contains(i)) kept.push_back(mesh.shells[0][i]);
  }
  mesh.shells[0] = std::move(kept);
  std::printf("%zu holes, %zu of them with an island; %zu facets of %zu are gone\n", made,
              std::min(made, islands), gone.size(), gone.size() + mesh.shells[0].size());
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const auto document = bench::read_file(argv[1]);
  if (!document || document->features.empty()) return 1;
  const Solid& solid = document->features[0].solids[0].solid;
  repair::EditedSolid mesh =
      with_holes(repair::edited(solid), std::stoul(argv[2]), std::stoul(argv[3]));
  const auto start = std::chrono::steady_clock::now();
  repair::FillHolesOptions options;
  options.tolerances.planarity_metres = 0;  // no hole becomes one facet
  const std::vector<repair::HoleFill> holes = repair::fill_holes(mesh, options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::map<std::string, std::size_t> methods;
  std::map<std::size_t, std::size_t> loops;
  for (const repair::HoleFill& hole : holes) {
    ++methods[hole.method];
    ++loops[hole.loops];
  }
  std::printf("filled in %.2f s\n", seconds.count());
  for (const auto& [method, count] : methods) std::printf("  %-10s %5zu\n", method.c_str(), count);
  for (const auto& [count, times] : loops) std::printf("  %zu loops    %5zu\n", count, times);
  const auto filled = repair::solid_of(mesh);
  if (!filled) return 1;
  CertifyOptions rules;
  rules.proof = Proof::boundary;
  const Inspection inspection = certify(*filled, nullptr, rules);
  std::printf("verdict %s", std::string(validate::to_string(inspection.report.verdict)).c_str());
  for (const int code : validate::error_codes(inspection.report.findings)) std::printf(" %d", code);
  std::printf("\n");
  return 0;
}
