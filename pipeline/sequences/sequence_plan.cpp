// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/sequences/sequence_plan.h"

#include <algorithm>
#include <utility>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {
namespace {

constexpr std::uint64_t kPlanBatch = 100;

Error about(const std::string& id, Error error) {
  error.message.insert(0, "feature '" + id + "': ");
  return error;
}

bool is_city_model(Format format) {
  return format == Format::city_json || format == Format::city_json_seq;
}

/// The city model of a feature: what the answer for an item of the service has.
Result<Document> city_model_of(StoredFeature feature) {
  auto document = from_stored(std::move(feature));
  if (!document || is_city_model(document->format)) return document;
  return formats::as_city_model(*document);
}

/// Adds the headers that the features without header get, each once.
Status add_made_headers(SolidStore& store, const std::string& collection,
                        std::vector<std::string>& headers, const CancelPoll& is_cancelled) {
  std::string after;
  do {
    auto batch = store.walk(collection, kPlanBatch, after);
    if (!batch) return std::move(batch).error();
    for (StoredFeature& feature : batch->features) {
      if (is_cancelled && is_cancelled()) {
        return Error{ErrorCode::cancelled, "the export was not finished"};
      }
      if (!feature.header.str().empty()) continue;
      const std::string id = feature.id;
      const auto model = city_model_of(std::move(feature));
      if (!model) return about(id, model.error());
      const std::string& header = model->header.str();
      if (std::find(headers.begin(), headers.end(), header) == headers.end()) {
        headers.push_back(header);
      }
    }
    after = std::move(batch->next);
  } while (!after.empty());
  return Done{};
}

}  // namespace

Result<SequencePlan> SequencePlan::make(SolidStore& store, const std::string& collection,
                                        const CancelPoll& is_cancelled) {
  const auto found = store.collection(collection);
  if (!found) return found.error();
  const auto documents = store.documents(collection, kMostHeaders + 1);
  if (!documents) return documents.error();
  const std::string name = "collection '" + collection + "' ";
  if (documents->empty()) return Error{ErrorCode::not_found, name + "has no features"};
  if (documents->size() > kMostHeaders) {
    return Error{ErrorCode::limit_exceeded, name + "has more than " + std::to_string(kMostHeaders) +
                                                " headers; a Watertight file (.wt) holds them"};
  }
  std::vector<std::string> headers;
  bool are_made = false;
  for (const store::StoredHeader& document : *documents) {
    are_made = are_made || document.header.empty();
    const bool is_known =
        std::find(headers.begin(), headers.end(), document.header) != headers.end();
    if (!document.header.empty() && !is_known) headers.push_back(document.header);
  }
  // The first document's header is the one that others are put under.
  const auto first = std::find(headers.begin(), headers.end(), found->header);
  if (first != headers.end()) std::rotate(headers.begin(), first, first + 1);
  if (are_made) {
    Status added = add_made_headers(store, collection, headers, is_cancelled);
    if (!added) return std::move(added).error();
  }
  auto shared = formats::merge_headers(headers);
  if (!shared) {
    Error error = std::move(shared).error();
    error.message.insert(0, name + "cannot be a sequence: ");
    return error;
  }
  SequencePlan plan;
  for (formats::SharedHeader& header : *shared) {
    for (std::size_t i = 0; i < header.members.size(); ++i) {
      const std::string& own = headers[header.members[i]];
      auto city_header = formats::read_city_json_header(own, kOwnText);
      if (!city_header) return std::move(city_header).error();
      plan.places_.emplace(own,
                           Place{plan.sequences_.size(), *std::move(city_header), header.maps[i]});
    }
    plan.sequences_.push_back({std::move(header.text), header.members.size(),
                               std::move(header.losses), std::move(header.reason)});
  }
  return plan;
}

bool SequencePlan::is_elsewhere(const store::FeatureRecord& feature, std::size_t sequence) const {
  const auto place = places_.find(feature.header.str());
  return place != places_.end() && place->second.sequence != sequence;
}

Result<PlannedLine> SequencePlan::line(StoredFeature feature) const {
  const std::string id = feature.id;
  const bool is_of_city_model = feature.format == formats::to_string(Format::city_json) ||
                                feature.format == formats::to_string(Format::city_json_seq);
  const auto model = city_model_of(std::move(feature));
  if (!model) return about(id, model.error());
  const auto place = places_.find(model->header.str());
  if (place == places_.end()) {
    return about(id, {ErrorCode::unsupported,
                      "of another document than those before, whose header the sequence does not "
                      "have: the collection has changed meanwhile"});
  }
  const Feature& written = model->features.front();
  auto text = formats::write_city_json_feature(place->second.header, written, place->second.map);
  if (!text) return about(id, text.error());
  const bool is_generic = !is_of_city_model && written.type == "GenericCityObject";
  return PlannedLine{place->second.sequence, *std::move(text), is_generic};
}

}  // namespace watertight::pipeline
