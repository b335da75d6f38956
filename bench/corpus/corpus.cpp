// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/corpus/corpus.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>

#include "codec/blob.h"

namespace watertight {
namespace {

[[noreturn]] void give_up(const std::string& path, const std::string& reason) {
  std::fprintf(stderr, "%s: %s\n", path.c_str(), reason.c_str());
  std::exit(2);
}

}  // namespace

Bytes write_corpus_record(const std::string& set, const ValidSolid& solid) {
  EncodeOptions options;
  options.mode = Mode::raw;
  options.models = 0;
  const auto blob = encode(solid, options);
  if (!blob) give_up(set, to_string(blob.error()));
  ByteWriter writer;
  writer.varint(set.size());
  writer.append(as_bytes(set));
  writer.varint(blob->size());
  writer.append(*blob);
  return std::move(writer).bytes();
}

std::vector<CorpusSolid> read_corpus(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) give_up(path, "cannot be read");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  ByteReader reader(as_bytes(text));
  std::vector<CorpusSolid> solids;
  while (reader.remaining() > 0) {
    const std::string set(as_text(reader.take(reader.varint())));
    const auto decoded = decode(reader.take(reader.varint()));
    if (reader.failed() || !decoded) give_up(path, "is no corpus of this version");
    auto boundary = OrientedBoundary::make(decoded->solid);
    if (!boundary) give_up(path, to_string(boundary.error()));
    geometry::CanonicalSolid canonical = geometry::canonical_form(*boundary);
    solids.push_back(CorpusSolid{set, decoded->info.acceptance, std::move(boundary).value(),
                                 std::move(canonical)});
  }
  return solids;
}

}  // namespace watertight
