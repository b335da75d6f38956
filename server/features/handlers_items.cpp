// SPDX-License-Identifier: GPL-3.0-or-later
//
// The handler of lists of features: pages of GeoJSON, or of facts alone.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "pipeline/stored/attributes.h"
#include "server/features/feature_text.h"
#include "server/features/filters.h"
#include "server/features/links.h"
#include "server/features/pages.h"
#include "server/items/preconditions.h"
#include "server/items/representation_cache.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

constexpr std::ptrdiff_t kFewFeatures = 20;                  // that take a moment to decode
constexpr std::size_t kLongestPage = std::size_t{32} << 20;  // bytes; a page ends after them

/// How much of an extent in x and y a box covers, 0 to 1.
double share_of(const store::StoredBox& extent, const store::StoredBox& box) {
  double share = 1;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double low = std::max(extent.min[axis], box.min[axis]);
    const double high = std::min(extent.max[axis], box.max[axis]);
    const double length = extent.max[axis] - extent.min[axis];
    share *= length > 0 ? std::clamp((high - low) / length, 0.0, 1.0) : 1;
  }
  return share;
}

/// Whether the text can be an instant or an interval of RFC 3339. No feature has a time by which it
/// could be selected, so all match.
bool is_datetime(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789-:.+TZtz/") == std::string_view::npos;
}

/// The conditions in the parameters that are names of attributes.
Result<std::vector<store::AttributeCondition>> conditions_of_request(const Target& target) {
  std::vector<store::AttributeCondition> conditions;
  for (const auto& [name, value] : target.parameters) {
    if (std::find(std::begin(kItemParameters), std::end(kItemParameters), name) !=
        std::end(kItemParameters)) {
      continue;
    }
    auto condition = pipeline::condition_of(name, value);
    if (!condition) return std::move(condition).error();
    conditions.push_back(*std::move(condition));
  }
  return conditions;
}

/// The number of features of a collection that are proven, or are not, or of all.
std::uint64_t matched(const store::StoredCollection& collection, std::optional<bool> is_proven) {
  if (!is_proven) return collection.features;
  return *is_proven ? collection.features - collection.unproven_features
                    : collection.unproven_features;
}

/// The facts about a feature that need no look into it.
Json summary_json(const std::string& base, const std::string& collection,
                  const store::FeatureSummary& feature) {
  Json json{{"type", "Feature"}, {"id", feature.id}};
  if (feature.box) json["bbox"] = box_json(*feature.box);
  json["geometry"] = nullptr;
  json["properties"] = {{"type", feature.type},
                        {"solids", feature.solids},
                        {"blobBytes", feature.blob_bytes},
                        {"proven", feature.is_proven},
                        {"unprovenSolids", feature.unproven},
                        {"version", feature.version}};
  const std::string path = base + item_path(collection, feature.id);
  json["links"] = Json::array({link(path + "?f=cityjson", "item", kCityJson, "CityJSON"),
                               link(path + "?f=gml", "alternate", kGml, "CityGML"),
                               link(path + "?f=obj", "alternate", kObj, "OBJ"),
                               link(path + "?f=glb", "alternate", kGltf, "glTF"),
                               link(path + "?f=wt", "alternate", kContainer, "Watertight file")});
  return json;
}

/// The form of a page: GeoJSON under one of two types, the facts alone, HTML, or JSON-FG.
struct PageType {
  bool is_summary = false;
  std::string_view type;
  bool is_json_fg = type == kJsonFg;
  bool is_geo_json() const { return !is_summary && type != kHtml; }
};

std::optional<PageType> named_type(const RoutedRequest& request) {
  if (const std::string* format = request.target.parameter("f")) {
    if (*format == "geojson") return PageType{false, kGeoJson};
    if (*format == "json") return PageType{false, kJson};
    if (*format == "jsonfg") return PageType{false, kJsonFg};
    if (*format == "summary") return PageType{true, kJson};
    if (*format == "html") return PageType{false, kHtml};
    return std::nullopt;
  }
  const auto offer = negotiate(request.request.header("accept"), {kGeoJson, kJson, kHtml, kJsonFg});
  if (!offer) return std::nullopt;
  constexpr std::array<std::string_view, 4> kTypes{kGeoJson, kJson, kHtml, kJsonFg};
  return PageType{false, kTypes[*offer]};
}

/// The form that a request names, in the profile that it wants.
std::optional<PageType> page_type(const RoutedRequest& request) {
  auto type = named_type(request);
  if (type && type->is_geo_json()) type->is_json_fg |= wants_json_fg(request.target);
  return type;
}

/// A page that was read from the database and is to be written, apart from the request, so that
/// another thread can write it.
struct PageWork {
  Service service;
  std::string collection;
  std::uint32_t srid = 0;
  FeatureForm form;
  PageType type;
  std::string base;
  std::string path;   // of this page, without the parameter `after`
  std::string after;  // "" at the start
  std::optional<std::uint64_t>
      matched;  // the features that match on all pages, where that is known
  store::FeaturePage page;

