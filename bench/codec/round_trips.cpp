// SPDX-License-Identifier: GPL-3.0-or-later
//
// round_trips N SEED [LARGEST]: encodes N generated solids of 4 to LARGEST vertices in the modes,
// alone and in pages, decodes them and compares. Each solid has a random state of its own, so that
// a failure is found again by its number: round_trips 1 NUMBER.
// round_trips CORPUS: the same for every solid of a corpus (bench/corpus/corpus.h), in all modes.
#include <charconv>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

#include "bench/corpus/corpus.h"
#include "codec/encode_boundary.h"
#include "round_trip.h"

using namespace watertight;

namespace {

using generated::RoundTrips;

int report(const RoundTrips& trips, std::uint64_t solids) {
  std::printf("%llu solids\n", static_cast<unsigned long long>(solids));
  for (const auto& [what, count] : trips.counts()) {
    std::printf("%12llu %s\n", static_cast<unsigned long long>(count), what.c_str());
  }
  std::printf("%zu failures\n", trips.failures().size());
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
  for (std::size_t i = 0; i < solids.size(); ++i) {
    trips.check_all_modes(solids[i].set + " " + std::to_string(i), solids[i].source,
                          solids[i].acceptance);
    print_new_failures(trips, printed);
  }
  return report(trips, solids.size());
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
  for (std::uint64_t i = 0; done < solids; ++i) {
    done += trips.check_generated(seed + i, largest);
    print_new_failures(trips, printed);
    if (i % 10000 == 9999) std::fprintf(stderr, "%llu\n", static_cast<unsigned long long>(done));
  }
  return report(trips, done);
}
