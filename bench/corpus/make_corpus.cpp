// SPDX-License-Identifier: GPL-3.0-or-later
//
// make_corpus OUT FILE...: writes the solids of the files that pass the exact tests, as one corpus.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "bench/corpus/corpus.h"
#include "bench/input.h"
#include "validate/certify.h"

using namespace watertight;

namespace {

/// The solid if it is valid: by the exact tests alone, or by the DT if it has several shells.
std::optional<ValidSolid> valid_solid(const Solid& solid) {
  for (const Proof proof : {Proof::boundary, Proof::tetrahedralization}) {
    CertifyOptions options;
    options.proof = proof;
    Inspection inspection = certify(solid, nullptr, options);
    if (inspection.certified) return inspection.certified->solid;
  }
  return std::nullopt;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: make_corpus OUT FILE...\n");
    return 2;
  }
  std::ofstream out(arguments[1], std::ios::binary);
  for (int i = 2; i < count; ++i) {
    const std::string name = std::filesystem::path(arguments[i]).filename().string();
    const auto document = bench::read_file(arguments[i]);
    if (!document) {
      std::fprintf(stderr, "%s: %s\n", arguments[i], to_string(document.error()).c_str());
      continue;
    }
    std::size_t all = 0;
    std::size_t valid = 0;
    for (const Feature& feature : document->features) {
      for (const SubmittedSolid& submitted : feature.solids) {
        ++all;
        const auto solid = valid_solid(submitted.solid);
        if (!solid) continue;
        ++valid;
        const Bytes record = write_corpus_record(name.substr(0, name.find('.')), *solid);
        out.write(as_text(record).data(), static_cast<std::streamsize>(record.size()));
      }
    }
    std::printf("%s: %zu of %zu solids\n", name.c_str(), valid, all);
  }
  return out.good() ? 0 : 1;
}
