// SPDX-License-Identifier: GPL-3.0-or-later
//
// documents [--texts] FILE...: reads each city model with its text, writes it again and compares
// the bytes; then encodes the valid solids, and compares the bytes after a Watertight file. Prints
// one line of Markdown for each file.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "codec/page/source_order.h"
#include "formats/text/packed_text.h"
#include "pipeline/container.h"

using namespace watertight;

namespace {

struct Sizes {
  std::size_t layout = 0;     // the layouts: how the texts were written
  std::size_t texts = 0;      // the skeletons
  std::size_t alone = 0;      // the skeletons, each compressed alone as in a store
  std::size_t together = 0;   // the skeletons, compressed as one text
  std::size_t container = 0;  // the Watertight file; 0 if not all solids are valid
  std::size_t paged = 0;      // the solids of the Watertight file, in pages
  std::size_t blobs = 0;
  double order = 0;  // the source orders in the blobs, in bytes
  std::size_t solids = 0;
  std::size_t closed = 0;           // the number of solids whose order was measured
  std::uint64_t order_alone = 0;    // with a neutral bank for each solid, 1/65536 bit
  std::uint64_t order_in_page = 0;  // with a bank for 128 solids, 1/65536 bit
};

bool is_same(const Document& document, const std::string& text) {
  const auto written = formats::write_document(document, document.format);
  return written && as_text(*written) == text;
}

void add_texts(const Document& document, Sizes& sizes) {
  std::string all;
  for (const Feature& feature : document.features) {
    std::string skeleton = feature.skeleton + '\n';
    skeleton += as_text(feature.layout);
    const auto packed = formats::pack_text(skeleton);
    if (packed) sizes.alone += packed->bytes.size();
    sizes.texts += skeleton.size();
    sizes.layout += feature.layout.size();
    all += skeleton;
  }
  const auto packed = formats::pack_text(all);
  if (packed) sizes.together = packed->bytes.size();
}

void add_blobs(const pipeline::EncodedDocument& document, Sizes& sizes) {
  for (const pipeline::EncodedFeature& feature : document.features) {
    for (const StoredSolid& solid : feature.solids) {
      ++sizes.solids;
      sizes.blobs += solid.blob.size();
      const auto info = codec::describe(solid.blob);
      if (!info) continue;
      for (const codec::BlobInfo::Part& part : info->parts) {
        if (part.name == "order") sizes.order += part.bytes;
      }
    }
  }
}

/// Adds the measured source order of every closed solid.
void add_orders(const Document& document, Sizes& sizes) {
  constexpr std::size_t kPage = 128;
  const codec::ModelLayout& layout = codec::order_layout();
  codec::ModelBank page(layout);
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& submitted : feature.solids) {
      auto boundary = OrientedBoundary::make(geometry::merge_equal_vertices(submitted.solid).solid);
      if (!boundary) continue;
      geometry::CanonicalSolid canonical = geometry::canonical_form(*boundary);
      const Solid& solid = canonical.boundary.solid();
      codec::ModelBank neutral(layout);
      codec::EntropyStream alone = codec::EntropyStream::meter();
      codec::code_order(alone, neutral, solid, canonical.order);
      sizes.order_alone += alone.cost();
      if (sizes.closed++ % kPage == 0) page = codec::ModelBank(layout);
      codec::EntropyStream in_page = codec::EntropyStream::meter();
      codec::code_order(in_page, page, solid, canonical.order);
      sizes.order_in_page += in_page.cost();
    }
  }
}

double bytes_each(std::uint64_t cost, std::size_t count) {
  return count == 0 ? 0 : static_cast<double>(cost) / 65536 / 8 / static_cast<double>(count);
}

/// "yes", "no", or the reason why there is no Watertight file.
std::string through_container(Document document, const std::string& text,
                              delaunay::EngineWorkers& workers, Sizes& sizes) {
  auto encoded = pipeline::encode_document(std::move(document), &workers, {});
  if (!encoded) return "no: " + to_string(encoded.error());
  if (encoded->outcome.verdict != Verdict::valid) return "not valid";
  add_blobs(encoded->document, sizes);
  const auto container = pipeline::write_container(encoded->document);
  if (!container) return "no: " + to_string(container.error());
  sizes.container = container->size();
  const auto info = pipeline::describe_container(*container);
  if (info) sizes.paged = info->solid_bytes;
  const auto decoded = pipeline::decode_container(*container);
  if (!decoded) return "no: " + to_string(decoded.error());
  return decoded->size() == 1 && is_same(decoded->front(), text) ? "yes" : "no";
}

}  // namespace

int main(int argc, char** argv) {
  int failures = 0;
  delaunay::EngineWorkers workers(delaunay::EngineWorkers::Options{{}, {}, 1});
  std::printf(
      "| file | bytes | same text | same by file | layout | skeletons | alone | together | "
      "file bytes | paged | blobs | order | solids "
      "| closed | order alone | in pages "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const bool texts_only = argc > 1 && std::string_view(argv[1]) == "--texts";
  for (int i = texts_only ? 2 : 1; i < argc; ++i) {
    const std::string name = argv[i];
    std::ifstream stream(name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto format = formats::detect_format(name, as_bytes(text));
    formats::ReadOptions options;
    options.split_features = false;
    options.keep_text = true;
    auto document = format ? formats::read_document(as_bytes(text), *format, options)
                           : Result<Document>(format.error());
    const std::string file = std::filesystem::path(name).filename().string();
    if (!document) {
      std::printf("| %s | %zu | refused: %s |\n", file.c_str(), text.size(),
                  std::string(to_string(document.error().code)).c_str());
      continue;
    }
    Sizes sizes;
    add_texts(*document, sizes);
    add_orders(*document, sizes);
    const bool same_text = is_same(*document, text);
    const std::string same_file =
        texts_only ? "" : through_container(*std::move(document), text, workers, sizes);
    if (!same_text || same_file.starts_with("no:") || same_file == "no") ++failures;
    std::printf(
        "| %s | %zu | %s | %s | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %.0f | %zu "
        "| %zu | %.2f | %.2f |\n",
        file.c_str(), text.size(), same_text ? "yes" : "NO", same_file.c_str(), sizes.layout,
        sizes.texts, sizes.alone, sizes.together, sizes.container, sizes.paged, sizes.blobs,
        sizes.order, sizes.solids, sizes.closed, bytes_each(sizes.order_alone, sizes.closed),
        bytes_each(sizes.order_in_page, sizes.closed));
    std::fflush(stdout);
  }
  return failures == 0 ? 0 : 1;
}
