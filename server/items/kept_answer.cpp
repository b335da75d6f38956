// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/items/kept_answer.h"

#include <memory>

#include "server/features/links.h"
#include "server/items/preconditions.h"
#include "server/items/representation_cache.h"

namespace watertight::server {

Response kept_or_made(const RoutedRequest& request, const store::StoredCollection& collection,
                      std::string_view name, std::string_view type,
                      const std::function<Result<std::string>()>& make) {
  const std::string etag = etag_of_state(collection.state, std::string(name));
  if (auto unneeded = unless_needed(request.request, etag)) return *std::move(unneeded);
  std::string key = collection.id;
  key.append("/").append(name).append("/").append(collection.state).append("/");
  key.append(base_url(request)).append(request.request.target);
  RepresentationCache* cache = request.service.cache;
  if (cache != nullptr) {
    if (const auto kept = cache->find(key)) return *kept;
  }
  auto body = make();
  if (!body) return to_response(to_problem(body.error()));
  Response response{200, std::string(type), *std::move(body), {{"ETag", etag}}};
  if (cache != nullptr) cache->keep(key, std::make_shared<const Response>(response));
  return response;
}

}  // namespace watertight::server
