// SPDX-License-Identifier: GPL-3.0-or-later
//
// verdict_families [--family NAME|all] [--first SEED] [--count N] [--variants K] [--engines K]
//                  [--threads N] [--keep DIR] [--show N]
// Judges the samples of N seeds of each family (families.h) with the default options; every K-th
// seed is also judged mirrored, renumbered, strict and by the boundary alone (--variants, 10), and
// by each engine alone (--engines, 200); 0 is never. All disagreements are counted; the first ones
// of a family are printed (--show, 20), and --keep writes the printed ones as documents. Exit
// status 1 on any disagreement.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "bench/verdict/judge.h"

using namespace watertight;
using namespace watertight::verdict;

namespace {

struct Arguments {
  std::string family = "all";
  std::string keep;
  std::uint64_t first = 0;
  std::uint64_t count = 1000;
  std::uint64_t variants = 10;
  std::uint64_t engines = 200;
  std::uint64_t threads = 1;
  std::uint64_t show = 20;
};

Arguments arguments_of(int argc, char** argv) {
  Arguments arguments;
  const std::map<std::string, std::uint64_t*> numbers{
      {"--first", &arguments.first},       {"--count", &arguments.count},
      {"--variants", &arguments.variants}, {"--engines", &arguments.engines},
      {"--threads", &arguments.threads},   {"--show", &arguments.show}};
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i];
    const auto number = numbers.find(word);
    if (number != numbers.end()) {
      *number->second = std::strtoull(argv[i + 1], nullptr, 10);
    } else if (word == "--family") {
      arguments.family = argv[i + 1];
    } else if (word == "--keep") {
      arguments.keep = argv[i + 1];
    } else {
      std::fprintf(stderr, "unknown option %s\n", word.c_str());
      std::exit(2);
    }
  }
  return arguments;
}

struct Totals {
  std::uint64_t samples = 0;
  std::uint64_t valid = 0;  // the number of samples that are valid according to the truth
  std::uint64_t unknown = 0;
  std::uint64_t questions = 0;
  std::array<std::uint64_t, kOutcomes> outcomes{};
  /// The number of disagreements. Quadrilaterals whose diagonals are equal in plan and in space
  /// have no canonical diagonal that a mirror image keeps (docs/robustness.md): surfaces whose
  /// verdict varies for that reason are counted, but are no disagreement.
  std::uint64_t disagreements() const {
    return questions - outcomes[static_cast<std::size_t>(Outcome::right)] -
           outcomes[static_cast<std::size_t>(Outcome::allowed)] -
           outcomes[static_cast<std::size_t>(Outcome::varies)];
  }
};

void keep(const Arguments& arguments, const std::string& name, const Sample& sample) {
  if (arguments.keep.empty()) return;
  const WrittenSample text = written(sample);
  std::ofstream(arguments.keep + "/" + name + text.ending) << text.text;
}

void note(const Arguments& arguments, const Family& family, std::uint64_t seed,
          const Judgement& judgement) {
  std::string expected = judgement.truth.is_valid() ? "valid" : "invalid";
  for (const int code : judgement.truth.codes) expected += ' ' + std::to_string(code);
  if (!judgement.truth.reason.empty()) expected += " (" + judgement.truth.reason + ')';
  std::printf("%s seed %llu, %s: %s: %s expected, %s said\n", family.name,
              static_cast<unsigned long long>(seed), judgement.variant.c_str(),
              to_string(judgement.outcome), expected.c_str(), to_string(judgement.said).c_str());
  std::fflush(stdout);
  std::string name =
      std::string(family.name) + "-" + std::to_string(seed) + "-" + judgement.variant;
  for (char& c : name) c = c == ' ' ? '-' : c;
  keep(arguments, name, judgement.sample);
}

void add(const Arguments& arguments, const Family& family, std::uint64_t seed,
         const std::vector<Judgement>& judgements, Totals& totals) {
  ++totals.samples;
  if (judgements.empty()) {
    ++totals.unknown;
    return;
  }
  if (judgements.front().truth.is_valid()) ++totals.valid;
  for (const Judgement& judgement : judgements) {
    ++totals.questions;
    ++totals.outcomes[static_cast<std::size_t>(judgement.outcome)];
    if (judgement.outcome == Outcome::right || judgement.outcome == Outcome::allowed ||
        judgement.outcome == Outcome::varies) {
      continue;
    }
    if (totals.disagreements() <= arguments.show) note(arguments, family, seed, judgement);
  }
}

Totals run(const Arguments& arguments, const Family& family, delaunay::EngineWorkers& workers) {
  Totals totals;
  std::mutex mutex;
  std::atomic<std::uint64_t> next{arguments.first};
  const std::uint64_t end = arguments.first + arguments.count;
  const auto is_due = [](std::uint64_t seed, std::uint64_t every) {
    return every != 0 && seed % every == 0;
  };
  const auto work = [&] {
    for (std::uint64_t seed = next++; seed < end; seed = next++) {
      const Sample sample = sample_of_seed(family, seed);
      const JudgeOptions options{&workers, is_due(seed, arguments.variants),
                                 is_due(seed, arguments.engines)};
      const std::vector<Judgement> judgements = judge(sample, seed, options);
      const std::lock_guard<std::mutex> lock(mutex);
      add(arguments, family, seed, judgements, totals);
    }
  };
  std::vector<std::thread> threads;
  for (std::uint64_t i = 1; i < arguments.threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return totals;
}

void print(const char* name, const Totals& totals, double seconds) {
  std::printf("%-15s %8llu samples, %8llu valid, %8llu questions, %6llu disagreements:", name,
              static_cast<unsigned long long>(totals.samples),
              static_cast<unsigned long long>(totals.valid),
              static_cast<unsigned long long>(totals.questions),
              static_cast<unsigned long long>(totals.disagreements()));
  for (std::size_t i = 1; i < kOutcomes; ++i) {
    std::printf(" %llu %s,", static_cast<unsigned long long>(totals.outcomes[i]),
                to_string(static_cast<Outcome>(i)));
  }
  std::printf(" %llu unknown, %.0f s\n", static_cast<unsigned long long>(totals.unknown), seconds);
  std::fflush(stdout);
}

void include(Totals& sum, const Totals& part) {
  sum.samples += part.samples;
  sum.valid += part.valid;
  sum.unknown += part.unknown;
  sum.questions += part.questions;
  for (std::size_t i = 0; i < kOutcomes; ++i) sum.outcomes[i] += part.outcomes[i];
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = arguments_of(argc, argv);
  if (!arguments.keep.empty()) std::filesystem::create_directories(arguments.keep);
  delaunay::EngineWorkers workers;
  Totals sum;
  const auto seconds_since = [](std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const auto start = std::chrono::steady_clock::now();
  for (const Family& family : families()) {
    if (arguments.family != "all" && arguments.family != family.name) continue;
    const auto family_start = std::chrono::steady_clock::now();
    const Totals totals = run(arguments, family, workers);
    print(family.name, totals, seconds_since(family_start));
    include(sum, totals);
  }
  print("total", sum, seconds_since(start));
  return sum.samples != 0 && sum.disagreements() == 0 ? 0 : 1;
}
