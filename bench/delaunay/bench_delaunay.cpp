// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compares the two implementations of the canonical Delaunay tetrahedralization.
//   bench_delaunay compare COUNT [FIRST]   whether COUNT sets, numbered from FIRST, give equal
// results
//   bench_delaunay time [REPEATS]          microseconds per set, as a Markdown table
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "delaunay/canonical/cgal_delaunay.h"
#include "delaunay/canonical/small_delaunay.h"
#include "point_sets.h"

namespace watertight {
namespace {

struct Tally {
  std::uint64_t sets = 0;
  std::uint64_t points = 0;
  std::uint64_t faces = 0;
};

bool is_same(const std::vector<Point>& points, Tally& tally) {
  const auto expected = delaunay::cgal_delaunay(points);
  const auto found = delaunay::small_delaunay(points);
  if (!expected || !found) return false;
  ++tally.sets;
  tally.points += points.size();
  tally.faces += found->faces.size();
  return expected->tetrahedra == found->tetrahedra && expected->faces == found->faces &&
         expected->apexes == found->apexes;
}

int compare(std::uint64_t count, std::uint64_t first) {
  std::map<std::string, Tally> tallies;
  std::uint64_t differences = 0;
  for (std::uint64_t number = first; number < first + count; ++number) {
    const std::string formula = point_sets::any_formula(number);
    const auto points = point_sets::shuffled(point_sets::make(formula), number);
    if (delaunay::is_small_grid(points) &&
        is_same(points, tallies[formula.substr(0, formula.find(' '))])) {
      continue;
    }
    ++differences;
    std::cout << "DIFFERENT: " << number << " " << formula << "\n";
  }
  std::cout << "| kind | sets | points | faces |\n|---|---|---|---|\n";
  for (const auto& [kind, tally] : tallies) {
    std::cout << "| " << kind << " | " << tally.sets << " | " << tally.points << " | "
              << tally.faces << " |\n";
  }
  std::cout << count << " sets, " << differences << " differences\n";
  return differences == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

/// The CPU time of one run: the least of some repetitions, each long enough to be measured.
template <class Delaunay>
double microseconds(const std::vector<Point>& points, int repeats, Delaunay delaunay) {
  const std::size_t inner = 1 + 6000 / points.size();
  double least = 1e300;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const std::clock_t start = std::clock();
    for (std::size_t i = 0; i < inner; ++i) {
      if (!delaunay(points)) return -1;
    }
    const double spent = static_cast<double>(std::clock() - start) * 1e6 / CLOCKS_PER_SEC;
    least = std::min(least, spent / static_cast<double>(inner));
  }
  return least;
}

int time(int repeats) {
  std::cout << std::fixed << std::setprecision(2)
            << "| set | points | faces | CGAL us | own us | own us/point | factor |\n"
               "|---|---|---|---|---|---|---|\n";
  for (const char* formula : {"houses 1",
                              "houses 5",
                              "tower 15 16384 1",
                              "random 30 16384 1",
                              "random 30 1073741824 1",
                              "houses 20",
                              "grid 5 5 5 1",
                              "grid 5 5 5 100000000",
                              "sphere 101 1",
                              "sphere 101 50000000",
                              "tower 250 16384 1",
                              "random 500 65536 1",
                              "grid 12 12 12 1",
                              "hollow 19",
                              "tower 1000 65536 1",
                              "random 2000 16384 1",
                              "random 2000 1073741824 1",
                              "flat 2000 65536 3 1",
                              "skew 100",
                              "paraboloid 22",
                              "random 20000 1048576 1",
                              "hollow 60",
                              "tower 5000 1048576 1",
                              "random 200000 1073741824 1",
                              "hollow 185"}) {
    const auto points = point_sets::make(formula);
    const auto faces = delaunay::small_delaunay(points);
    const double cgal =
        microseconds(points, repeats, [](const auto& p) { return delaunay::cgal_delaunay(p); });
    const double own =
        microseconds(points, repeats, [](const auto& p) { return delaunay::small_delaunay(p); });
    std::cout << "| " << formula << " | " << points.size() << " | "
              << (faces ? faces->faces.size() : 0) << " | " << cgal << " | " << own << " | "
              << own / static_cast<double>(points.size()) << " | " << cgal / own << " |"
              << std::endl;
  }
  return EXIT_SUCCESS;
}

int run(int argc, char** argv) {
  const auto number = [&](int i, std::uint64_t otherwise) {
    return argc > i ? std::strtoull(argv[i], nullptr, 10) : otherwise;
  };
  if (argc >= 3 && std::string_view(argv[1]) == "compare")
    return compare(number(2, 0), number(3, 0));
  if (argc >= 2 && std::string_view(argv[1]) == "time") return time(static_cast<int>(number(2, 3)));
  std::cerr << "bench_delaunay compare COUNT [FIRST] | time [REPEATS]\n";
  return EXIT_FAILURE;
}

}  // namespace
}  // namespace watertight

int main(int argc, char** argv) { return watertight::run(argc, argv); }
