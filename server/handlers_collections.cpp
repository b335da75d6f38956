// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers of collections as a whole: they list, show, rename, recount and remove them.
#include <functional>
#include <memory>
#include <optional>

#include "server/features/links.h"
#include "server/features/pages.h"
#include "server/features/systems.h"
#include "server/items/preconditions.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

/// A collection with links that start with `base`.
Json collection_json(const store::StoredCollection& collection, const std::string& base) {
  const std::string self = base + "/collections/" + percent_encode(collection.id);
  Json json{{"id", collection.id}, {"title", collection.id}, {"itemType", "feature"}};
  json["crs"] = system_uris(collection.srid);
  json["storageCrs"] = crs_uri(collection.srid);
  if (collection.box) {
    if (const auto box = box_in_crs84(collection.srid, *collection.box)) {
      json["extent"]["spatial"] = {{"bbox", Json::array({box_json(*box)})},
                                   {"crs", system_uri(PlaceSystem::crs84h, collection.srid)}};
    }
    json["storageBbox"] = box_json(*collection.box);
  }
  json["features"] = collection.features;
  json["solids"] = collection.solids;
  json["blobBytes"] = collection.blob_bytes;
  json["unproven"] = {{"features", collection.unproven_features}, {"solids", collection.unproven}};
  json["invalid"] = pipeline::to_string(collection.policy);
  json["links"] = Json::array(
      {link(self, "self", kJson, "this collection"),
       link(self + "/items", "items", kGeoJson, "its features"),
       link(self + "/queryables", "http://www.opengis.net/def/rel/ogc/1.0/queryables",
            "application/schema+json", "attributes that can be queried"),
       link(self + "/report?f=html", "related", kHtml, "report of all features, judged again"),
       link(self + "/report?proven=false&f=html", "related", kHtml, "report of what is not proven"),
       link(self + "/report?proven=false&f=geojson", "related", kGeoJson,
            "findings of what is not proven, as a layer"),
       link(self + "/3dtiles", "alternate", "application/json+3dtiles", "all of it as 3D Tiles"),
       link(self + "/export?f=wt", "enclosure", kContainer, "all of it as a Watertight file"),
       link(self + "/export?f=cityjsonseq", "enclosure", kCityJsonSeq,
            "all of it as a CityJSONSeq, if its features share a header")});
  return json;
}

Response collection_response(const Result<store::StoredCollection>& collection,
                             const std::string& base) {
  if (!collection) return to_response(to_problem(collection.error()));
  return json_response(collection_json(*collection, base));
}

/// The members of a collection that clients can change.
struct CollectionChange {
  std::optional<std::string> id;
  std::optional<store::Policy> policy;
};

/// The change in a JSON merge patch (RFC 7396).
Result<CollectionChange> change_of(const std::string& body) {
  constexpr std::size_t kLongestPatch = 1024;
  if (body.size() > kLongestPatch) {
    return Error{ErrorCode::limit_exceeded, "a change of a collection has at most 1024 bytes"};
  }
  const Json patch = Json::parse(body, nullptr, false);
  const Error wrong{ErrorCode::invalid_argument,
                    "a change of a collection is {\"id\": \"NEW-ID\"} or {\"invalid\": "
                    "\"refuse\", \"skip\" or \"keep\"}, or both in one object"};
  if (!patch.is_object() || patch.empty()) return wrong;
  CollectionChange change;
  for (const auto& [key, value] : patch.items()) {
    if (!value.is_string()) return wrong;
    if (key == "id") {
      change.id = value.get<std::string>();
    } else if (key == "invalid") {
      auto policy = pipeline::policy_named(value.get<std::string>());
      if (!policy) return std::move(policy).error();
      change.policy = *policy;
    } else {
      return wrong;
    }
  }
  return change;
}

using Upkeep = std::function<Response(SolidStore&, const std::string&, const CancelPoll&)>;

