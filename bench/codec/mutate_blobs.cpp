// SPDX-License-Identifier: GPL-3.0-or-later
//
// mutate_blobs N SEED: decodes N damaged blobs and says how many were rejected, with which code.
// Run it in a sanitizer build; a decoded blob must be a boundary that encodes again.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "codec/encode_boundary.h"
#include "mutated_blobs.h"

using namespace watertight;

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: mutate_blobs N SEED\n");
    return 2;
  }
  const std::uint64_t rounds = std::strtoull(arguments[1], nullptr, 10);
  const std::uint64_t seed = std::strtoull(arguments[2], nullptr, 10);
  generated::Random random(seed);
  const auto blobs = generated::seed_blobs(seed);
  std::map<std::string, std::uint64_t> outcomes;
  for (std::uint64_t i = 0; i < rounds; ++i) {
    const Bytes blob = generated::mutated(blobs, random);
    const auto decoded = decode(blob);
    if (!decoded) {
      ++outcomes[std::string(to_string(decoded.error().code))];
      continue;
    }
    const auto boundary = OrientedBoundary::make(decoded->solid);
    if (!boundary || !encode_boundary(*boundary, decoded->info.acceptance, {.mode = Mode::raw})) {
      std::fprintf(stderr, "round %llu: decoded, but no boundary that encodes\n",
                   static_cast<unsigned long long>(i));
      return 1;
    }
    ++outcomes["decoded"];
  }
  for (const auto& [outcome, number] : outcomes) {
    std::printf("%s %llu\n", outcome.c_str(), static_cast<unsigned long long>(number));
  }
  return 0;
}
