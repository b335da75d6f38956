// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/access/keys.h"

#include <openssl/evp.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "base/ascii.h"

namespace watertight::server {
namespace {

constexpr std::size_t kMostKeys = 10'000;
constexpr std::size_t kDigestDigits = 64;
constexpr std::array<std::pair<std::string_view, Scope>, 3> kScopes{
    {{"read", Scope::read}, {"write", Scope::write}, {"admin", Scope::admin}}};

std::string hexadecimal(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kSpace = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t start = line.find_first_not_of(kSpace); start != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kSpace, start), line.size());
    words.push_back(line.substr(start, end - start));
    start = line.find_first_not_of(kSpace, end);
  }
  return words;
}

Result<AccessKey> key_of(const std::vector<std::string_view>& words) {
  const auto wrong = [](std::string what) { return Error{ErrorCode::malformed, std::move(what)}; };
  if (words.size() != 3) return wrong("a key is NAME SCOPE DIGEST");
  if (const Status named = check_key_name(words[0]); !named) return wrong(named.error().message);
  const auto scope = scope_named(words[1]);
  if (!scope) return wrong("the scope of a key is read, write or admin");
  AccessKey key{std::string(words[0]), *scope, lower_case(words[2])};
  if (key.digest.size() != kDigestDigits ||
      key.digest.find_first_not_of("0123456789abcdef") != std::string::npos) {
    return wrong("the digest of a key is a SHA-256 of 64 hexadecimal digits");
  }
  return key;
}

}  // namespace

std::string_view to_string(Scope scope) {
  for (const auto& [name, value] : kScopes) {
    if (value == scope) return name;
  }
  return "none";
}

std::optional<Scope> scope_named(std::string_view name) {
  for (const auto& [known, value] : kScopes) {
    if (known == name) return value;
  }
  return std::nullopt;
}

std::string digest_of_key(std::string_view key) {
  std::array<unsigned char, kDigestDigits / 2> digest{};
  unsigned size = 0;
  EVP_Digest(key.data(), key.size(), digest.data(), &size, EVP_sha256(), nullptr);
  return hexadecimal({digest.data(), size});
}

Status check_key_name(std::string_view name) {
  constexpr std::size_t kLongest = 64;
  const auto is_plain = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  };
  if (!name.empty() && name.size() <= kLongest && std::all_of(name.begin(), name.end(), is_plain)) {
    return Done{};
  }
  return Error{ErrorCode::invalid_argument,
               "the name of a key has 1 to 64 characters of A-Z a-z 0-9 _ . -"};
}

Result<std::vector<AccessKey>> read_keys(std::string_view text) {
  std::vector<AccessKey> keys;
  std::size_t number = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::vector<std::string_view> words = words_of(text.substr(start, end - start));
    start = end + 1;
    ++number;
    if (words.empty() || words.front().starts_with('#')) continue;
    auto key = key_of(words);
    if (!key) {
      Error error = std::move(key).error();
      error.message.insert(0, "line " + std::to_string(number) + ": ");
      return error;
    }
    if (keys.size() == kMostKeys) {
      return Error{ErrorCode::limit_exceeded, "there are more than 10000 keys"};
    }
    keys.push_back(*std::move(key));
  }
  return keys;
}

Result<NewKey> make_key(std::string_view name, Scope scope) {
  if (Status named = check_key_name(name); !named) return std::move(named).error();
  std::array<unsigned char, kDigestDigits / 2> random{};
  if (RAND_bytes(random.data(), static_cast<int>(random.size())) != 1) {
    return Error{ErrorCode::unavailable, "the system gives no random bytes"};
  }
  NewKey made{"wt_", std::string(name)};
  made.key += hexadecimal(random);
  made.line += ' ';
  made.line += to_string(scope);
  made.line += ' ';
  made.line += digest_of_key(made.key);
  return made;
}

}  // namespace watertight::server
