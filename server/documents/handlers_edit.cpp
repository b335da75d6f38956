// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers that change one feature: PUT of a document, PATCH of attributes.
#include <algorithm>
#include <optional>

#include "formats/attributes/patch_attributes.h"
#include "formats/city_json/city_json.h"
#include "pipeline/collections/collection_rules.h"
#include "pipeline/outcome_json.h"
#include "pipeline/streaming/ingestion.h"
#include "server/documents/rules.h"
#include "server/documents/submission.h"
#include "server/features/feature_text.h"
#include "server/features/links.h"
#include "server/items/preconditions.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

constexpr std::size_t kLongestPatch = 1 << 20;  // bytes

/// The refusal of a document that is not the one feature of an address; nothing if it is.
std::optional<Response> unless_feature(formats::FeatureReader& reader, const std::string& id) {
  for (std::size_t count = 0;; ++count) {
    auto text = reader.next();
    if (!text) return to_response(problem_of_body(text.error()));
    if (!*text && count == 1) return std::nullopt;
    if (!*text || count == 1) {
      return refuse(400, "invalid-argument",
                    "the document needs exactly one feature, that of the address");
    }
    const auto feature = reader.read(std::move(**text));
    if (!feature) return to_response(problem_of_body(feature.error()));
    if (feature->id == id) continue;
    return refuse(400, "invalid-argument",
                  "the document has the feature '" + feature->id + "', the address '" + id + "'");
  }
}

/// The answer to a change of a feature.
Response changed(const RoutedRequest& request, const pipeline::IngestOutcome& outcome,
                 bool is_new) {
  if (outcome.stored == 0) return refused_document(outcome, "nothing was stored");
  const std::string& collection = request.target.segments[1];
  const pipeline::FeatureOutcome& feature = outcome.features.front();
  Response response{is_new ? 201U : 200U,
                    std::string(kJson),
                    pipeline::outcome_json(outcome) + "\n",
                    {{"ETag", etag_of(feature.version, "cityjson")}}};
  if (is_new) {
    response.headers.push_back({"Location", base_url(request) + item_path(collection, feature.id)});
  }
  return response;
}

/// The attributes in a patch: {"properties": {...}}, as a GeoJSON Feature has them. Errors:
/// malformed, invalid_argument, limit_exceeded.
Result<std::string> patched_attributes(const std::string& body) {
  if (body.size() > kLongestPatch) {
    return Error{ErrorCode::limit_exceeded,
                 "a patch has at most " + std::to_string(kLongestPatch) + " bytes"};
  }
  if (!Json::accept(body)) return Error{ErrorCode::malformed, "the patch is no JSON"};
  const auto is_shallow = formats::merge_patch("{}", body);
  if (!is_shallow && is_shallow.error().code == ErrorCode::limit_exceeded) {
    return is_shallow.error();
  }
  const Json patch = Json::parse(body);
  const Error wrong{ErrorCode::invalid_argument,
                    "a patch of a feature is {\"properties\": {\"NAME\": VALUE or null}}"};
  if (!patch.is_object() || !patch.contains("properties")) return wrong;
  for (const auto& [name, value] : patch.items()) {
    if (name != "properties" && name != "type" && name != "id") return wrong;
  }
  if (!patch["properties"].is_object()) return wrong;
  for (const auto& [name, value] : patch["properties"].items()) {
    if (name.starts_with(pipeline::kOwnProperty)) {
      return Error{ErrorCode::invalid_argument,
                   "'" + name + "' is a fact of the service, not an attribute"};
    }
  }
  return patch["properties"].dump();
}

/// The document of a stored feature with other attributes. Its text is read again, so that findings
/// have their places in it. Errors: those of the readers and writers; not_found.
Result<Document> patched(StoredFeature stored, const std::string& patch, const Limits& limits) {
  const std::string id = stored.id;
  const auto document = pipeline::from_stored(std::move(stored), limits);
  if (!document) return document.error();
  const auto text = formats::write_feature(*document, document->features.front());
  if (!text) return text.error();
  auto changed_text = formats::patch_attributes(*text, id, patch);
  if (!changed_text) return std::move(changed_text).error();
  formats::ReadOptions options;
  options.limits = limits;
  options.keep_text = true;
  auto again =
      formats::read_lone_feature(*std::move(changed_text), document->header.str(), options);
  if (!again) return again;
  again->format = document->format;
  again->header = document->header;
  return again;
}

/// Whether a condition holds for a feature that exists in this version.
bool holds(const store::WriteCondition& condition, std::uint64_t version) {
  using Kind = store::WriteCondition::Kind;
  if (condition.kind == Kind::absent) return false;
  const std::vector<std::uint64_t>& versions = condition.versions;
  return condition.kind != Kind::versions ||
         std::find(versions.begin(), versions.end(), version) != versions.end();
}

}  // namespace

Response put_item(const RoutedRequest& request) {
  if (auto refusal = unless_conditional(request)) return *std::move(refusal);
  const auto options = submit_options(request);
  if (!options) return to_response(to_problem(options.error()));
  const std::string& id = request.target.segments[3];
  if (is_container_body(request)) {
    return refuse(415, "unsupported", "send the feature as CityJSON or CityJSONSeq");
  }
  const auto header = header_for(request);
  if (!header) return to_response(to_problem(header.error()));
  const auto read = [&] {
    return read_submission(request, AcceptedFormats::with_ids, *header, options->surfaces);
  };
  Submission looked_at = read();
  if (looked_at.problem) return to_response(*looked_at.problem);
  if (auto refusal = unless_feature(*looked_at.reader, id)) return *std::move(refusal);
  looked_at = {};
  Submission submission = read();
  if (submission.problem) return to_response(*submission.problem);
  SolidStore& store = *request.service.store;
  const bool is_new = !store.version(options->collection, id);
  const auto outcome =
      pipeline::ingest(*submission.reader, store, request.service.workers, *options);
  if (!outcome) return to_response(problem_of_body(outcome.error()));
  return changed(request, *outcome, is_new);
}

Response patch_item(const RoutedRequest& request) {
  if (auto refusal = unless_conditional(request)) return *std::move(refusal);
  const auto patch = patched_attributes(request.request.body);
  if (!patch) return to_response(to_problem(patch.error()));
  SolidStore& store = *request.service.store;
  const std::string& id = request.target.segments[3];
  auto stored = store.get(request.target.segments[1], id);
  if (!stored) return to_response(to_problem(stored.error()));
  const auto condition = write_condition(request.request);
  if (!condition) return to_response(to_problem(condition.error()));
  if (!holds(*condition, stored->version)) {
    return refuse(412, "precondition-failed",
                  "the feature has version " + std::to_string(stored->version));
  }
  pipeline::IngestOptions options = ingest_options(request.service, request.is_cancelled);
  options.collection = request.target.segments[1];
  const Status own = pipeline::apply_rules_of(store, options);
  if (!own) return to_response(to_problem(own.error()));
  options.policy = store::Policy::keep;  // the geometry is what it was
  // Another change since the feature was read is not overwritten.
  options.condition = {store::WriteCondition::Kind::versions, {stored->version}};
  auto document = patched(*std::move(stored), *patch, request.service.options.limits);
  if (!document) {
    return refuse(422, "unsupported", "this feature did not come as a city model with attributes");
  }
  const auto outcome =
      pipeline::ingest(*std::move(document), store, request.service.workers, options);
  if (!outcome) return to_response(to_problem(outcome.error()));
  return changed(request, *outcome, false);
}

}  // namespace watertight::server
