// SPDX-License-Identifier: GPL-3.0-or-later
//
// train_models CORPUS [--meshes FOLDER] [--out FILE] [--exclude SET]... [--only MODE] [--passes N]
//
// Trains the priors of the codec on the training half of a corpus, and prints the size of the test
// half for each set and mode: bytes per solid in pages of 64 and in blobs (only the streams,
// without the bytes around them). bench/corpus/split.h defines the two halves. With --out the set
// of priors is written as a model file.
//
// First, each mode learns from every solid that it can hold. Then all modes go on learning through
// the coder of pages, each from the solids for which it is the cheapest. Mode parallelogram also
// learns from the dense meshes of a folder (bench/corpus/training_meshes.h).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bench/corpus/corpus.h"
#include "bench/corpus/split.h"
#include "bench/corpus/training_meshes.h"
#include "codec/page/container.h"
#include "codec/page/modes.h"
#include "codec/page/solid_coder.h"
#include "codec/page/writer_choice.h"

using namespace watertight;

namespace {

constexpr Mode kModes[] = {Mode::polygon, Mode::walk, Mode::parallelogram};

struct Page {
  std::string set;
  bool is_test = false;
  codec::Frame frame;
  std::vector<const codec::PageSolid*> solids;
};

struct Options {
  std::string corpus;
  std::string out;
  std::string meshes;  // a folder, or empty
  std::set<std::string> excluded;
  std::string only;
  int passes = 2;
  // The least number of observations of a context of mode parallelogram in a prior.
  std::uint32_t least_count = 250;
  std::uint32_t max_count = 10;  // the number of observations that a prior counts for, at most
};

struct Sums {
  std::size_t solids = 0;
  std::size_t vertices = 0;
  std::size_t refused = 0;
  double paged = 0;
  double alone = 0;
  std::array<double, codec::kStreamParts> parts{};
  std::map<std::string, std::size_t> modes;

