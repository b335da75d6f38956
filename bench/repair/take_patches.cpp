// SPDX-License-Identifier: GPL-3.0-or-later
//
// Takes 1 to 5 connected patches of facets away from valid solids, repairs them, and compares the
// volumes.
//
//   take_patches COUNT FILE...
//
// Prints how many were repaired, why holes stayed open, the reasons of holes that could not be
// filled, and a histogram of the volume of the repaired solid as a share of the original. CGAL
// looks for triangles that cross in the repaired solids; a pair is status 1.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bench/input.h"
#include "repair/repair.h"
#include "tessellate/facets.h"
#include "tests/random.h"
#include "validate/finding_kinds.h"

using namespace watertight;

namespace {

using Edge = std::pair<Index, Index>;

/// Facets of an edited solid that share an edge.
class Neighbours {
 public:
  explicit Neighbours(const std::vector<repair::EditedFacet>& facets) {
    for (std::size_t i = 0; i < facets.size(); ++i) {
      for (const repair::Ring& ring : facets[i].rings) {
        for (std::size_t j = 0; j < ring.size(); ++j) {
          const auto [a, b] = std::minmax(ring[j], ring[(j + 1) % ring.size()]);
          by_edge_[{a, b}].push_back(i);
          edges_[i].push_back({a, b});
        }
      }
    }
  }
  std::vector<std::size_t> of(std::size_t facet) const {
    std::set<std::size_t> found;
    for (const Edge& edge : edges_.at(facet)) {
      for (const std::size_t other : by_edge_.at(edge)) found.insert(other);
    }
    return {found.begin(), found.end()};
  }

 private:
  std::map<Edge, std::vector<std::size_t>> by_edge_;
  std::map<std::size_t, std::vector<Edge>> edges_;
};

/// Facets in 1 to 5 patches of 1 to 4 facets.
std::set<std::size_t> patches_of(const std::vector<repair::EditedFacet>& facets,
                                 test::Random& random) {
  const Neighbours neighbours(facets);
  std::set<std::size_t> gone;
  const std::uint64_t count = 1 + random.below(5);
  for (std::uint64_t patch = 0; patch < count; ++patch) {
    std::vector<std::size_t> own{random.below(facets.size())};
    const std::uint64_t size = 1 + random.below(4);
    while (own.size() < size) {
      const auto around = neighbours.of(own[random.below(own.size())]);
      const std::size_t next = around[random.below(around.size())];
      if (std::ranges::find(own, next) != own.end()) break;
      own.push_back(next);
    }
    gone.insert(own.begin(), own.end());
  }
  return gone;
}

struct Tally {
  std::size_t solids = 0;
  std::map<std::string, std::size_t> outcomes;
  std::map<std::string, std::size_t> methods;
  std::map<std::string, std::size_t> reasons;  // of holes that were not filled
  std::map<int, std::size_t> shares;           // percent, rounded
  std::size_t crossings = 0;
  std::size_t refilled = 0;  // solids with facets that the proof fills otherwise; not looked at
};

/// The pairs of canonical triangles of a solid that cross, as CGAL says.
std::size_t crossings_of(const Solid& solid) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> points;
  for (const Point& p : solid.vertices()) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const Triangle& t : tessellate::triangulate_facets(solid).triangles) {
    triangles.push_back({t[0], t[1], t[2]});
  }
  std::vector<std::pair<std::size_t, std::size_t>> found;
  CGAL::Polygon_mesh_processing::triangle_soup_self_intersections(points, triangles,
                                                                  std::back_inserter(found));
  return found.size();
}

void take(const Solid& solid, double volume, const repair::RepairOptions& options,
          test::Random& random, Tally& tally) {
  repair::EditedSolid edited = repair::edited(solid);
  const auto gone = patches_of(edited.shells[0], random);
  if (gone.size() >= edited.shells[0].size()) return;
  std::vector<repair::EditedFacet> kept;
  for (std::size_t i = 0; i < edited.shells[0].size(); ++i) {
    if (!gone.contains(i)) kept.push_back(edited.shells[0][i]);
  }
  edited.shells[0] = kept;
  const auto open = repair::solid_of(edited);
  if (!open) return;
  ++tally.solids;
  const repair::Repaired repaired = repair::repair(*open, nullptr, options);
  if (!repaired.after) {
    std::string reason = "not repaired:";
    for (const int code : validate::error_codes(repaired.before.findings)) {
      reason += ' ' + std::to_string(code);
    }
    ++tally.outcomes[reason];
    for (const repair::HoleFill& hole : repaired.holes) {
      if (hole.method == "unfilled") ++tally.reasons[hole.reason];
    }
    return;
  }
  ++tally.outcomes["repaired"];
  if (repaired.after->report.refilled_facets.empty()) {
    tally.crossings += crossings_of(repaired.after->certified->solid.boundary().solid());
  } else {
    ++tally.refilled;
  }
  for (const repair::HoleFill& hole : repaired.holes) ++tally.methods[hole.method];
  const double now = repaired.after->report.measures->volume;
  ++tally.shares[static_cast<int>(std::lround(100 * now / volume))];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::size_t count = std::stoul(argv[1]);
  repair::RepairOptions options;
  options.remedies.assign(repair::kAllRemedies.begin(), repair::kAllRemedies.end());
  options.certify.proof = Proof::boundary;
  test::Random random(20);
  Tally tally;
  for (int i = 2; i < argc; ++i) {
    const auto document = bench::read_file(argv[i]);
    if (!document) continue;
    for (const auto& feature : document->features) {
      for (const auto& submitted : feature.solids) {
        if (tally.solids == count) break;
        const Inspection inspection = certify(submitted.solid, nullptr, options.certify);
        if (!inspection.certified) continue;
        take(submitted.solid, inspection.report.measures->volume, options, random, tally);
      }
    }
  }
  std::printf("%zu solids\n", tally.solids);
  for (const auto& [outcome, times] : tally.outcomes) {
    std::printf("  %-32s %6zu\n", outcome.c_str(), times);
  }
  std::printf("holes by method\n");
  for (const auto& [method, times] : tally.methods) {
    std::printf("  %-32s %6zu\n", method.c_str(), times);
  }
  std::printf("holes of solids that stay, not filled\n");
  for (const auto& [reason, times] : tally.reasons) {
    std::printf("  %-32s %6zu\n", reason.c_str(), times);
  }
  std::printf("crossings %zu; with other triangles than the canonical ones %zu\n", tally.crossings,
              tally.refilled);
  std::printf("volume, %% of the original\n");
  for (const auto& [share, times] : tally.shares) std::printf("  %4d %6zu\n", share, times);
  return tally.crossings == 0 ? 0 : 1;
}
