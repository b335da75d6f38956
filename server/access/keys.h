// SPDX-License-Identifier: GPL-3.0-or-later
//
// Access keys: random texts that clients send, each with a name and a scope. A file of keys holds
// only their SHA-256 digests, so that who reads the file cannot use the service.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace watertight::server {

/// The rights of a client; each has those before it. `write` changes features, `admin` collections.
enum class Scope : std::uint8_t { none, read, write, admin };

std::string_view to_string(Scope scope);
/// The scope that a key can have by its name; nothing for others, "none" too.
std::optional<Scope> scope_named(std::string_view name);

/// A line of a file of keys.
struct AccessKey {
  std::string name;
  Scope scope = Scope::none;
  std::string digest;  // SHA-256 of the key, 64 hexadecimal digits in lower case
};

/// The SHA-256 digest of a key, 64 hexadecimal digits in lower case. A key has 256 random bits, so
/// that a slow digest with salt, as for passwords, would protect it no better.
std::string digest_of_key(std::string_view key);

/// Reads a file of keys: a line "NAME SCOPE DIGEST" for each; empty lines and those that start with
/// '#' mean nothing. Errors: malformed, with the number of the line; limit_exceeded above 10,000
/// keys.
Result<std::vector<AccessKey>> read_keys(std::string_view text);

/// Errors: invalid_argument unless the name has 1 to 64 characters of `A-Z a-z 0-9 _ . -`.
Status check_key_name(std::string_view name);

/// A key that was just made, and its line for a file of keys. The key is kept nowhere.
struct NewKey {
  std::string key;   // "wt_" and 64 hexadecimal digits
  std::string line;  // without line end
};

/// Makes a key from random bytes of the system. Errors: those of check_key_name(); unavailable when
/// the system gives no random bytes.
Result<NewKey> make_key(std::string_view name, Scope scope);

}  // namespace watertight::server
