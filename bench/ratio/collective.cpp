// SPDX-License-Identifier: GPL-3.0-or-later
//
// collective CORPUS [N]: measures the paper's second open question. For each set, tiles of N solids
// (400 by default) are coded once solid by solid and once together: with one Delaunay
// tetrahedralization of all vertices of the tile, each vertex and each shared wall once. Prints per
// solid: vertices, facets, Delaunay faces, marked and unrecovered faces, the paper's bits (1 for
// each Delaunay face, 96 for each unrecovered face), and the entropy of the marks as if each mark
// were independent of all others.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bench/corpus/split.h"
#include "delaunay/canonical/follow_delaunay.h"
#include "delaunay/canonical_delaunay.h"
#include "tessellate/facets.h"

using namespace watertight;

namespace {

struct Count {
  double vertices = 0;
  double facets = 0;
  double faces = 0;
  double marked = 0;
  double unrecovered = 0;

  void operator+=(const Count& other) {
    vertices += other.vertices;
    facets += other.facets;
    faces += other.faces;
    marked += other.marked;
    unrecovered += other.unrecovered;
  }
  double paper_bits() const { return faces + 96 * unrecovered; }
  double entropy() const {
    const double p = marked / faces;
    return p <= 0 || p >= 1 ? 0 : -faces * (p * std::log2(p) + (1 - p) * std::log2(1 - p));
  }
};

/// The facets of several solids on one grid, with each vertex once, and a facet once in whichever
/// orientation.
class Tile {
 public:
  void add(const codec::IntegerSolid& solid) {
    for (Index facet = 0; facet < solid.facet_count(); ++facet) {
      std::vector<std::vector<codec::GridPoint>> rings;
      std::set<codec::GridPoint> key;
      for (Index ring = solid.facet_offsets[facet]; ring < solid.facet_offsets[facet + 1]; ++ring) {
        std::vector<codec::GridPoint> points;
        for (const Index vertex : solid.ring(ring)) points.push_back(solid.vertices[vertex]);
        key.insert(points.begin(), points.end());
        rings.push_back(std::move(points));
      }
      if (!known_.insert(key).second) continue;
      for (const auto& ring : rings) {
        for (const codec::GridPoint& point : ring) arrays_.ring_vertices.push_back(number(point));
        arrays_.end_ring();
      }
      arrays_.end_facet();
    }
  }

  Count count() {
    const codec::GridPoint corner = corner_;
    for (const codec::GridPoint& point : points_) {
      arrays_.vertices.push_back({static_cast<double>(point[0] - corner[0]),
                                  static_cast<double>(point[1] - corner[1]),
                                  static_cast<double>(point[2] - corner[2])});
    }
    arrays_.end_shell();
    const auto solid = Solid::make(std::move(arrays_), Lattice{}, 0, Limits{});
    if (!solid) return {};
    const auto delaunay = delaunay::canonical_delaunay(solid->vertices());
    if (!delaunay || delaunay->faces.empty()) return {};
    const auto following =
        delaunay::follow_delaunay(*solid, tessellate::triangulate_facets(*solid), *delaunay);
    Count count;
    count.vertices = static_cast<double>(solid->vertex_count());
    count.facets = static_cast<double>(solid->facet_count());
    count.faces = static_cast<double>(delaunay->faces.size());
    count.unrecovered = static_cast<double>(following.missing_total);
    count.marked = static_cast<double>(following.triangles.size()) - count.unrecovered;
    return count;
  }

 private:
  Index number(const codec::GridPoint& point) {
    const auto [place, is_new] = numbers_.emplace(point, static_cast<Index>(points_.size()));
    if (is_new) {
      if (points_.empty()) corner_ = point;
      points_.push_back(point);
      for (std::size_t axis = 0; axis < 3; ++axis)
        corner_[axis] = std::min(corner_[axis], point[axis]);
    }
    return place->second;
  }

  SolidArrays arrays_;
  std::map<codec::GridPoint, Index> numbers_;
  std::vector<codec::GridPoint> points_;
  std::set<std::set<codec::GridPoint>> known_;
  codec::GridPoint corner_{};
};

void print(const std::string& set, const char* how, const Count& count, double solids) {
  std::printf("| %s | %s | %.0f | %.2f | %.2f | %.1f | %.2f | %.3f | %.1f | %.1f |\n", set.c_str(),
              how, solids, count.vertices / solids, count.facets / solids, count.faces / solids,
              count.marked / solids, count.unrecovered / solids, count.paper_bits() / solids,
              count.entropy() / solids);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: collective CORPUS [N]\n");
    return 2;
  }
  const std::size_t most = count > 2 ? static_cast<std::size_t>(std::atoi(arguments[2])) : 400;
  const std::vector<CorpusSolid> corpus = read_corpus(arguments[1]);
  std::map<std::pair<std::string, codec::PageGrid>, std::vector<codec::IntegerSolid>> sets;
  for (const CorpusSolid& solid : corpus) {
    const auto gridded = codec::grid_solid(solid.canonical.boundary.solid());
    if (gridded) sets[{solid.set, gridded->grid}].push_back(gridded->solid);
  }
  std::printf(
      "| set | coded | solids | vertices | facets | Delaunay faces | marked | unrecovered | "
      "paper's bits | entropy of the marks, bits |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [key, solids] : sets) {
    if (solids.size() < 50) continue;
    Count alone;
    Count together;
    for (std::size_t first = 0; first < solids.size(); first += most) {
      Tile tile;
      for (std::size_t i = first; i < std::min(first + most, solids.size()); ++i) {
        Tile one;
        one.add(solids[i]);
        alone += one.count();
        tile.add(solids[i]);
      }
      together += tile.count();
    }
    print(key.first, "one by one", alone, static_cast<double>(solids.size()));
    print(key.first, "together", together, static_cast<double>(solids.size()));
  }
}
