// SPDX-License-Identifier: GPL-3.0-or-later
//
// prove_families [--first SEED] [--count N] [--family NAME] [--peers]: proves N solids of each
// family of tests/solids/hard_solids.h in this process alone, without engines. Prints how many
// solids pass the exact tests, how many of these are proven by which rung, their Steiner points,
// processor time and memory, and each solid that is not proven. --peers also asks CGAL and TetGen
// for each solid whose boundary is not Delaunay. Exit status 1 if a solid is not proven.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>

#include "counted_memory.h"
#include "delaunay/ladder.h"
#include "tests/solids/hard_solids.h"
#include "validate/certify.h"

using namespace watertight;

namespace {

struct Arguments {
  std::uint64_t first = 1;
  std::uint64_t count = 1000;
  std::string family;
  bool asks_peers = false;
};

/// The sums of one engine over the solids that it was asked for.
struct Sums {
  std::size_t asked = 0;
  std::size_t proven = 0;
  std::size_t steiner_points = 0;
  double seconds = 0;
  double longest = 0;
  double most_bytes_a_vertex = 0;
};

struct FamilySums {
  std::size_t passed = 0;    // the number of solids that pass the exact tests
  std::size_t delaunay = 0;  // the number of those that are part of the Delaunay tetrahedralization
  Sums own, cgal, tetgen;    // of those that are not
};

Arguments arguments_of(int count, char** words) {
  Arguments arguments;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool has_value = i + 1 < count;
    if (word == "--peers") {
      arguments.asks_peers = true;
    } else if (word == "--first" && has_value) {
      arguments.first = std::strtoull(words[++i], nullptr, 10);
    } else if (word == "--count" && has_value) {
      arguments.count = std::strtoull(words[++i], nullptr, 10);
    } else if (word == "--family" && has_value) {
      arguments.family = words[++i];
    } else {
      std::fprintf(stderr, "unknown option %s\n", word.c_str());
      std::exit(2);
    }
  }
  return arguments;
}

/// The inspection of a solid with some rungs of the ladder only.
Inspection inspect(const Solid& solid, delaunay::EngineWorkers* workers, delaunay::Rung first,
                   delaunay::Rung last) {
  CertifyOptions options;
  // Metric rules do not apply: facets of the families are planar or triangles.
  options.tolerances.planarity_metres = 1e30;
  options.tolerances.planarity_degrees = 360;
  options.ladder.first_rung = first;
  options.ladder.last_rung = last;
  return certify(solid, workers, options);
}

void add(Sums& sums, const Inspection& inspection) {
  ++sums.asked;
  double seconds = 0;
  for (const delaunay::RungAttempt& attempt : inspection.report.attempts) {
    seconds += attempt.cpu_seconds + attempt.worker_seconds;
  }
  sums.seconds += seconds;
  sums.longest = std::max(sums.longest, seconds);
  if (!inspection.certified) return;
  ++sums.proven;
  const delaunay::Tetrahedralization& all = inspection.certified->certificate->tetrahedralization;
  sums.steiner_points += all.points.size() - all.input_count;
}

void prove(const Solid& solid, const std::string& name, const Arguments& arguments,
           delaunay::EngineWorkers& workers, FamilySums& sums) {
  using enum delaunay::Rung;
  bench::count_bytes_from_here();
  const Inspection own = inspect(solid, nullptr, delaunay, recovered);
  const double bytes = static_cast<double>(bench::most_bytes_held());
  if (own.report.attempts.empty()) return;  // the exact tests refuse it
  ++sums.passed;
  if (own.certified && own.certified->certificate->rung == delaunay) {
    ++sums.delaunay;
    return;
  }
  add(sums.own, own);
  sums.own.most_bytes_a_vertex =
      std::max(sums.own.most_bytes_a_vertex, bytes / static_cast<double>(solid.vertex_count()));
  if (!own.certified) {
    std::printf("not proven: %s: %zu vertices, %s\n", name.c_str(),
                static_cast<std::size_t>(solid.vertex_count()),
                own.report.undecided_reason.c_str());
    std::fflush(stdout);
  }
  if (!arguments.asks_peers) return;
  add(sums.cgal, inspect(solid, &workers, patch, triangles_scaled));
  add(sums.tetgen, inspect(solid, &workers, tetgen, tetgen));
}

void print(const char* who, const Sums& sums) {
  const double count = static_cast<double>(std::max<std::size_t>(sums.asked, 1));
  std::printf("  %-9s proven %zu of %zu, Steiner points %zu, mean %.3f ms, longest %.1f ms", who,
              sums.proven, sums.asked, sums.steiner_points, 1e3 * sums.seconds / count,
              1e3 * sums.longest);
  if (sums.most_bytes_a_vertex > 0) {
    std::printf(", at most %.0f bytes a vertex", sums.most_bytes_a_vertex);
  }
  std::printf("\n");
}

}  // namespace

int main(int argument_count, char** words) {
  const Arguments arguments = arguments_of(argument_count, words);
  delaunay::EngineWorkers workers;
  bool is_all_proven = true;
  for (const solids::HardFamily& family : solids::hard_families()) {
    if (!arguments.family.empty() && arguments.family != family.name) continue;
    FamilySums sums;
    for (std::uint64_t i = 0; i < arguments.count; ++i) {
      const std::uint64_t seed = arguments.first + i;
      prove(solids::hard_solid(family, seed), std::string(family.name) + " " + std::to_string(seed),
            arguments, workers, sums);
    }
    std::printf("%s: %llu made, %zu pass the exact tests, %zu are Delaunay\n", family.name,
                static_cast<unsigned long long>(arguments.count), sums.passed, sums.delaunay);
    print("recovered", sums.own);
    if (arguments.asks_peers) {
      print("CGAL", sums.cgal);
      print("TetGen", sums.tetgen);
    }
    std::fflush(stdout);
    is_all_proven = is_all_proven && sums.own.proven == sums.own.asked;
  }
  return is_all_proven ? 0 : 1;
}
