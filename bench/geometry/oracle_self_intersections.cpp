// SPDX-License-Identifier: GPL-3.0-or-later
//
// oracle_self_intersections [--repeat N] FILE...: for each mesh (OBJ, OFF, PLY, STL; polygons
// become fans, equal vertices are merged) prints the intersecting pairs by class, and whether the
// box partition finds the same pairs as
//   - the classification of all pairs (up to 20,000 triangles),
//   - box_self_intersection_d with the classification,
//   - PMP::triangle_soup_self_intersections (without classes and without equal triangles),
// with the seconds of each. Exit status 1 if any of them differs.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "bench/geometry/read_soup.h"
#include "geometry/intersection/box_partition.h"

namespace {

using namespace watertight;
using bench::Soup;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Pair = std::pair<Index, Index>;

std::vector<Pair> names(const std::vector<geometry::IntersectingPair>& pairs) {
  std::vector<Pair> result;
  for (const auto& pair : pairs) result.emplace_back(pair.first, pair.second);
  return result;
}

std::vector<Pair> by_all_pairs(const Soup& mesh) {
  std::vector<Pair> pairs;
  for (Index i = 0; i < mesh.triangles.size(); ++i) {
    for (Index j = i + 1; j < mesh.triangles.size(); ++j) {
      if (geometry::is_intersection(
              geometry::classify_contact(mesh.points, mesh.triangles[i], mesh.triangles[j]))) {
        pairs.emplace_back(i, j);
      }
    }
  }
  return pairs;
}

std::vector<Pair> by_box_intersection(const Soup& mesh) {
  using BoxD = CGAL::Box_intersection_d::Box_with_info_d<double, 3, Index>;
  std::vector<BoxD> boxes;
  for (Index i = 0; i < mesh.triangles.size(); ++i) {
    CGAL::Bbox_3 box;
    for (const Index vertex : mesh.triangles[i]) {
      const Point& p = mesh.points[vertex];
      box += CGAL::Bbox_3(p.x, p.y, p.z, p.x, p.y, p.z);
    }
    boxes.emplace_back(box, i);
  }
  std::vector<Pair> pairs;
  constexpr std::ptrdiff_t kCutoff = 2000;
  CGAL::box_self_intersection_d(
      boxes.begin(), boxes.end(),
      [&](const BoxD& a, const BoxD& b) {
        const Index first = std::min(a.info(), b.info());
        const Index second = std::max(a.info(), b.info());
        const auto contact =
            geometry::classify_contact(mesh.points, mesh.triangles[first], mesh.triangles[second]);
        if (geometry::is_intersection(contact)) pairs.emplace_back(first, second);
      },
      kCutoff);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<Pair> by_pmp(const Soup& mesh) {
  std::vector<Kernel::Point_3> points;
  for (const Point& p : mesh.points) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const Triangle& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  std::vector<std::pair<std::size_t, std::size_t>> found;
  CGAL::Polygon_mesh_processing::triangle_soup_self_intersections(points, triangles,
                                                                  std::back_inserter(found));
  std::vector<Pair> pairs;
  for (const auto& [a, b] : found) {
    pairs.emplace_back(static_cast<Index>(std::min(a, b)), static_cast<Index>(std::max(a, b)));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template <class Function>
auto timed(Function function, double& seconds) {
  const auto start = std::chrono::steady_clock::now();
  auto result = function();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  seconds = std::min(seconds, elapsed.count());
  return result;
}

void print_classes(const Soup& mesh, const std::vector<geometry::IntersectingPair>& pairs) {
  const auto with_common_vertex = std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) {
    const Triangle& second = mesh.triangles[pair.second];
    return std::find_first_of(second.begin(), second.end(), mesh.triangles[pair.first].begin(),
                              mesh.triangles[pair.first].end()) != second.end();
  });
  if (!pairs.empty()) {
    std::printf("    %zu without a common vertex, %zu with one\n",
                pairs.size() - static_cast<std::size_t>(with_common_vertex),
                static_cast<std::size_t>(with_common_vertex));
  }
  std::array<std::size_t, 12> counts{};
  for (const auto& pair : pairs) ++counts[static_cast<std::size_t>(pair.contact)];
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const auto name = geometry::to_string(static_cast<geometry::ContactClass>(i));
    std::printf("    %-16.*s %zu\n", static_cast<int>(name.size()), name.data(), counts[i]);
  }
}

/// True if all methods agree on the mesh.
bool compare(const std::string& file, int repeat) {
  const std::optional<Soup> read = bench::read_soup(file);
  if (!read) {
    std::printf("%s: cannot be read\n", file.c_str());
    return false;
  }
  const Soup& mesh = *read;
  double own = 1e9;
  double boxes = 1e9;
  double pmp = 1e9;
  std::vector<geometry::IntersectingPair> pairs;
  std::vector<Pair> from_boxes;
  std::vector<Pair> from_pmp;
  for (int i = 0; i < repeat; ++i) {
    auto found = timed(
        [&] { return geometry::intersecting_pairs(mesh.points, mesh.triangles, {.limit = ~0ULL}); },
        own);
    if (!found) return false;
    pairs = std::move(found).value();
    from_boxes = timed([&] { return by_box_intersection(mesh); }, boxes);
    from_pmp = timed([&] { return by_pmp(mesh); }, pmp);
  }
  constexpr std::size_t kAllPairs = 20'000;
  const bool does_all = mesh.triangles.size() <= kAllPairs;
  const bool equals_all = !does_all || by_all_pairs(mesh) == names(pairs);
  const bool equals_boxes = from_boxes == names(pairs);
  // PMP does not report pairs of equal triangles.
  std::vector<geometry::IntersectingPair> for_pmp;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(for_pmp),
               [](const auto& pair) { return pair.contact != geometry::ContactClass::duplicate; });
  const bool equals_pmp = from_pmp == names(for_pmp);
  std::printf(
      "%s: %zu triangles, %zu pairs; all pairs %s, box_self_intersection_d %s, PMP %s (%zu)\n",
      file.c_str(), mesh.triangles.size(), pairs.size(),
      !does_all    ? "not run"
      : equals_all ? "equal"
                   : "DIFFERENT",
      equals_boxes ? "equal" : "DIFFERENT", equals_pmp ? "equal" : "DIFFERENT", from_pmp.size());
  std::printf("    seconds: box partition %.4f, box_self_intersection_d %.4f, PMP %.4f\n", own,
              boxes, pmp);
  print_classes(mesh, pairs);
  return equals_all && equals_boxes && equals_pmp;
}

}  // namespace

int main(int argc, char** argv) {
  int repeat = 1;
  bool all_equal = true;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--repeat" && i + 1 < argc) {
      repeat = std::max(1, std::atoi(argv[++i]));
      continue;
    }
    all_equal = compare(argument, repeat) && all_equal;
  }
  return all_equal ? 0 : 1;
}
