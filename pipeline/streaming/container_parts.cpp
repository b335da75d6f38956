// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/streaming/container_parts.h"

#include <map>
#include <utility>

#include "pipeline/container.h"
#include "pipeline/file/whole_model.h"

namespace watertight::pipeline {
namespace {

/// The solids and instances of a city model's feature as a reader of its text finds them. A stored
/// solid does not say where in the text it stands.
Result<Feature> read_again(const formats::CityHeader& header, Feature feature,
                           const Limits& limits) {
  const auto line = formats::write_city_json_feature(header, feature);
  if (!line) return line.error();
  formats::ReadOptions options;
  options.limits = limits;
  auto read = formats::read_city_json_feature(header, *line, options);
  if (!read) return std::move(read).error();
  if (read->solids.size() != feature.solids.size()) {
    return Error{ErrorCode::malformed,
                 "feature '" + feature.id + "' has other solids than its text"};
  }
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    // Texts of contract lattice and boundary number the vertices in another order.
    Solid stored = std::move(feature.solids[i].solid);
    const bool is_same_order = stored == read->solids[i].solid;
    SubmittedSolid& found = read->solids[i];
    feature.solids[i] = is_same_order ? std::move(found)
                                      : SubmittedSolid{std::move(stored), std::move(found.source)};
  }
  feature.instances = std::move(read->instances);
  feature.unreadable = std::move(read->unreadable);
  return feature;
}

}  // namespace

Result<ContainerParts> ContainerParts::open(ByteView bytes, const Limits& limits,
                                            WholeModels models) {
  auto file = ContainerFile::open(bytes, limits);
  if (!file) return std::move(file).error();
  ContainerParts parts(*std::move(file), limits, models);
  for (const BlockDocument& document : parts.file_.documents()) {
    if (Status added = parts.add(document); !added) return std::move(added).error();
  }
  return parts;
}

Status ContainerParts::add(const BlockDocument& added) {
  const auto format = formats::format_named(added.format);
  if (!format) return format.error();
  Shared& shared = documents_.emplace_back();
  shared.document.format = *format;
  shared.document.header = added.header;
  const bool is_city_model = *format == Format::city_json || *format == Format::city_json_seq;
  if (!is_city_model || shared.document.header.empty()) return Done{};
  auto header = formats::read_city_json_header(shared.document.header, limits_);
  if (!header) return std::move(header).error();
  auto templates = formats::read_geometry_templates(*header, limits_);
  if (!templates) return std::move(templates).error();
  shared.document.templates = std::move(templates->solids);
  shared.header = *std::move(header);
  return Done{};
}

/// The features of a CityJSON as a whole.
Result<Document> ContainerParts::split(const formats::CityHeader& header,
                                       const Feature& model) const {
  if (models_ == WholeModels::split) return split_model(header, model, limits_);
  return Error{ErrorCode::unsupported,
               "the file holds a CityJSON as a whole, not its features: decode it, and use the "
               "CityJSON"};
}

Result<std::optional<std::vector<Document>>> ContainerParts::next() {
  if (next_ == file_.block_count()) return std::optional<std::vector<Document>>();
  auto block = file_.block(next_++);
  if (!block) return std::move(block).error();
  std::map<std::uint64_t, Document> found;
  for (ReadFeature& feature : block->features) {
    const std::uint64_t number = feature.document;
    const Shared& shared = documents_[number];
    auto complete = restored(std::move(feature), limits_);
    if (complete && shared.header && is_whole_model(*complete)) {
      auto model = split(*shared.header, *complete);
      if (!model) return std::move(model).error();
      found.insert_or_assign(number, *std::move(model));
      continue;
    }
    if (complete && shared.header) {
      complete = read_again(*shared.header, *std::move(complete), limits_);
    }
    if (!complete) return std::move(complete).error();
    auto [document, is_new] = found.try_emplace(number);
    if (is_new) document->second = shared.document;
    document->second.features.push_back(*std::move(complete));
  }
  std::vector<Document> documents;
  for (auto& [number, document] : found) documents.push_back(std::move(document));
  return std::optional(std::move(documents));
}

}  // namespace watertight::pipeline
