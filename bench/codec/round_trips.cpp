// SPDX-License-Identifier: GPL-3.0-or-later
//
// round_trips N SEED [LARGEST]: encodes N generated solids of 4 to LARGEST vertices in the modes,
// alone and in pages, decodes them and compares. Each solid has a random state of its own, so that
// the number of a failure is enough to repeat it: round_trips 1 NUMBER.
// round_trips CORPUS: encodes and decodes every solid of a corpus (bench/corpus/corpus.h) in all
// modes.
#include <sys/resource.h>

#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <map>
#include <string>

#include "bench/corpus/corpus.h"
#include "codec/encode_boundary.h"
#include "tests/generated/round_trip.h"

using namespace watertight;

namespace {

using generated::RoundTrips;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The number and the time of the slowest solid or page.
struct Slowest {
  std::uint64_t number = 0;
  double seconds = 0;
  void note(std::uint64_t which, double took) {
    if (took > seconds) *this = {which, took};
  }
};

int report(const RoundTrips& trips, std::uint64_t solids, const Slowest& slowest) {
  for (const auto& [what, count] : trips.counts()) {
    std::printf("%12llu %s\n", static_cast<unsigned long long>(count), what.c_str());
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "%llu solids in %.0f s, %zu failures; the slowest took %.1f s (number %llu); at most %ld "
      "MB\n",
      static_cast<unsigned long long>(solids), cpu_seconds(), trips.failures().size(),
      slowest.seconds, static_cast<unsigned long long>(slowest.number), usage.ru_maxrss / 1024);
  return trips.failures().empty() ? 0 : 1;
}

void print_new_failures(const RoundTrips& trips, std::size_t& printed) {
  for (; printed < trips.failures().size(); ++printed) {
    std::fprintf(stderr, "%s\n", trips.failures()[printed].c_str());
  }
}

int run_corpus(const char* path) {
  RoundTrips trips;
  std::size_t printed = 0;
  const auto solids = read_corpus(path);
  Slowest slowest;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const double start = cpu_seconds();
    trips.check_all_modes(solids[i].set + " " + std::to_string(i), solids[i].source,
                          solids[i].acceptance);
    slowest.note(i, cpu_seconds() - start);
    print_new_failures(trips, printed);
  }
  return report(trips, solids.size(), slowest);
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 2) return run_corpus(arguments[1]);
  if (count != 3 && count != 4) {
    std::fprintf(stderr, "usage: round_trips N SEED [LARGEST] | round_trips CORPUS\n");
    return 2;
  }
  const auto number = [](const char* text) {
    std::uint64_t value = 0;
    std::from_chars(text, text + std::strlen(text), value);
    return value;
  };
  const std::uint64_t solids = number(arguments[1]);
  const std::uint64_t seed = number(arguments[2]);
  const auto largest = static_cast<Index>(count == 4 ? number(arguments[3]) : 100'000);
  RoundTrips trips;
  std::size_t printed = 0;
  std::uint64_t done = 0;
  Slowest slowest;
  for (std::uint64_t i = 0; done < solids; ++i) {
    const double start = cpu_seconds();
    done += trips.check_generated(seed + i, largest);
    slowest.note(seed + i, cpu_seconds() - start);
    print_new_failures(trips, printed);
    if (i % 10'000 < 9'999) continue;
    std::fprintf(stderr, "%llu, %.0f s\n", static_cast<unsigned long long>(done), cpu_seconds());
  }
  return report(trips, done, slowest);
}
