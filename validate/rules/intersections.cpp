// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rules of facets that intersect, within a shell (306) and between shells (401). Exact. Facets of
// one shell may meet in common vertices and common ring edges only; facets of different shells may
// also touch, in points and along edges, but not cross or share an area.
#include <algorithm>

#include "geometry/intersection/box_partition.h"
#include "validate/facet_diagonals.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

/// The number of pairs at which the first search stops: enough for any report. If all these pairs
/// are allowed contacts of shells, the search is repeated with a higher limit, up to kLastLimit.
constexpr std::uint64_t kFirstLimit = 20'000;
constexpr std::uint64_t kLastLimit = 10'000'000;  // the pairs then take some 550 MB

struct FacetPair {
  Index first = 0;
  Index second = 0;
  geometry::IntersectingPair worst;  // the most severe pair of triangles of the two facets
};

class IntersectionExaminer {
 public:
  IntersectionExaminer(ExaminedSolid& examined, const std::vector<Index>& duplicate_of,
                       const CancelPoll& cancel, unsigned threads)
      : examined_(examined),
        duplicate_of_(duplicate_of),
        cancel_(cancel),
        threads_(threads),
        vertices_(examined.solid().vertices()),
        triangles_(examined.triangles().triangles) {
    contacts_.is_touching.assign(examined.solid().shell_count(), false);
  }

  ShellContacts examine() {
    mark_common_vertices();
    at_diagonals_ = diagonal_contacts(examined_.solid(), examined_.triangles());
    std::uint64_t limit = kFirstLimit;
    while (!search(limit) && limit < kLastLimit) {
      limit = std::min(100 * limit, kLastLimit);
    }
    std::sort(contacts_.intersecting.begin(), contacts_.intersecting.end());
    auto& list = contacts_.intersecting;
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return std::move(contacts_);
  }

 private:
  void mark_common_vertices();
  bool search(std::uint64_t limit);
  bool is_wrong(const FacetPair& pair);
  bool have_common_vertex(const geometry::IntersectingPair& pair) const;
  void report(const FacetPair& pair);
  void keep_found(const std::vector<FacetPair>& pairs, std::vector<TrianglePair> all);
  Index facet_of(Index triangle) const { return examined_.triangles().facet_of[triangle]; }

  ExaminedSolid& examined_;
  const std::vector<Index>& duplicate_of_;
  const CancelPoll& cancel_;
  unsigned threads_;
  std::span<const Point> vertices_;
  std::span<const Triangle> triangles_;
  std::vector<geometry::IntersectingPair> at_diagonals_;
  ShellContacts contacts_;
};

void IntersectionExaminer::mark_common_vertices() {
  if (contacts_.is_touching.size() < 2) return;
  std::vector<Index> owner(vertices_.size(), kNone);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Index shell = examined_.shell_of(facet_of(static_cast<Index>(t)));
    for (const Index vertex : triangles_[t]) {
      if (owner[vertex] == kNone) owner[vertex] = shell;
      if (owner[vertex] == shell) continue;
      contacts_.is_touching[shell] = contacts_.is_touching[owner[vertex]] = true;
    }
  }
}

