// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/access/gate.h"

#include <openssl/evp.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "base/ascii.h"
#include "server/problem.h"

namespace watertight::server {
namespace {

/// The text of which this is the Base64; nothing if it is none.
std::optional<std::string> text_of_base64(std::string_view base64) {
  if (base64.empty() || base64.size() % 4 != 0) return std::nullopt;
  std::string text(base64.size() / 4 * 3, '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                   reinterpret_cast<const unsigned char*>(base64.data()),
                                   static_cast<int>(base64.size()));
  const std::size_t padding = base64.size() - 1 - base64.find_last_not_of('=');
  if (padding > 2 || size < static_cast<int>(padding)) return std::nullopt;
  text.resize(static_cast<std::size_t>(size) - padding);
  return text;
}

/// The key in the value of an Authorization field; "" if there is none.
std::string key_in(const std::string& authorization) {
  const std::size_t space = std::min(authorization.find(' '), authorization.size());
  const std::string scheme = lower_case(std::string_view(authorization).substr(0, space));
  const std::size_t start = std::min(authorization.find_first_not_of(' ', space),  //
                                     authorization.size());
  const std::string_view credentials = std::string_view(authorization).substr(start);
  if (scheme == "bearer") return std::string(credentials);
  if (scheme != "basic") return "";
  const auto text = text_of_base64(credentials);
  const std::size_t colon = text ? text->find(':') : std::string::npos;
  return colon == std::string::npos ? "" : text->substr(colon + 1);
}

Response unauthorized(std::string detail) {
  Problem problem{401, "unauthorized", std::move(detail), {}, {}, {}, {}};
  problem.headers.push_back({"WWW-Authenticate", "Bearer realm=\"watertight\""});
  problem.headers.push_back({"WWW-Authenticate", "Basic realm=\"watertight\", charset=\"UTF-8\""});
  return to_response(problem);
}

Response forbidden(const AccessKey& key, Scope needed) {
  std::string detail = "the key '";
  detail += key.name;
  detail += "' has the scope ";
  detail += to_string(key.scope);
  detail += ", and this request needs ";
  detail += to_string(needed);
  return to_response(Problem{403, "forbidden", std::move(detail), {}, {}, {}, {}});
}

}  // namespace

Result<std::unique_ptr<Gate>> Gate::open(const std::string& path, Scope without_key) {
  std::unique_ptr<Gate> gate(new Gate(path, without_key));
  auto stamp = gate->stamp();
  if (!stamp) return std::move(stamp).error();
  auto keys = gate->read();
  if (!keys) return std::move(keys).error();
  gate->stamp_ = *stamp;
  gate->keys_ = *std::move(keys);
  return gate;
}

Result<bool> Gate::refresh() {
  auto now = stamp();
  // A file that is replaced is away for a moment; without a file the old keys stay.
  if (!now || *now == stamp_) return false;
  stamp_ = *now;
  auto keys = read();
  if (!keys) return std::move(keys).error();
  const std::lock_guard lock(mutex_);
  keys_ = *std::move(keys);
  return true;
}

Admission Gate::admit(const Request& request, Scope needed) const {
  if (needed == Scope::none) return {};
  const std::string* authorization = request.header("authorization");
  if (authorization == nullptr) {
    if (without_key_ >= needed) return {};
    return {"", unauthorized("this request needs a key with the scope " +
                             std::string(to_string(needed)) +
                             ": Authorization: Bearer KEY, or the key as the password of Basic "
                             "authentication")};
  }
  const std::shared_ptr<const Keys> known = keys();
  const auto key = known->find(digest_of_key(key_in(*authorization)));
  if (key == known->end()) return {"", unauthorized("the key is not known here")};
  if (key->second.scope < needed) return {key->second.name, forbidden(key->second, needed)};
  return {key->second.name, std::nullopt};
}

Result<Gate::Stamp> Gate::stamp() const {
  std::error_code error;
  Stamp stamp;
  stamp.time = std::filesystem::last_write_time(path_, error);
  if (!error) stamp.size = std::filesystem::file_size(path_, error);
  if (!error) return stamp;
  return Error{
      error == std::errc::no_such_file_or_directory ? ErrorCode::not_found : ErrorCode::unavailable,
      error.message()};
}

Result<std::shared_ptr<const Gate::Keys>> Gate::read() const {
  std::ifstream file(path_, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) return Error{ErrorCode::unavailable, "the file cannot be read"};
  auto listed = read_keys(text);
  if (!listed) return std::move(listed).error();
  auto keys = std::make_shared<Keys>();
  for (AccessKey& key : *listed) {
    std::string digest = key.digest;
    keys->insert_or_assign(std::move(digest), std::move(key));
  }
  return std::shared_ptr<const Keys>(std::move(keys));
}

std::shared_ptr<const Gate::Keys> Gate::keys() const {
  const std::lock_guard lock(mutex_);
  return keys_;
}

}  // namespace watertight::server
