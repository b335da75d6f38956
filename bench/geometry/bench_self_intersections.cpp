// SPDX-License-Identifier: GPL-3.0-or-later
//
// bench_self_intersections [--repeat N] [--threads N] [--set dense|worst|all] [FILE...]
//
// Compares the box partition with PMP::triangle_soup_self_intersections on the same triangles in
// one run: the two alternate, medians of N (3) each. Rows: the given meshes (OBJ, OFF, PLY, STL;
// polygons become fans, equal vertices are merged), then the generated shapes of the set: dense
// surfaces, or the worst cases (without PMP, whose time is quadratic there). Times are the CPU time
// of all threads of the process (user) and elapsed seconds; the ratio is of user times on one
// thread. Exit status 1 if the pairs differ from PMP's or between numbers of threads.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <sys/resource.h>

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
#include "bench/geometry/shapes.h"
#include "geometry/intersection/box_partition.h"

namespace {

using namespace watertight;
using bench::Soup;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Pair = std::pair<Index, Index>;

struct Options {
  int repeat = 3;
  unsigned threads = 2;
  std::string set = "dense";
  std::vector<std::string> files;
};

struct Seconds {
  double user = 0;
  double wall = 0;
};

Seconds operator-(const Seconds& a, const Seconds& b) { return {a.user - b.user, a.wall - b.wall}; }

Seconds now() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto wall = std::chrono::steady_clock::now().time_since_epoch();
  return {static_cast<double>(usage.ru_utime.tv_sec) +
              1e-6 * static_cast<double>(usage.ru_utime.tv_usec),
          std::chrono::duration<double>(wall).count()};
}

template <class Function>
auto timed(Function function, std::vector<Seconds>& times) {
  const Seconds start = now();
  auto result = function();
  times.push_back(now() - start);
  return result;
}

Seconds median(const std::vector<Seconds>& times) {
  const auto middle = [&](auto member) {
    std::vector<double> values;
    for (const Seconds& time : times) values.push_back(time.*member);
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[values.size() / 2];
  };
  return {middle(&Seconds::user), middle(&Seconds::wall)};
}

/// The triangles in the form that PMP takes.
struct PmpSoup {
  std::vector<Kernel::Point_3> points;
  std::vector<std::array<std::size_t, 3>> triangles;

  explicit PmpSoup(const Soup& soup) {
    for (const Point& p : soup.points) points.emplace_back(p.x, p.y, p.z);
    for (const Triangle& t : soup.triangles) triangles.push_back({t[0], t[1], t[2]});
  }
  std::vector<Pair> pairs() const {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    CGAL::Polygon_mesh_processing::triangle_soup_self_intersections(points, triangles,
                                                                    std::back_inserter(found));
    std::vector<Pair> result;
    for (const auto& [a, b] : found) {
      result.emplace_back(static_cast<Index>(std::min(a, b)), static_cast<Index>(std::max(a, b)));
    }
    std::sort(result.begin(), result.end());
    return result;
  }
};

std::vector<geometry::IntersectingPair> own_pairs(const Soup& soup, unsigned threads) {
  geometry::IntersectionOptions options;
  options.limit = std::uint64_t{1} << 40U;
  options.threads = threads;
  auto pairs = geometry::intersecting_pairs(soup.points, soup.triangles, options);
  if (!pairs) std::abort();
  return std::move(pairs).value();
}

/// The pairs without those of triangles with the same three vertices, which PMP leaves out.
std::vector<Pair> without_duplicates(const std::vector<geometry::IntersectingPair>& pairs) {
  std::vector<Pair> result;
  for (const auto& pair : pairs) {
    if (pair.contact != geometry::ContactClass::duplicate)
      result.emplace_back(pair.first, pair.second);
  }
  return result;
}

bool run(const Soup& soup, bool has_peer, const Options& options) {
  std::vector<Seconds> one;
  std::vector<Seconds> several;
  std::vector<Seconds> peer;
  bool is_equal = true;
  std::size_t count = 0;
  const PmpSoup for_pmp(soup);
  for (int i = 0; i < options.repeat; ++i) {
    const auto found = timed([&] { return own_pairs(soup, 1); }, one);
    count = found.size();
    if (has_peer) {
      const auto from_pmp = timed([&] { return for_pmp.pairs(); }, peer);
      is_equal = is_equal && from_pmp == without_duplicates(found);
    }
    const auto parallel = timed([&] { return own_pairs(soup, options.threads); }, several);
    is_equal = is_equal && parallel == found;
  }
  const Seconds a = median(one);
  const Seconds b = median(peer);
  const Seconds c = median(several);
  std::printf("| %s | %zu | %zu | %.3f | %.3f |", soup.name.c_str(), soup.triangles.size(), count,
              a.user, a.wall);
  if (has_peer) {
    std::printf(" %.3f | %.3f | %.2f |", b.user, b.wall, b.user / a.user);
  } else {
    std::printf(" | | |");
  }
  std::printf(" %.3f | %.2f | %s |\n", c.wall, a.wall / c.wall, is_equal ? "equal" : "DIFFERENT");
  std::fflush(stdout);
  return is_equal;
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool has_value = i + 1 < argc;
    if (argument == "--repeat" && has_value) {
      options.repeat = std::max(1, std::atoi(argv[++i]));
    } else if (argument == "--threads" && has_value) {
      options.threads = static_cast<unsigned>(std::max(1, std::atoi(argv[++i])));
    } else if (argument == "--set" && has_value) {
      options.set = argv[++i];
    } else {
      options.files.push_back(argument);
    }
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  std::printf(
      "| surface | triangles | pairs | ours user s | ours wall s | PMP user s | PMP wall s | "
      "PMP / ours | ours on %u threads wall s | 1 / %u threads | pairs |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n",
      options.threads, options.threads);
  bool all_equal = true;
  for (const std::string& file : options.files) {
    const std::optional<Soup> soup = bench::read_soup(file);
    if (!soup) {
      std::fprintf(stderr, "%s: cannot be read\n", file.c_str());
      return 2;
    }
    all_equal = run(*soup, true, options) && all_equal;
  }
  if (options.set == "dense" || options.set == "all") {
    for (const std::size_t count : {100'000, 300'000, 1'000'000}) {
      all_equal = run(bench::bumpy_sphere(count), true, options) && all_equal;
    }
    for (const std::size_t count : {100'000, 300'000}) {
      all_equal = run(bench::grid_box(count), true, options) && all_equal;
    }
  }
  if (options.set == "worst" || options.set == "all") {
    all_equal = run(bench::comb(25'000), false, options) && all_equal;
    all_equal = run(bench::cone(100'000), false, options) && all_equal;
    all_equal = run(bench::star(50'000), false, options) && all_equal;
    all_equal = run(bench::diagonal_needles(50'000), false, options) && all_equal;
    all_equal = run(bench::oblique_sheets(50'000), false, options) && all_equal;
    all_equal = run(bench::random_needles(5'000), false, options) && all_equal;
  }
  return all_equal ? 0 : 1;
}
