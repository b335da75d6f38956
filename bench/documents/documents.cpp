// SPDX-License-Identifier: GPL-3.0-or-later
//
// documents [--texts] FILE...: reads each city model with its text, writes it again and compares
// the bytes; then encodes what is valid and does the same through a Watertight file. One line of
// Markdown per file.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "formats/packed_text.h"
#include "pipeline/container.h"

using namespace watertight;

namespace {

struct Sizes {
  std::size_t layout = 0;     // how the text was written
  std::size_t texts = 0;      // skeletons
  std::size_t alone = 0;      // skeletons, each compressed alone as in a store
  std::size_t together = 0;   // skeletons compressed as one text
  std::size_t container = 0;  // the Watertight file; 0 when not all solids are valid
  std::size_t blobs = 0;
  std::size_t order = 0;  // order sections
  std::size_t solids = 0;
};

bool is_same(const Document& document, const std::string& text) {
  const auto written = write_document(document, document.format);
  return written && as_text(*written) == text;
}

void add_texts(const Document& document, Sizes& sizes) {
  std::string all;
  for (const Feature& feature : document.features) {
    std::string skeleton = feature.skeleton + '\n';
    skeleton += as_text(feature.layout);
    const auto packed = pack_text(skeleton);
    if (packed) sizes.alone += packed->size();
    sizes.texts += skeleton.size();
    sizes.layout += feature.layout.size();
    all += skeleton;
  }
  const auto packed = pack_text(all);
  if (packed) sizes.together = packed->size();
}

void add_blobs(const StoredDocument& document, Sizes& sizes) {
  for (const StoredFeature& feature : document.features) {
    for (const StoredSolid& solid : feature.solids) {
      ++sizes.solids;
      sizes.blobs += solid.blob.size();
      const auto info = describe(solid.blob);
      if (!info) continue;
      for (const BlobInfo::Part& part : info->parts) {
        if (part.name == "order") sizes.order += part.bytes;
      }
    }
  }
}

/// "yes", "no", or why there is no Watertight file.
std::string through_container(Document document, const std::string& text, EngineWorkers& workers,
                              Sizes& sizes) {
  auto encoded = encode_document(std::move(document), &workers, {});
  if (!encoded) return "no: " + to_string(encoded.error());
  if (encoded->outcome.verdict != Verdict::valid) return "not valid";
  add_blobs(encoded->document, sizes);
  const auto container = write_container(encoded->document);
  if (!container) return "no: " + to_string(container.error());
  sizes.container = container->size();
  const auto decoded = decode_container(*container);
  if (!decoded) return "no: " + to_string(decoded.error());
  return is_same(*decoded, text) ? "yes" : "no";
}

}  // namespace

int main(int argc, char** argv) {
  int failures = 0;
  EngineWorkers workers(EngineWorkers::Options{{}, {}, 1});
  std::printf(
      "| file | bytes | same text | same by file | layout | skeletons | alone | together | "
      "file bytes | blobs | order | solids |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const bool texts_only = argc > 1 && std::string_view(argv[1]) == "--texts";
  for (int i = texts_only ? 2 : 1; i < argc; ++i) {
    const std::string name = argv[i];
    std::ifstream stream(name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto format = detect_format(name, as_bytes(text));
    ReadOptions options;
    options.split_features = false;
    options.keep_text = true;
    auto document =
        format ? read_document(as_bytes(text), *format, options) : Result<Document>(format.error());
    const std::string file = std::filesystem::path(name).filename().string();
    if (!document) {
      std::printf("| %s | %zu | refused: %s |\n", file.c_str(), text.size(),
                  std::string(to_string(document.error().code)).c_str());
      continue;
    }
    Sizes sizes;
    add_texts(*document, sizes);
    const bool same_text = is_same(*document, text);
    const std::string same_file =
        texts_only ? "" : through_container(*std::move(document), text, workers, sizes);
    if (!same_text || same_file.starts_with("no:") || same_file == "no") ++failures;
    std::printf("| %s | %zu | %s | %s | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu |\n",
                file.c_str(), text.size(), same_text ? "yes" : "NO", same_file.c_str(),
                sizes.layout, sizes.texts, sizes.alone, sizes.together, sizes.container,
                sizes.blobs, sizes.order, sizes.solids);
    std::fflush(stdout);
  }
  return failures == 0 ? 0 : 1;
}
