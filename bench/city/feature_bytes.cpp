// SPDX-License-Identifier: GPL-3.0-or-later
//
// feature_bytes FILE...: measures what the text and the solids of features of city models take in a
// store. Solids: as blobs, and as a page of the solids of a feature where that is smaller, with the
// times to decode and to encode them. Texts: packed with examples of every other feature, for the
// features in whose half the examples are and for those of the other half.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "codec/page.h"
#include "packing/text_dictionary.h"
#include "pipeline/pipeline.h"

using namespace watertight;

namespace {

using Clock = std::chrono::steady_clock;
using Texts = std::vector<std::string>;

constexpr int kRepeats = 5;

/// The milliseconds of a call, the least of some.
double milliseconds(int repeats, const std::function<void()>& call) {
  double least = 1e9;
  for (int i = 0; i < repeats; ++i) {
    const auto start = Clock::now();
    call();
    least =
        std::min(least, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return least;
}

Texts every_other(const Texts& texts, std::size_t first) {
  Texts chosen;
  for (std::size_t i = first; i < texts.size(); i += 2) chosen.push_back(texts[i]);
  return chosen;
}

double packed_bytes(const Texts& texts, const packing::TextDictionary* dictionary) {
  double bytes = 0;
  for (const std::string& text : texts) {
    bytes += static_cast<double>(packing::pack(text, dictionary)->size());
  }
  return bytes;
}

double unpack_time(const Texts& texts, const packing::TextDictionary* dictionary) {
  std::vector<Bytes> packed;
  for (const std::string& text : texts) packed.push_back(*packing::pack(text, dictionary));
  return milliseconds(1, [&] {
    for (const Bytes& one : packed) {
      static_cast<void>(packing::unpack(one, dictionary, ~std::uint64_t{0}));
    }
  });
}

void measure_texts(const char* name, const Texts& all) {
  const double number = static_cast<double>(all.size());
  const Texts halves[2] = {every_other(all, 0), every_other(all, 1)};
  std::printf(
      "| %s: examples | dictionary | own half | other half | unpack, ms |\n|---|---|---|---|---|\n",
      name);
  for (const std::uint64_t expected : {0, 100, 1000, 10'000, 100'000}) {
    std::size_t dictionary_bytes = 0;
    double own = 0;
    double other = 0;
    double unpack = 0;
    for (const int half : {0, 1}) {
      const auto dictionary = packing::best_dictionary(halves[half], expected);
      if (!dictionary) return;
      if (*dictionary) dictionary_bytes += (*dictionary)->content().size() / 2;
      own += packed_bytes(halves[half], dictionary->get());
      other += packed_bytes(halves[1 - half], dictionary->get());
      unpack += unpack_time(halves[1 - half], dictionary->get());
    }
    std::printf("| for %llu features | %zu | %.0f | %.0f | %.2f |\n",
                static_cast<unsigned long long>(expected), dictionary_bytes, own / number,
                other / number, unpack / number);
  }
}

void measure_solids(const std::vector<pipeline::EncodedFeature>& features) {
  std::size_t solids = 0;
  std::size_t paged = 0;
  double blobs = 0;
  double stored = 0;
  double times[4] = {};  // decode blobs, decode as stored, page, blob of a page
  for (const pipeline::EncodedFeature& feature : features) {
    std::vector<ByteView> views;
    double own = 0;
    for (const StoredSolid& solid : feature.solids) {
      if (solid.is_proven) views.push_back(solid.blob);
      own += static_cast<double>(solid.blob.size());
    }
    solids += views.size();
    blobs += own;
    store::FeatureRecord record = feature;
    const double as_blobs =
        milliseconds(kRepeats, [&] { static_cast<void>(pipeline::decode_solids(record)); });
    times[0] += as_blobs;
    std::optional<Bytes> page;
    times[2] += milliseconds(1, [&] { page = *codec::page_of_blobs(views); });
    if (!page) {
      stored += own;
      times[1] += as_blobs;
      continue;
    }
    ++paged;
    stored += static_cast<double>(page->size());
    record.page = *page;
    for (StoredSolid& solid : record.solids) solid.blob.clear();
    times[1] += milliseconds(kRepeats, [&] { static_cast<void>(pipeline::decode_solids(record)); });
    std::size_t first = 0;
    while (!record.solids[first].is_proven) ++first;
    times[3] += milliseconds(1, [&] { static_cast<void>(pipeline::blob_of(record, first)); });
  }
  const double number = static_cast<double>(features.size());
  std::printf(
      "%zu proven solids, %zu features with a page; bytes a feature: blobs %.1f, stored %.1f\n",
      solids, paged, blobs / number, stored / number);
  std::printf(
      "ms a feature: decode %.3f as blobs, %.3f as stored; page %.2f; one blob of a page %.2f\n\n",
      times[0] / number, times[1] / number, times[2] / number,
      paged == 0 ? 0 : times[3] / static_cast<double>(paged));
}

}  // namespace

int main(int argc, char** argv) {
  delaunay::EngineWorkers workers(delaunay::EngineWorkers::Options{{}, {}, 1});
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    std::ifstream file(name, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const Format format = name.ends_with(".jsonl") ? Format::city_json_seq : Format::city_json;
    auto document = formats::read_document(as_bytes(text), format);
    if (!document) return 1;
    pipeline::IngestOptions options;
    options.policy = pipeline::Policy::keep;
    const auto encoded = pipeline::encode_document(*std::move(document), &workers, options);
    if (!encoded) return 1;
    const auto& features = encoded->document.features;
    std::printf("## %s: %zu features\n\n", name.c_str(), features.size());
    measure_solids(features);
    Texts all;
    Texts proven;
    for (const pipeline::EncodedFeature& feature : features) {
      all.push_back(pipeline::stored_text(feature));
      if (feature.is_proven()) proven.push_back(all.back());
    }
    measure_texts("all texts", all);
    measure_texts("texts of proven features", proven);
    std::printf("\n");
  }
  return 0;
}