/// Work that touches all features of a collection, which can take minutes. One such work is done at
/// a time, so that they leave threads to others.
Response upkeep(const RoutedRequest& request, const Upkeep& work) {
  Response response;
  response.further = std::make_shared<const FurtherWork>(
      FurtherWork{Lane::computing, "upkeep",
                  [work, store = request.service.store, id = request.target.segments[1]](
                      const CancelPoll& is_cancelled) { return work(*store, id, is_cancelled); }});
  return response;
}

}  // namespace

std::optional<Response> unless_change_is_wanted(const RoutedRequest& request) {
  if (auto missing = unless_conditional(request)) return missing;
  if (!has_precondition(request.request)) return std::nullopt;
  const auto collection = request.service.store->collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  return unless_same_state(request.request, collection->state);
}

Response get_collections(const RoutedRequest& request) {
  const auto form = answer_form(request);
  if (!form) return refuse_forms();
  // Clients such as GDAL expect all collections at once.
  const auto limit = limit_of_request(request.target, request.service.options,
                                      request.service.options.largest_page);
  if (!limit) return to_response(to_problem(limit.error()));
  const std::string* given = request.target.parameter("after");
  const std::string after = given == nullptr ? std::string() : *given;
  const auto page = request.service.store->collections(*limit, after);
  if (!page) return to_response(to_problem(page.error()));
  const std::string base = base_url(request);
  const auto path = [&](const std::string& start) {
    std::string text = base + "/collections?limit=" + std::to_string(*limit);
    if (!start.empty()) text += "&after=" + percent_encode(start);
    return text;
  };
  Json json;
  json["links"] = Json::array({link(path(after), "self", kJson, "this page")});
  if (!page->next.empty()) {
    json["links"].push_back(link(path(page->next), "next", kJson, "next page"));
  }
  json["collections"] = Json::array();
  for (const store::StoredCollection& collection : page->collections) {
    json["collections"].push_back(collection_json(collection, base));
  }
  return *form == AnswerForm::html ? html_response(collections_page(json)) : json_response(json);
}

Response get_collection(const RoutedRequest& request) {
  const auto form = answer_form(request);
  if (!form) return refuse_forms();
  const auto collection = request.service.store->collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  const bool is_html = *form == AnswerForm::html;
  const std::string etag = etag_of_state(collection->state, is_html ? "html" : "json");
  if (auto unneeded = unless_needed(request.request, etag)) return *std::move(unneeded);
  const Json json = collection_json(*collection, base_url(request));
  Response response = is_html ? html_response(collection_page(json)) : json_response(json);
  response.headers.push_back({"ETag", etag});
  return response;
}

Response patch_collection(const RoutedRequest& request) {
  const auto change = change_of(request.request.body);
  if (!change) return to_response(to_problem(change.error()));
  if (auto refusal = unless_change_is_wanted(request)) return *std::move(refusal);
  SolidStore& store = *request.service.store;
  std::string id = request.target.segments[1];
  Status changed = change->policy ? store.set_policy(id, *change->policy) : Done{};
  if (changed && change->id) changed = store.rename_collection(id, *change->id);
  if (!changed) return to_response(to_problem(changed.error()));
  if (change->id) id = *change->id;
  Response response = collection_response(store.collection(id), base_url(request));
  response.headers.push_back({"Content-Location", "/collections/" + percent_encode(id)});
  return response;
}

Response post_recount(const RoutedRequest& request) {
  const std::string base = base_url(request);
  return upkeep(request, [base](SolidStore& store, const std::string& id, const CancelPoll&) {
    return collection_response(store.recount(id), base);
  });
}

Response delete_collection(const RoutedRequest& request) {
  if (auto refusal = unless_change_is_wanted(request)) return *std::move(refusal);
  return upkeep(request, [](SolidStore& store, const std::string& id, const CancelPoll& cancel) {
    const Status removed = store.remove_collection(id, cancel);
    return removed ? Response{204, "", "", {}} : to_response(to_problem(removed.error()));
  });
}

}  // namespace watertight::server