  Sums& operator+=(const Sums& other) {
    solids += other.solids;
    vertices += other.vertices;
    refused += other.refused;
    paged += other.paged;
    alone += other.alone;
    for (std::size_t i = 0; i < codec::kStreamParts; ++i) parts[i] += other.parts[i];
    for (const auto& [mode, number] : other.modes) modes[mode] += number;
    return *this;
  }
};
using SetSums = std::map<std::string, Sums>;

double bytes_of(std::uint64_t cost) {
  return static_cast<double>(cost) / (8.0 * (1 << codec::kCostBits));
}

/// Codes one solid with a set of models; returns false if the mode cannot hold the solid, after
/// which the coder cannot be used.
bool learn(codec::SolidCoder& coder, const codec::PageSolid& solid, Mode mode) {
  codec::PageSolid copy = solid;
  copy.mode = mode;
  return coder.code(copy).has_value();
}

/// A coder with its own meter.
struct MeteredCoder {
  codec::EntropyStream meter = codec::EntropyStream::meter();
  codec::SolidCoder coder;
  MeteredCoder(codec::ModelSet& models, const codec::Frame& frame)
      : coder(meter, models, frame, Limits{}) {}
};

/// Trains models on pages. `choose` returns the mode of a solid, or Mode::automatic to leave it
/// out.
template <class Choose>
void train(const std::vector<Page>& pages, codec::ModelSet& models, const Choose& choose) {
  for (const Page& page : pages) {
    if (page.is_test) continue;
    MeteredCoder paged(models, page.frame);
    for (const codec::PageSolid* solid : page.solids) {
      MeteredCoder alone(models, page.frame);
      codec::Frame frame = page.frame;
      if (!codec::code_frame(alone.meter, models[codec::ModelPart::frame], frame)) std::abort();
      for (MeteredCoder* coder : {&alone, &paged}) {
        const Mode mode = choose(coder->coder, *solid);
        if (mode != Mode::automatic && !learn(coder->coder, *solid, mode)) std::abort();
      }
    }
  }
}

template <class Choose>
Sums measure_page(const Page& page, const std::array<codec::ModelBank, codec::kModelParts>& priors,
                  const Choose& choose) {
  Sums sum;
  codec::ModelSet models(priors);
  MeteredCoder paged(models, page.frame);
  for (const codec::PageSolid* solid : page.solids) {
    codec::ModelSet own(priors);
    MeteredCoder alone(own, page.frame);
    codec::Frame frame = page.frame;
    if (!codec::code_frame(alone.meter, own[codec::ModelPart::frame], frame)) std::abort();
    const Mode mode = choose(alone.coder, *solid);
    if (mode == Mode::automatic) {
      ++sum.refused;
      continue;
    }
    learn(alone.coder, *solid, mode);
    const codec::StreamCosts before = paged.meter.costs();
    const Mode paged_mode = choose(paged.coder, *solid);
    learn(paged.coder, *solid, paged_mode);
    codec::StreamCosts costs = paged.meter.costs();
    for (std::size_t i = 0; i < codec::kStreamParts; ++i) costs[i] -= before[i];
    ++sum.solids;
    sum.vertices += solid->integers->vertices.size();
    sum.alone += bytes_of(alone.meter.cost());
    for (std::size_t i = 0; i < codec::kStreamParts; ++i) sum.parts[i] += bytes_of(costs[i]);
    for (const std::uint64_t cost : costs) sum.paged += bytes_of(cost);
    ++sum.modes[std::string(codec::to_string(paged_mode))];
  }
  return sum;
}

void print(const SetSums& sums) {
  std::printf(
      "| set | solids | vertices | refused | page B | blob B | frame | position | connectivity | "
      "facets | coordinates | conn. bits/v | modes |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [set, sum] : sums) {
    const auto n = static_cast<double>(std::max<std::size_t>(sum.solids, 1));
    const auto v = static_cast<double>(std::max<std::size_t>(sum.vertices, 1));
    std::printf("| %s | %zu | %.1f | %zu | %.1f | %.1f |", set.c_str(), sum.solids, v / n,
                sum.refused, sum.paged / n, sum.alone / n);
    for (std::size_t i = 0; i + 1 < codec::kStreamParts; ++i)
      std::printf(" %.1f |", sum.parts[i] / n);
    std::printf(" %.2f |", 8 * (sum.parts[2] + sum.parts[3]) / v);
    for (const auto& [mode, number] : sum.modes) std::printf(" %s %zu", mode.c_str(), number);
    std::printf(" |\n");
  }
  std::fflush(stdout);
}

template <class Choose>
void measure(const char* title, const std::vector<Page>& pages,
             const std::array<codec::ModelBank, codec::kModelParts>& priors, const Choose& choose) {
  SetSums sums;
  for (const Page& page : pages) {
    if (!page.is_test) continue;
    const Sums sum = measure_page(page, priors, choose);
    sums[page.set] += sum;
    sums["~ all"] += sum;
  }
  std::printf("\n### %s\n\n", title);
  print(sums);
}

std::array<codec::ModelBank, codec::kModelParts> banks_of(codec::ModelSet& models) {
  std::array<codec::ModelBank, codec::kModelParts> banks = codec::neutral_priors();
  for (std::size_t i = 0; i < codec::kModelParts; ++i)
    banks[i] = models[static_cast<codec::ModelPart>(i)];
  return banks;
}

std::vector<Page> pages_of(const std::vector<CorpusSolid>& corpus,
                           const std::vector<codec::PageSolid>& stored, const Options& options) {
  std::vector<Page> pages;
  for (const CorpusPage& page : split_corpus(corpus, stored, options.excluded, kBlock)) {
    pages.push_back(Page{page.set, page.is_test, page.frame, {}});
    for (const std::size_t solid : page.solids) pages.back().solids.push_back(&stored[solid]);
  }
  return pages;
}

Options read_options(int count, char** arguments) {
  Options options;
  options.corpus = count > 1 ? arguments[1] : "";
  for (int i = 2; i + 1 < count; i += 2) {
    const std::string name = arguments[i];
    const std::string value = arguments[i + 1];
    if (name == "--out") options.out = value;
    if (name == "--meshes") options.meshes = value;
    if (name == "--exclude") options.excluded.insert(value);
    if (name == "--least-count")
      options.least_count = static_cast<std::uint32_t>(std::atoi(value.c_str()));
    if (name == "--only") options.only = value;
    if (name == "--passes") options.passes = std::atoi(value.c_str());
    if (name == "--max-count")
      options.max_count = static_cast<std::uint32_t>(std::atoi(value.c_str()));
  }
  return options;
}

/// The shapes of the priors. In mode parallelogram the value of the parts of a context differs from
/// mesh to mesh, so weights and counters there adapt faster from neutral ones.
std::array<codec::PriorShape, codec::kModelParts> shapes_of(const Options& options) {
  std::array<codec::PriorShape, codec::kModelParts> shapes{};
  shapes.fill({.max_count = options.max_count});
  shapes[static_cast<std::size_t>(codec::ModelPart::parallelogram)] = {
      .max_count = 2, .least_count = options.least_count, .has_weights = false};
  return shapes;
}

void learn_meshes(const std::vector<codec::IntegerSolid>& meshes, codec::ModelBank& models) {
  for (const codec::IntegerSolid& mesh : meshes) {
    codec::EntropyStream meter = codec::EntropyStream::meter();
    codec::ModelBank learning = models;
    codec::IntegerSolid solid = mesh;
    if (codec::parallelogram::code_solid(meter, learning, codec::PageMemory{}, solid, {},
                                         Limits{})) {
      models = learning;
    }
  }
}

void train_all(const std::vector<Page>& pages, const Options& options) {
  const std::array<codec::ModelBank, codec::kModelParts> neutral = codec::neutral_priors();
  codec::ModelSet first(neutral);
  const std::vector<codec::IntegerSolid> meshes = training_meshes(options.meshes);
  std::printf("%zu meshes\n", meshes.size());
  learn_meshes(meshes, first[codec::ModelPart::parallelogram]);
  for (const Mode mode : kModes) {
    if (!options.only.empty() && options.only != codec::to_string(mode)) continue;
    const auto start = std::chrono::steady_clock::now();
    const auto choose = [mode](const codec::SolidCoder& coder, const codec::PageSolid& solid) {
      return coder.draft(solid, mode) ? mode : Mode::automatic;
    };
    for (int pass = 0; pass < options.passes; ++pass) train(pages, first, choose);
    const std::string title(codec::to_string(mode));
    measure(title.c_str(), pages, banks_of(first), choose);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("\n%.1f s\n", seconds);
  }
  if (!options.only.empty()) return;

  const std::array<codec::ModelBank, codec::kModelParts> chosen_by = banks_of(first);
  const auto cheapest = [](const codec::SolidCoder& coder, const codec::PageSolid& solid) {
    const auto draft = coder.cheapest(solid);
    return draft ? draft->mode : Mode::automatic;
  };
  codec::ModelSet second(chosen_by);
  for (int pass = 0; pass < options.passes; ++pass) train(pages, second, cheapest);
  learn_meshes(meshes, second[codec::ModelPart::parallelogram]);
  const auto shapes = shapes_of(options);
  const Bytes file = codec::write_models(banks_of(second), codec::kModelNumber, shapes);
  const auto priors = codec::read_models(file, codec::kModelNumber);
  if (!priors) std::abort();
  measure("cheapest mode", pages, *priors, cheapest);
  std::printf("\nmodel file: %zu bytes\n", file.size());
  for (std::size_t i = 0; i < codec::kModelParts; ++i) {
    std::printf("part %zu: %zu bytes\n", i, banks_of(second)[i].save(shapes[i]).size());
  }
  if (options.out.empty()) return;
  std::ofstream out(options.out, std::ios::binary);
  out.write(as_text(file).data(), static_cast<std::streamsize>(file.size()));
}

}  // namespace

int main(int count, char** arguments) {
  const Options options = read_options(count, arguments);
  if (options.corpus.empty()) {
    std::fprintf(stderr,
                 "usage: train_models CORPUS [--out FILE] [--exclude SET]... [--only MODE]\n");
    return 2;
  }
  const std::vector<CorpusSolid> corpus = read_corpus(options.corpus);
  std::vector<codec::PageSolid> stored;
  for (const CorpusSolid& solid : corpus) {
    stored.push_back(codec::page_solid(solid.source, false));
  }
  std::printf("%zu solids\n", corpus.size());
  train_all(pages_of(corpus, stored, options), options);
}
