// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints a hash of every blob of a fixed set: generated solids in every mode with every set of
// priors, alone and in pages, and the golden files, decoded and encoded again.
#include <cinttypes>
#include <cstdio>

#include "base/checksum.h"
#include "codec/encode_boundary.h"
#include "geometry/canonical_form.h"
#include "tests/builds/fingerprint.h"
#include "tests/generated/generated_solids.h"
#include "tests/files.h"
#include "tests/generated/golden_blobs.h"

namespace watertight::builds {
namespace {

void print(const std::string& name, const Result<Bytes>& blob) {
  if (!blob) {
    std::printf("%s %s\n", name.c_str(), to_string(blob.error()).c_str());
    return;
  }
  std::printf("%s %zu %016" PRIx64 "\n", name.c_str(), blob->size(), content_hash(*blob));
}

constexpr Mode kModes[] = {Mode::raw,     Mode::bitmap,        Mode::walk,
                           Mode::polygon, Mode::parallelogram, Mode::automatic};
static_assert(codec::kModelNumber <= 1);
constexpr std::uint8_t kModels[] = {0, 1};

std::string label(const std::string& name, const EncodeOptions& options) {
  return name + " " + std::string(codec::to_string(options.mode)) + " " +
         std::to_string(options.models);
}

void print_modes(const std::string& name, const OrientedBoundary& boundary) {
  for (const Mode mode : kModes) {
    for (const std::uint8_t models : kModels) {
      const EncodeOptions options{.mode = mode, .models = models};
      print(label(name, options), codec::encode_boundary(boundary, {}, options));
    }
  }
}

/// Prints the hash of a page of all solids that may stand beside the first and that the mode can
/// hold.
void print_page(const std::string& name, const std::vector<generated::NamedBoundary>& solids,
                const EncodeOptions& options) {
  const OrientedBoundary* first = &solids.front().boundary;
  std::vector<const OrientedBoundary*> page;
  for (const auto& [solid, boundary] : solids) {
    const std::vector<const OrientedBoundary*> both{first, &boundary};
    if (!codec::encode_boundaries(both, {}, {.mode = Mode::raw})) continue;
    if (codec::encode_boundary(boundary, {}, options)) page.push_back(&boundary);
  }
  if (!page.empty()) print(label(name, options), codec::encode_boundaries(page, {}, options));
}

void print_pages(const std::string& name, const std::vector<generated::NamedBoundary>& solids) {
  for (const Mode mode : kModes) {
    for (const std::uint8_t models : kModels) {
      print_page(name, solids, {.mode = mode, .keep_order = models == 0, .models = models});
    }
  }
}

void print_golden(const std::string& version, const std::string& name) {
  const Bytes bytes =
      test::read_bytes(test::source_path("tests/golden/blobs/") + version + "/" + name + ".blob");
  print(version + " file " + name, bytes);
  const auto decoded = decode(bytes);
  auto boundary =
      decoded ? OrientedBoundary::make(decoded->solid) : Result<OrientedBoundary>(decoded.error());
  const std::string what = boundary ? std::string() : to_string(boundary.error());
  std::printf("%s decoded %s %016" PRIx64 " %s\n", version.c_str(), name.c_str(),
              boundary ? geometry::solid_hash(*boundary) : 0, what.c_str());
}

}  // namespace

void print_blob_hashes() {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto solids = generated::all(seed);
    for (const auto& [name, boundary] : solids) {
      print_modes(std::to_string(seed) + " " + name, boundary);
    }
    print_pages(std::to_string(seed) + " page", solids);
  }
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  print("schoenhardt with Steiner vertex",
        codec::encode_boundary(generated::schoenhardt(), {},
                               {.mode = Mode::bitmap, .certificate = &certificate}));
  for (const auto& golden : generated::goldens()) {
    print_golden("version-1", golden.name);
    print("version-1 encoded " + golden.name, generated::encode_golden(golden));
  }
}

}  // namespace watertight::builds
