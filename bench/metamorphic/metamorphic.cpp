// SPDX-License-Identifier: GPL-3.0-or-later
//
// metamorphic [--first SEED] [--count N] [--threads N] [--ladder-every N] [--nef-every N]
//             [--largest FACETS] [--show] FILE...
// Examines the solids of N seeds (relations.h); the solids of the files, up to `largest` facets,
// serve as real ones. Prints each disagreement with its seed, and the counts at the end; --show
// prints the solids of the seeds as text like OFF instead. Exit status 1 on any disagreement.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bench/input.h"
#include "bench/metamorphic/relations.h"

using namespace watertight;

namespace {

struct Arguments {
  std::uint64_t first = 0;
  std::uint64_t count = 1000;
  std::uint64_t threads = 1;
  std::uint64_t ladder_every = 0;
  std::uint64_t nef_every = 10;
  std::uint64_t largest = 150;
  bool show = false;
  std::vector<std::string> files;
};

Arguments arguments_of(int argc, char** argv) {
  Arguments arguments;
  const std::map<std::string, std::uint64_t*> numbers{
      {"--first", &arguments.first},         {"--count", &arguments.count},
      {"--threads", &arguments.threads},     {"--ladder-every", &arguments.ladder_every},
      {"--nef-every", &arguments.nef_every}, {"--largest", &arguments.largest}};
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto number = numbers.find(word);
    if (number != numbers.end() && i + 1 < argc) {
      *number->second = std::strtoull(argv[++i], nullptr, 10);
    } else if (word == "--show") {
      arguments.show = true;
    } else {
      arguments.files.push_back(word);
    }
  }
  return arguments;
}

std::vector<Solid> read_solids(const Arguments& arguments) {
  std::vector<Solid> solids;
  for (const std::string& file : arguments.files) {
    const auto document = bench::read_file(file);
    if (!document) {
      std::fprintf(stderr, "%s is left out: %s\n", file.c_str(),
                   to_string(document.error()).c_str());
      continue;
    }
    for (const Feature& feature : document->features) {
      for (const SubmittedSolid& submitted : feature.solids) {
        const Solid& solid = submitted.solid;
        if (solid.facet_count() > 0 && solid.facet_count() <= arguments.largest &&
            solid.lattice().kind != LatticeKind::float64) {
          solids.push_back(solid);
        }
      }
    }
  }
  return solids;
}

void show(const Solid& solid) {
  std::printf("shells %u facets %u vertices %u\n", solid.shell_count(), solid.facet_count(),
              solid.vertex_count());
  for (const Point& p : solid.vertices()) std::printf("v %.17g %.17g %.17g\n", p.x, p.y, p.z);
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    std::printf("f %u shell %u:", facet, solid.shell_of(facet));
    for (Index ring = solid.rings_of(facet).begin; ring < solid.rings_of(facet).end; ++ring) {
      std::printf(" (");
      for (const Index vertex : solid.ring(ring)) std::printf(" %u", vertex);
      std::printf(" )");
    }
    std::printf("\n");
  }
}

struct Totals {
  std::uint64_t solids = 0;
  std::uint64_t disagreements = 0;
  std::map<std::string, std::uint64_t> families;
  std::map<std::string, std::uint64_t> outcomes;
  std::map<std::string, std::uint64_t> checks;
};

void add(Totals& totals, std::uint64_t seed, const SeedResult& result) {
  ++totals.solids;
  ++totals.families[result.family];
  ++totals.outcomes[result.outcome];
  for (const auto& [relation, count] : result.checks) totals.checks[relation] += count;
  for (const std::string& disagreement : result.disagreements) {
    ++totals.disagreements;
    std::printf("seed %llu (%s) %s\n", static_cast<unsigned long long>(seed), result.family.c_str(),
                disagreement.c_str());
    std::fflush(stdout);
  }
}

Totals examine(const Arguments& arguments, const RelationOptions& options) {
  Totals totals;
  std::mutex mutex;
  std::atomic<std::uint64_t> next{arguments.first};
  const std::uint64_t end = arguments.first + arguments.count;
  const auto work = [&] {
    for (std::uint64_t seed = next++; seed < end; seed = next++) {
      const SeedResult result = examine_seed(seed, options);
      const std::lock_guard<std::mutex> lock(mutex);
      add(totals, seed, result);
      if (totals.solids % 1000 == 0) {
        std::fprintf(stderr, "%llu solids, %llu disagreements\n",
                     static_cast<unsigned long long>(totals.solids),
                     static_cast<unsigned long long>(totals.disagreements));
      }
    }
  };
  std::vector<std::thread> threads;
  for (std::uint64_t i = 1; i < arguments.threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return totals;
}

void print(const char* title, const std::map<std::string, std::uint64_t>& counts) {
  std::printf("\n%s\n", title);
  for (const auto& [name, count] : counts) {
    std::printf("%10llu  %s\n", static_cast<unsigned long long>(count), name.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = arguments_of(argc, argv);
  const std::vector<Solid> real = read_solids(arguments);
  std::unique_ptr<delaunay::EngineWorkers> workers;
  if (arguments.ladder_every != 0) workers = std::make_unique<delaunay::EngineWorkers>();
  const RelationOptions options{real, workers.get(), arguments.ladder_every, arguments.nef_every};
  if (arguments.show) {
    for (std::uint64_t i = 0; i < arguments.count; ++i) {
      show(solid_of_seed(arguments.first + i, options));
    }
    return 0;
  }
  const auto start = std::chrono::steady_clock::now();
  const Totals totals = examine(arguments, options);
  print("relations checked", totals.checks);
  print("solids by origin", totals.families);
  print("solids by outcome", totals.outcomes);
  std::printf("\nseeds %llu to %llu, %zu real solids, %llu solids, %llu disagreements, %.0f s\n",
              static_cast<unsigned long long>(arguments.first),
              static_cast<unsigned long long>(arguments.first + arguments.count - 1), real.size(),
              static_cast<unsigned long long>(totals.solids),
              static_cast<unsigned long long>(totals.disagreements),
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return totals.disagreements == 0 ? 0 : 1;
}
