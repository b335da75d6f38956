// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers of the attributes that a collection has chosen to be queried.
#include <algorithm>
#include <memory>

#include "server/features/schemas.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

Response attributes_response(SolidStore& store, const std::string& collection) {
  const auto chosen = store.attributes(collection);
  if (!chosen) return to_response(to_problem(chosen.error()));
  Json json{{"attributes", Json::array()}};
  for (const store::ChosenAttribute& attribute : *chosen) {
    json["attributes"].push_back({{"name", attribute.name},
                                  {"complete", attribute.is_complete()},
                                  {"types", json_types(attribute)}});
  }
  return json_response(json);
}

/// The names in {"attributes": ["a", "b"]}.
Result<std::vector<std::string>> names_of(const std::string& body) {
  constexpr std::size_t kLongest = 1 << 20;
  if (body.size() > kLongest) {
    return Error{ErrorCode::limit_exceeded, "a choice of attributes has at most 1 MiB"};
  }
  const Error wrong{ErrorCode::invalid_argument,
                    "a choice of attributes is {\"attributes\": [NAME, ...]}"};
  const Json json = Json::parse(body, nullptr, false);
  if (!json.is_object() || json.size() != 1 || !json.contains("attributes")) return wrong;
  if (!json["attributes"].is_array()) return wrong;
  std::vector<std::string> names;
  for (const Json& name : json["attributes"]) {
    if (!name.is_string()) return wrong;
    names.push_back(name.get<std::string>());
  }
  return names;
}

/// Makes `names` the chosen attributes of a collection.
Status choose(SolidStore& store, const std::string& collection, std::vector<std::string> names,
              const CancelPoll& is_cancelled) {
  const auto chosen = store.attributes(collection);
  if (!chosen) return chosen.error();
  store::AttributeChange change{std::move(names), {}};
  for (const store::ChosenAttribute& attribute : *chosen) {
    if (std::find(change.add.begin(), change.add.end(), attribute.name) == change.add.end()) {
      change.remove.push_back(attribute.name);
    }
  }
  return store.change_attributes(collection, change, is_cancelled);
}

}  // namespace

Response get_attributes(const RoutedRequest& request) {
  if (auto refusal = json_only(request)) return *std::move(refusal);
  return attributes_response(*request.service.store, request.target.segments[1]);
}

Response put_attributes(const RoutedRequest& request) {
  auto names = names_of(request.request.body);
  if (!names) return to_response(to_problem(names.error()));
  if (auto refusal = unless_change_is_wanted(request)) return *std::move(refusal);
  Response response;
  response.further = std::make_shared<const FurtherWork>(FurtherWork{
      Lane::computing, "upkeep",
      [store = request.service.store, id = request.target.segments[1],
       chosen = *std::move(names)](const CancelPoll& is_cancelled) {
        const Status done = choose(*store, id, chosen, is_cancelled);
        return done ? attributes_response(*store, id) : to_response(to_problem(done.error()));
      }});
  return response;
}

}  // namespace watertight::server