  std::string key(const store::FeatureSummary& feature) const {
    return collection + '/' + feature.id + '/' + etag_of(feature.version, form.name() + "-line");
  }
  std::string href(const std::string& start) const {
    if (start.empty()) return path;
    return path + (path.find('?') == std::string::npos ? '?' : '&') +
           ("after=" + percent_encode(start));
  }
};

std::string path_without_after(const RoutedRequest& request, const std::string& base) {
  std::string path = base + "/collections/" + percent_encode(request.target.segments[1]) + "/items";
  char separator = '?';
  for (const auto& [name, value] : request.target.parameters) {
    if (name == "after") continue;
    path += separator + percent_encode(name) + "=" + percent_encode(value);
    separator = '&';
  }
  return path;
}

/// The members of a page before its features. `next` is where the next page begins, "" for the
/// last; `returned` the number of features.
Json page_head(const PageWork& work, const std::string& next, std::size_t returned) {
  Json json{{"type", "FeatureCollection"}};
  json["links"] = Json::array({link(work.href(work.after), "self", work.type.type, "this page")});
  if (!next.empty()) {
    json["links"].push_back(link(work.href(next), "next", work.type.type, "next page"));
  }
  json["links"].push_back(link(work.base + "/collections/" + percent_encode(work.collection),
                               "collection", kJson, "the collection"));
  if (work.type.is_geo_json()) {
    json["links"].push_back({{"href", profile_uri(work.form.is_json_fg)}, {"rel", "profile"}});
  }
  if (next.empty() && work.after.empty()) {
    json["numberMatched"] = returned;
  } else if (work.matched) {
    json["numberMatched"] = *work.matched;
  }
  json["numberReturned"] = returned;
  return json;
}

Response page_response(const PageWork& work, Json head, const std::string& features) {
  if (work.type.type == kHtml) {
    head["features"] = Json::parse("[" + features + "]");
    return html_response(items_page(work.collection, head));
  }
  std::string body = head.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (work.form.is_json_fg) body.insert(1, json_fg_head(work.form.system, work.srid));
  body.pop_back();
  body.append(R"(,"features":[)").append(features).append("]}\n");
  const PlaceSystem system = work.type.is_summary ? PlaceSystem::storage : work.form.system;
  return Response{200,
                  std::string(work.type.type),
                  std::move(body),
                  {{"Content-Crs", content_crs(system, work.srid)}, {"Vary", "Accept"}}};
}

