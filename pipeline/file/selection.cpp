// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file/selection.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "pipeline/container.h"
#include "pipeline/file/whole_model.h"
#include "pipeline/stored/feature_facts.h"

namespace watertight::pipeline {
namespace {

bool meets(const store::StoredBox& a, const store::StoredBox& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
  }
  return true;
}

/// The features that a selection takes, by what is encoded of them.
class Choice {
 public:
  virtual ~Choice() = default;
  /// Errors: those of box_of().
  virtual Result<bool> takes(const EncodedFeature& feature, std::span<const Decoded> solids) = 0;
};

class ChoiceOfIds final : public Choice {
 public:
  explicit ChoiceOfIds(const std::vector<std::string>& ids) : wanted_(ids.begin(), ids.end()) {}
  Result<bool> takes(const EncodedFeature& feature, std::span<const Decoded> /*solids*/) override {
    bool is_wanted = false;
    for (const std::string& id : ids_of(feature)) {
      if (!wanted_.contains(id)) continue;
      found_.insert(id);
      is_wanted = true;
    }
    return is_wanted;
  }
  bool has_found(const std::string& id) const { return found_.contains(id); }

 private:
  std::set<std::string> wanted_;
  std::set<std::string> found_;
};

class ChoiceOfBox final : public Choice {
 public:
  ChoiceOfBox(const store::StoredBox& box, const Limits& limits) : box_(box), limits_(limits) {}
  Result<bool> takes(const EncodedFeature& feature, std::span<const Decoded> solids) override {
    const auto box = box_of(feature, solids, limits_);
    if (!box) return box.error();
    return *box && meets(**box, box_);
  }

 private:
  store::StoredBox box_;
  Limits limits_;
};

/// A feature as encode_feature() would give it, for a choice: without blobs.
Result<ReadFeature> described(const Document& document, Feature& feature) {
  ReadFeature read;
  read.encoded.id = feature.id;
  read.encoded.skeleton = feature.skeleton;
  for (SubmittedSolid& submitted : feature.solids) {
    StoredSolid& solid = read.encoded.solids.emplace_back();
    solid.object_id = submitted.source.object_id;
    read.solids.push_back({submitted.solid, {}});
  }
  read.encoded.header = document.header;
  return read;
}

class Selector {
 public:
  Selector(ContainerFile& file, Choice& choice, const Limits& limits)
      : file_(file), choice_(choice), limits_(limits) {}

  Status read(const std::vector<std::uint64_t>& blocks) {
    for (const std::uint64_t number : blocks) {
      auto block = file_.block(number);
      if (!block) return std::move(block).error();
      for (ReadFeature& feature : block->features) {
        if (Status added = add(std::move(feature)); !added) return added;
      }
    }
    return Done{};
  }

  std::vector<Document> take() {
    std::vector<Document> documents;
    for (auto& [number, document] : found_) documents.push_back(std::move(document));
    return documents;
  }

 private:
  Status add(ReadFeature feature) {
    const auto is_taken = choice_.takes(feature.encoded, feature.solids);
    if (!is_taken) return is_taken.error();
    if (!*is_taken) return Done{};
    const std::uint64_t number = feature.document;
    const std::string format_name = feature.encoded.format;
    const SharedText header = feature.encoded.header;
    auto whole = restored(std::move(feature), limits_);
    if (!whole) return std::move(whole).error();
    const auto format = formats::format_named(format_name);
    if (!format) return format.error();
    const auto [document, is_new] = found_.try_emplace(number);
    if (is_new) {
      document->second.format = *format;
      document->second.header = header;
    }
    if (is_whole_model(*whole)) return add_of_model(*whole, document->second);
    document->second.features.push_back(*std::move(whole));
    return Done{};
  }

  Status add_of_model(const Feature& model, Document& document) {
    const auto header = formats::read_city_json_header(document.header.str(), limits_);
    if (!header) return header.error();
    auto split = split_model(*header, model, limits_);
    if (!split) return std::move(split).error();
    document.header = split->header;
    for (Feature& feature : split->features) {
      const auto read = described(*split, feature);
      if (!read) return read.error();
      const auto is_taken = choice_.takes(read->encoded, read->solids);
      if (!is_taken) return is_taken.error();
      if (*is_taken) document.features.push_back(std::move(feature));
    }
    return Done{};
  }

  ContainerFile& file_;
  Choice& choice_;
  Limits limits_;
  std::map<std::uint64_t, Document> found_;  // by the number of the document
};

Result<Selected> select(ContainerFile& file, Choice& choice,
                        const std::vector<std::uint64_t>& blocks, const Limits& limits) {
  Selector selector(file, choice, limits);
  if (Status read = selector.read(blocks); !read) return std::move(read).error();
  Selected selected;
  selected.documents = selector.take();
  std::erase_if(selected.documents,
                [](const Document& document) { return document.features.empty(); });
  selected.blocks = blocks.size();
  return selected;
}

}  // namespace

Result<Selected> select_ids(ContainerFile& file, const std::vector<std::string>& ids,
                            const Limits& limits) {
  const auto blocks = file.blocks_of(ids);
  if (!blocks) return blocks.error();
  ChoiceOfIds choice(ids);
  auto selected = select(file, choice, *blocks, limits);
  if (!selected) return selected;
  for (const std::string& id : ids) {
    if (!choice.has_found(id)) selected->missing.push_back(id);
  }
  return selected;
}

Result<Selected> select_box(ContainerFile& file, const store::StoredBox& box,
                            const Limits& limits) {
  const auto blocks = file.blocks_in(flat(box));
  if (!blocks) return blocks.error();
  ChoiceOfBox choice(box, limits);
  return select(file, choice, *blocks, limits);
}

}  // namespace watertight::pipeline
