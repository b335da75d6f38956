// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/container.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "pipeline/stored/solid_lines.h"
#include "store/rows/place.h"

namespace watertight::pipeline {
namespace {

/// Features of one document on their way back into its order.
struct Ordered {
  std::vector<std::pair<std::uint64_t, Feature>> numbered;
  std::vector<Feature> others;  // after those with numbers

  std::vector<Feature> take() {
    std::stable_sort(numbered.begin(), numbered.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Feature> features;
    for (auto& [number, feature] : numbered) features.push_back(std::move(feature));
    for (Feature& feature : others) features.push_back(std::move(feature));
    return features;
  }
};

/// Lists the solids that are not proven, and those that were repaired. Errors: malformed.
Status list_solids(const EncodedFeature& feature, ContainerInfo& info) {
  if (!feature.is_proven()) ++info.unproven_features;
  std::string_view skeleton = feature.skeleton;
  const auto lines = take_solid_lines(skeleton, feature.solids.size());
  if (!lines) return lines.error();
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    const StoredSolid& solid = feature.solids[i];
    const auto noted = [&](std::string_view note) {
      return NotedSolid{feature.id,     solid.object_id, solid.lod,
                        solid.geometry, solid.ordinal,   std::string(note)};
    };
    if (!solid.is_proven) info.unproven.push_back(noted(solid.report));
    const std::string_view repair = (*lines)[i].repaired;
    if (!repair.empty()) info.repaired.push_back(noted(repair));
  }
  return Done{};
}

Status count_feature(const ReadFeature& feature, ContainerInfo& info) {
  info.solids += feature.encoded.solids.size();
  for (const auto& [type, count] : other_geometries(feature.encoded)) {
    info.other_geometries[type] += count;
  }
  for (const Decoded& decoded : feature.solids) {
    for (const codec::BlobInfo::Part& part : decoded.info.parts) {
      info.parts[part.name] += part.bytes;
    }
  }
  return list_solids(feature.encoded, info);
}

}  // namespace

std::vector<std::size_t> order_of_places(const std::vector<EncodedFeature>& features) {
  std::vector<std::int64_t> places;
  for (const EncodedFeature& feature : features) {
    places.push_back(store::place_number(feature.box));
  }
  std::vector<std::size_t> order(features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&places](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  return order;
}

Result<Bytes> write_container(const EncodedDocument& document, const ContainerOptions& options) {
  ContainerWriter writer(options);
  writer.add_document(document.format, document.header, document.framing);
  for (const EncodedFeature& feature : document.features) {
    if (feature.format == document.format && feature.header == document.header) continue;
    return Error{ErrorCode::invalid_argument, "the features are of several documents"};
  }
  if (options.purpose == FilePurpose::size) {
    for (const EncodedFeature& feature : document.features) {
      if (Status added = writer.add(feature); !added) return added.error();
    }
    return std::move(writer).finish();
  }
  for (const std::size_t i : order_of_places(document.features)) {
    if (Status added = writer.add(document.features[i], i); !added) return added.error();
  }
  return std::move(writer).finish();
}

Result<Feature> restored(ReadFeature feature, const Limits& limits) {
  std::vector<Solid> solids;
  for (Decoded& decoded : feature.solids) solids.push_back(std::move(decoded.solid));
  auto document = decode_feature(feature.encoded, std::move(solids), limits);
  if (!document) return std::move(document).error();
  return std::move(document->features.front());
}

Result<std::vector<Document>> decode_container(ByteView bytes, const Limits& limits) {
  auto file = ContainerFile::open(bytes, limits);
  if (!file) return std::move(file).error();
  return decode_container(*file, limits);
}

Result<std::vector<Document>> decode_container(ContainerFile& file, const Limits& limits,
                                               unsigned threads) {
  std::vector<Document> documents;
  for (const BlockDocument& shared : file.documents()) {
    const auto format = formats::format_named(shared.format);
    if (!format) return format.error();
    Document& document = documents.emplace_back();
    document.format = *format;
    document.header = shared.header;
    document.framing = shared.framing;
  }
  std::vector<Ordered> ordered(documents.size());
  for (std::uint64_t i = 0; i < file.block_count(); ++i) {
    if (threads > 1 && i % threads == 0) file.read_ahead(i, threads);
    auto block = file.block(i);
    if (!block) return std::move(block).error();
    for (ReadFeature& feature : block->features) {
      Ordered& of_document = ordered[feature.document];
      const std::uint64_t number = feature.number;
      auto whole = restored(std::move(feature), limits);
      if (!whole) return std::move(whole).error();
      if (block->has_numbers) {
        of_document.numbered.emplace_back(number, *std::move(whole));
      } else {
        of_document.others.push_back(*std::move(whole));
      }
    }
  }
  for (std::size_t i = 0; i < documents.size(); ++i) documents[i].features = ordered[i].take();
  return documents;
}

Result<ContainerInfo> describe_container(ByteView bytes, const Limits& limits) {
  auto file = ContainerFile::open(bytes, limits);
  if (!file) return std::move(file).error();
  return describe_container(*file);
}

Result<ContainerInfo> describe_container(ContainerFile& file) {
  ContainerInfo info;
  info.deleted = file.deleted().size();
  for (const BlockDocument& document : file.documents()) {
    const auto format = formats::format_named(document.format);
    if (!format) return format.error();
    info.formats.push_back(*format);
  }
  for (std::uint64_t i = 0; i < file.block_count(); ++i) {
    const auto block = file.block(i);
    if (!block) return block.error();
    auto entry = file.entry(i);
    if (!entry) return std::move(entry).error();
    entry->features = block->features.size();
    info.blocks.push_back(*std::move(entry));
    info.features += block->features.size();
    info.pages += block->pages;
    info.solid_bytes += block->solid_bytes;
    for (const ReadFeature& feature : block->features) {
      if (const Status counted = count_feature(feature, info); !counted) return counted.error();
    }
  }
  return info;
}

}  // namespace watertight::pipeline