Response summary_page(const PageWork& work) {
  std::string features;
  for (const store::FeatureSummary& feature : work.page.features) {
    if (!features.empty()) features += ',';
    features += summary_json(work.base, work.collection, feature)
                    .dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  return page_response(work, page_head(work, work.page.next, work.page.features.size()), features);
}

/// The text of a feature that the cache has; null without.
RepresentationCache::Answer kept_text(const PageWork& work, const store::FeatureSummary& feature) {
  return work.service.cache == nullptr ? nullptr : work.service.cache->find(work.key(feature));
}

/// Reads the feature and writes its text, "" if it was removed meanwhile. Nothing for a large
/// feature in a lane other than the one for long work.
Result<std::optional<std::string>> text_of(const PageWork& work,
                                           const store::FeatureSummary& feature,
                                           FeatureWriter& writer, Lane lane) {
  if (const auto kept = kept_text(work, feature)) return std::optional(kept->body);
  auto stored = work.service.store->get(work.collection, feature.id);
  if (!stored) {
    if (stored.error().code == ErrorCode::not_found) return std::optional(std::string());
    return std::move(stored).error();
  }
  if (lane != Lane::computing && is_large(*stored)) return std::optional<std::string>();
  const bool is_same = stored->version == feature.version;
  auto text = writer.write(*std::move(stored));
  if (!text) return std::move(text).error();
  if (is_same && work.service.cache != nullptr) {
    work.service.cache->keep(work.key(feature),
                             std::make_shared<const Response>(Response{200, "", *text}));
  }
  return std::optional(*std::move(text));
}

Response page_in_lane(const std::shared_ptr<const PageWork>& work, Lane lane, std::string key = {});

/// Writes the page, or leaves it to another lane when a large feature is on it.
Response written_page(const std::shared_ptr<const PageWork>& work, Lane lane,
                      const CancelPoll& is_cancelled) {
  FeatureWriter writer(work->form, work->service.options.limits);
  std::string features;
  std::size_t returned = 0;
  std::string next = work->page.next;
  for (const store::FeatureSummary& feature : work->page.features) {
    if (is_cancelled && is_cancelled()) {
      return to_response(to_problem({ErrorCode::cancelled, "the page was not finished in time"}));
    }
    const auto text = text_of(*work, feature, writer, lane);
    if (!text) return to_response(to_problem(text.error()));
    if (!*text) return page_in_lane(work, Lane::computing);
    if ((*text)->empty()) continue;
    if (!features.empty()) features += ',';
    features += **text;
    ++returned;
    if (features.size() > kLongestPage && &feature != &work->page.features.back()) {
      next = feature.cursor.empty() ? feature.id : feature.cursor;
      break;
    }
  }
  return page_response(*work, page_head(*work, next, returned), features);
}

Response page_in_lane(const std::shared_ptr<const PageWork>& work, Lane lane, std::string key) {
  Response response;
  response.further = std::make_shared<const FurtherWork>(
      FurtherWork{lane, std::move(key), [work, lane](const CancelPoll& is_unwanted) {
                    return written_page(work, lane, is_unwanted);
                  }});
  return response;
}

Response page_of(const std::shared_ptr<const PageWork>& work, const CancelPoll& is_cancelled) {
  if (work->type.is_summary) return summary_page(*work);
  const auto& features = work->page.features;
  const auto is_missing = [&](const store::FeatureSummary& feature) {
    return kept_text(*work, feature) == nullptr;
  };
  const auto first = std::find_if(features.begin(), features.end(), is_missing);
  // What the cache has may be gone a moment later, so this lane too leaves large features to
  // others.
  if (first == features.end()) return written_page(work, Lane::reading, is_cancelled);
  const auto missing = std::count_if(first, features.end(), is_missing);
  // Pages that begin to miss the same feature are written one after another: the first keeps it.
  const bool is_kept = work->service.cache != nullptr;
  return page_in_lane(work, missing <= kFewFeatures ? Lane::small : Lane::computing,
                      is_kept ? work->key(*first) : std::string());
}

/// A list of features as a client wants it.
struct ListRequest {
  store::StoredCollection collection;
  FeatureForm form;
  bool is_empty = false;  // no feature can match
  store::FeatureQuery query;
};

/// Errors: not_found, invalid_argument, unsupported.
Result<ListRequest> list_request(const RoutedRequest& request, const PageType& type) {
  const Target& target = request.target;
  auto collection = request.service.store->collection(target.segments[1]);
  if (!collection) return std::move(collection).error();
  auto form = FeatureForm::of_request(target, collection->srid, type.is_json_fg);
  if (!form) return std::move(form).error();
  const auto box = box_of_request(target, *collection);
  if (!box) return box.error();
  const std::string* datetime = target.parameter("datetime");
  if (datetime != nullptr && !is_datetime(*datetime)) {
    return Error{ErrorCode::invalid_argument, "datetime is an instant or interval of RFC 3339"};
  }
  const RouteOptions& options = request.service.options;
  const auto limit = limit_of_request(target, options, options.default_page);
  if (!limit) return limit.error();
  const auto is_proven = proof_of_request(target);
  if (!is_proven) return is_proven.error();
  auto where = conditions_of_request(target);
  if (!where) return std::move(where).error();
  auto filter = filter_of_request(target, *collection);
  if (!filter) return std::move(filter).error();
  auto sort = sort_of_request(target);
  if (!sort) return std::move(sort).error();
  const std::string* after = target.parameter("after");
  const double share = box->box && collection->box ? share_of(*collection->box, *box->box) : 0;
  store::FeatureQuery query{collection->id,
                            *limit,
                            after == nullptr ? std::string() : *after,
                            box->box,
                            share,
                            *is_proven,
                            *std::move(where),
                            *std::move(filter),
                            *std::move(sort)};
  return ListRequest{*std::move(collection), *std::move(form), box->is_empty, std::move(query)};
}

/// The problem of a list that the store refuses. A name that is no parameter counts as the name of
/// an attribute, so that a refused attribute may be a parameter that was meant otherwise.
Response refused_list(const Error& error, bool has_conditions) {
  Problem problem = to_problem(error);
  if (has_conditions && problem.status == 400) {
    problem.detail += "; other parameters:";
    for (const std::string_view known : kItemParameters) problem.detail.append(" ").append(known);
  }
  return to_response(problem);
}

}  // namespace

Response get_items(const RoutedRequest& request) {
  const auto type = page_type(request);
  if (!type) {
    return refuse(406, "not-acceptable",
                  "a list of items is available as application/geo+json (f=geojson), "
                  "application/json (f=json, or f=summary for facts without geometry), "
                  "application/vnd.ogc.fg+json (f=jsonfg) or text/html (f=html)");
  }
  const auto wanted = list_request(request, *type);
  if (!wanted) return to_response(to_problem(wanted.error()));
  const store::FeatureQuery& query = wanted->query;
  const auto work = std::make_shared<PageWork>();
  work->service = request.service;
  work->collection = wanted->collection.id;
  work->srid = wanted->collection.srid;
  work->form = wanted->form;
  work->type = *type;
  work->base = base_url(request);
  work->path = path_without_after(request, work->base);
  work->after = query.after;
  if (wanted->is_empty) return page_of(work, request.is_cancelled);
  if (!query.box && query.where.empty() && !query.filter) {
    work->matched = matched(wanted->collection, query.is_proven);
  }
  auto page = request.service.store->list(query);
  if (!page) return refused_list(page.error(), !query.where.empty());
  work->page = *std::move(page);
  return page_of(work, request.is_cancelled);
}

}  // namespace watertight::server