bool IntersectionExaminer::have_common_vertex(const geometry::IntersectingPair& pair) const {
  const Triangle& a = triangles_[pair.first];
  const Triangle& b = triangles_[pair.second];
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

/// True if the contact of two facets is a finding. Also notes which shells touch or intersect.
bool IntersectionExaminer::is_wrong(const FacetPair& pair) {
  const Index a = examined_.shell_of(pair.first);
  const Index b = examined_.shell_of(pair.second);
  if (a == b) {
    return !examined_.is_junction_contact(pair.worst.contact, pair.first, pair.second);
  }
  if (duplicate_of_[a] == b || duplicate_of_[b] == a ||
      (duplicate_of_[a] != kNone && duplicate_of_[a] == duplicate_of_[b])) {
    return false;
  }
  contacts_.is_touching[a] = contacts_.is_touching[b] = true;
  if (pair.worst.contact < geometry::ContactClass::crossing) return false;
  contacts_.intersecting.emplace_back(std::min(a, b), std::max(a, b));
  return true;
}

void IntersectionExaminer::report(const FacetPair& pair) {
  const Index a = examined_.shell_of(pair.first);
  const Index b = examined_.shell_of(pair.second);
  Finding finding;
  finding.code = a == b ? kShellSelfIntersection : kIntersectionShells;
  finding.place = examined_.at_facet(pair.first);
  finding.other = examined_.at_facet(pair.second);
  finding.witness = examined_.world(geometry::contact_witness(
      vertices_, triangles_[pair.worst.first], triangles_[pair.worst.second]));
  finding.detail = have_common_vertex(pair.worst)
                       ? "the facets meet in more than the vertices they share ("
                       : "the facets intersect (";
  finding.detail += std::string(geometry::to_string(pair.worst.contact)) + ")";
  finding.uncertain = examined_.is_faulty(pair.first) || examined_.is_faulty(pair.second);
  examined_.findings.add(std::move(finding));
}

/// Keeps the triangle pairs of the facet pairs that are findings. Requires sorted facet pairs.
void IntersectionExaminer::keep_found(const std::vector<FacetPair>& pairs,
                                      std::vector<TrianglePair> all) {
  std::erase_if(all, [&](const TrianglePair& pair) {
    const auto place =
        std::lower_bound(pairs.begin(), pairs.end(), pair, [](const FacetPair& a, const auto& b) {
          return std::tie(a.first, a.second) < std::tie(b.first_facet, b.second_facet);
        });
    return place == pairs.end() || place->first != pair.first_facet ||
           place->second != pair.second_facet;
  });
  std::sort(all.begin(), all.end(), [](const TrianglePair& a, const TrianglePair& b) {
    return std::tie(a.first_facet, a.second_facet, a.first, a.second) <
           std::tie(b.first_facet, b.second_facet, b.first, b.second);
  });
  contacts_.found = std::move(all);
}

/// False if the search must be repeated with a higher limit.
bool IntersectionExaminer::search(std::uint64_t limit) {
  geometry::IntersectionOptions options;
  options.limit = limit;
  options.cancel = cancel_;
  options.threads = threads_;
  // Triangles of one facet meet in common vertices and edges only, by construction.
  options.group_of = examined_.triangles().facet_of;
  auto found = geometry::intersecting_pairs(vertices_, triangles_, options);
  if (!found) {
    contacts_.incomplete = "the search for intersections was ended: " + to_string(found.error());
    examined_.findings.skip({kShellSelfIntersection, kIntersectionShells}, contacts_.incomplete);
    return true;
  }
  const bool is_cut_off = found->size() >= limit;
  found->insert(found->end(), at_diagonals_.begin(), at_diagonals_.end());
  std::vector<FacetPair> pairs;
  for (const geometry::IntersectingPair& pair : *found) {
    const auto [first, second] = std::minmax({facet_of(pair.first), facet_of(pair.second)});
    pairs.push_back({first, second, pair});
  }
  std::vector<TrianglePair> triangle_pairs;
  for (const FacetPair& pair : pairs) {
    const bool is_swapped = facet_of(pair.worst.first) != pair.first;
    triangle_pairs.push_back({pair.first, pair.second,
                              is_swapped ? pair.worst.second : pair.worst.first,
                              is_swapped ? pair.worst.first : pair.worst.second});
  }
  std::sort(pairs.begin(), pairs.end(), [](const FacetPair& a, const FacetPair& b) {
    return std::tuple(a.first, a.second, -static_cast<int>(a.worst.contact), a.worst.first,
                      a.worst.second) < std::tuple(b.first, b.second,
                                                   -static_cast<int>(b.worst.contact),
                                                   b.worst.first, b.worst.second);
  });
  pairs.erase(std::unique(pairs.begin(), pairs.end(),
                          [](const FacetPair& a, const FacetPair& b) {
                            return a.first == b.first && a.second == b.second;
                          }),
              pairs.end());
  std::erase_if(pairs, [&](const FacetPair& pair) { return !is_wrong(pair); });
  if (pairs.empty() && is_cut_off && limit < kLastLimit) return false;
  for (const FacetPair& pair : pairs) report(pair);
  keep_found(pairs, std::move(triangle_pairs));
  if (is_cut_off) {
    contacts_.incomplete = "the search for intersections stopped after " + std::to_string(limit) +
                           " pairs of triangles; there may be more";
    examined_.findings.skip({kShellSelfIntersection, kIntersectionShells}, contacts_.incomplete);
  }
  return true;
}

}  // namespace

ShellContacts check_intersections(ExaminedSolid& examined, const std::vector<Index>& duplicate_of,
                                  const CancelPoll& cancel, unsigned threads) {
  const auto& states = examined.triangles().state;
  const auto place = std::find_if(states.begin(), states.end(), [](tessellate::FacetState state) {
    return state != tessellate::FacetState::triangulated;
  });
  if (place != states.end()) {
    examined.findings.skip({kShellSelfIntersection, kIntersectionShells},
                           "not for facets whose rings bound no region (first: facet " +
                               std::to_string(place - states.begin()) + ")");
  }
  return IntersectionExaminer(examined, duplicate_of, cancel, threads).examine();
}

}  // namespace watertight::validate
