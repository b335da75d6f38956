// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints a hash of every blob of a fixed set: generated solids in every mode, and what the golden
// files decode to and encode to again. Two builds of the codec agree if the lines agree.
#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "base/checksum.h"
#include "codec/encode_boundary.h"
#include "generated_solids.h"
#include "geometry/canonical_form.h"
#include "golden_blobs.h"

using namespace watertight;

namespace {

void print(const std::string& name, const Result<Bytes>& blob) {
  if (!blob) {
    std::printf("%s %s\n", name.c_str(), to_string(blob.error()).c_str());
    return;
  }
  std::printf("%s %zu %016" PRIx64 "\n", name.c_str(), blob->size(), content_hash(*blob));
}

void print_modes(const std::string& name, const OrientedBoundary& boundary) {
  for (const Mode mode : {Mode::raw, Mode::bitmap, Mode::automatic}) {
    print(name + " " + std::string(to_string(mode)), encode_boundary(boundary, {}, {.mode = mode}));
  }
}

void print_golden(const generated::Golden& golden) {
  std::ifstream file(std::string(WATERTIGHT_GOLDEN_BLOBS) + "/" + golden.name + ".blob",
                     std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  print("golden file " + golden.name, bytes);
  print("golden encoded " + golden.name, generated::encode_golden(golden));
  const auto decoded = decode(bytes);
  auto boundary =
      decoded ? OrientedBoundary::make(decoded->solid) : Result<OrientedBoundary>(decoded.error());
  if (boundary) {
    std::printf("golden decoded %s %016" PRIx64 "\n", golden.name.c_str(), solid_hash(*boundary));
  } else {
    std::printf("golden decoded %s %s\n", golden.name.c_str(), to_string(boundary.error()).c_str());
  }
}

}  // namespace

int main() {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const auto& [name, boundary] : generated::all(seed)) {
      print_modes(std::to_string(seed) + " " + name, boundary);
    }
  }
  const Certificate certificate = generated::schoenhardt_certificate();
  print("schoenhardt with Steiner vertex",
        encode_boundary(generated::schoenhardt(), {},
                        {.mode = Mode::bitmap, .certificate = &certificate}));
  for (const auto& golden : generated::goldens()) print_golden(golden);
  return 0;
}
