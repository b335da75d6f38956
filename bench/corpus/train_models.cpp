// SPDX-License-Identifier: GPL-3.0-or-later
//
// train_models CORPUS [--prior FOLDER] [--exclude SET]... [--only MODE] [--passes N]
//
// Trains the models of each mode on the training half of a corpus and prints what the test half
// takes, per set and mode: bytes per solid in pages of 64 and in blobs of their own, the models'
// part alone. Blocks of 64 solids of a set are training and test in turns; excluded sets are test
// only. With --prior the trained states are written, one file per mode.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bench/corpus/corpus.h"
#include "codec/modes.h"

using namespace watertight;

namespace {

constexpr std::size_t kPage = 64;
constexpr std::uint32_t kMaxCount = 60;

struct ModeRow {
  const char* name;
  const ModelLayout& (*layout)();
  CodeSolid* code;
};

const ModeRow kModes[] = {
    // One row per mode.
    {nullptr, nullptr, nullptr},
};

struct Page {
  std::string set;
  bool is_test = false;
  std::vector<const GriddedSolid*> solids;
};

struct Options {
  std::string corpus;
  std::string prior;
  std::set<std::string> excluded;
  std::string only;
  int passes = 2;
};

/// Bits for one solid, or nothing if the mode cannot hold it; then `bank` is as before.
std::optional<double> bits_of(const ModeRow& mode, ModelBank& bank, const PageMemory& memory,
                              const GriddedSolid& gridded) {
  const ModelBank before = bank;
  EntropyStream meter = EntropyStream::meter();
  IntegerSolid solid = gridded.solid;
  if (const Status status = mode.code(meter, bank, memory, solid, Limits{}); !status) {
    bank = before;
    return std::nullopt;
  }
  return static_cast<double>(meter.cost()) / (1 << kCostBits);
}

struct Sums {
  std::size_t solids = 0;
  std::size_t vertices = 0;
  std::size_t refused = 0;
  double paged = 0;
  double alone = 0;
};

void train(const ModeRow& mode, const std::vector<Page>& pages, ModelBank& bank) {
  for (const Page& page : pages) {
    if (page.is_test) continue;
    PageMemory memory;
    for (const GriddedSolid* gridded : page.solids) {
      bits_of(mode, bank, PageMemory{}, *gridded);
      bits_of(mode, bank, memory, *gridded);
      memory.add(gridded->solid);
    }
  }
}

void measure(const ModeRow& mode, const std::vector<Page>& pages, const ModelBank& prior,
             std::map<std::string, Sums>& sums) {
  for (const Page& page : pages) {
    if (!page.is_test) continue;
    Sums sum;
    PageMemory memory;
    ModelBank bank = prior;
    for (const GriddedSolid* gridded : page.solids) {
      ModelBank own = prior;
      const auto alone = bits_of(mode, own, PageMemory{}, *gridded);
      const auto paged = bits_of(mode, bank, memory, *gridded);
      memory.add(gridded->solid);
      if (!alone || !paged) {
        ++sum.refused;
        continue;
      }
      ++sum.solids;
      sum.vertices += gridded->solid.vertices.size();
      sum.alone += *alone / 8;
      sum.paged += *paged / 8;
    }
    for (const std::string& key : {page.set, std::string("~ all")}) {
      Sums& total = sums[key];
      total.solids += sum.solids;
      total.vertices += sum.vertices;
      total.refused += sum.refused;
      total.alone += sum.alone;
      total.paged += sum.paged;
    }
  }
}

void print(const std::map<std::string, Sums>& sums) {
  std::printf("| set | solids | vertices | refused | page B | blob B | page bits/vertex |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const auto& [set, sum] : sums) {
    const auto n = static_cast<double>(std::max<std::size_t>(sum.solids, 1));
    std::printf("| %s | %zu | %.1f | %zu | %.1f | %.1f | %.2f |\n", set.c_str(), sum.solids,
                static_cast<double>(sum.vertices) / n, sum.refused, sum.paged / n, sum.alone / n,
                8 * sum.paged / static_cast<double>(std::max<std::size_t>(sum.vertices, 1)));
  }
}

std::vector<Page> pages_of(const std::vector<CorpusSolid>& corpus,
                           const std::vector<GriddedSolid>& gridded, const Options& options) {
  std::map<std::string, std::vector<const GriddedSolid*>> sets;
  for (std::size_t i = 0; i < corpus.size(); ++i) sets[corpus[i].set].push_back(&gridded[i]);
  std::vector<Page> pages;
  for (const auto& [set, solids] : sets) {
    for (std::size_t first = 0; first < solids.size(); first += kPage) {
      Page page;
      page.set = set;
      page.is_test = options.excluded.contains(set) || (first / kPage) % 2 == 1;
      for (std::size_t i = first; i < std::min(first + kPage, solids.size()); ++i) {
        if (!solids[i]->solid.vertices.empty()) page.solids.push_back(solids[i]);
      }
      pages.push_back(std::move(page));
    }
  }
  return pages;
}

void run(const ModeRow& mode, const std::vector<Page>& pages, const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  ModelBank bank(mode.layout());
  for (int pass = 0; pass < options.passes; ++pass) train(mode, pages, bank);
  const Bytes state = bank.save(kMaxCount);
  ModelBank prior(mode.layout());
  if (!prior.load(state)) std::abort();
  std::map<std::string, Sums> sums;
  measure(mode, pages, prior, sums);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("\n### %s: prior %zu bytes, %zu counters, %.1f s\n\n", mode.name, state.size(),
              bank.counter_count(), seconds);
  print(sums);
  if (options.prior.empty()) return;
  std::ofstream file(options.prior + "/" + mode.name + ".prior", std::ios::binary);
  file.write(as_text(state).data(), static_cast<std::streamsize>(state.size()));
}

Options read_options(int count, char** arguments) {
  Options options;
  options.corpus = count > 1 ? arguments[1] : "";
  for (int i = 2; i + 1 < count; i += 2) {
    const std::string name = arguments[i];
    const std::string value = arguments[i + 1];
    if (name == "--prior") options.prior = value;
    if (name == "--exclude") options.excluded.insert(value);
    if (name == "--only") options.only = value;
    if (name == "--passes") options.passes = std::atoi(value.c_str());
  }
  return options;
}

}  // namespace

int main(int count, char** arguments) {
  const Options options = read_options(count, arguments);
  if (options.corpus.empty()) {
    std::fprintf(stderr, "usage: train_models CORPUS [--prior FOLDER] [--exclude SET]...\n");
    return 2;
  }
  const std::vector<CorpusSolid> corpus = read_corpus(options.corpus);
  std::vector<GriddedSolid> gridded;
  std::size_t without_grid = 0;
  for (const CorpusSolid& solid : corpus) {
    auto on_grid = grid_solid(solid.canonical.boundary.solid());
    without_grid += on_grid ? 0U : 1U;
    gridded.push_back(on_grid ? std::move(*on_grid) : GriddedSolid{});
  }
  std::printf("%zu solids, %zu without a grid\n", corpus.size(), without_grid);
  const std::vector<Page> pages = pages_of(corpus, gridded, options);
  for (const ModeRow& mode : kModes) {
    if (mode.name == nullptr || (!options.only.empty() && options.only != mode.name)) continue;
    run(mode, pages, options);
  }
}
