// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides by the key of a request, before its body is read, whether it may do what it asks for.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "server/access/keys.h"
#include "server/transport/http.h"
#include "server/transport/listener.h"

namespace watertight::server {

/// The keys of a file, which may change while the service runs. Thread-safe.
class Gate {
 public:
  /// Reads the file. `without_key` is the scope of requests that have no key. Errors: not_found,
  /// unavailable when the file cannot be read; those of read_keys().
  static Result<std::unique_ptr<Gate>> open(const std::string& path, Scope without_key);

  /// Reads the file again if it has changed since. True if its keys count now. The old keys stay
  /// after an error; errors are those of open(), each once for a change.
  Result<bool> refresh();

  /// Admits a request whose scope suffices. The key comes as `Authorization: Bearer KEY`, or as the
  /// password of Basic authentication with any user name. A wrong key is refused (401) even where
  /// none is needed, so that nobody works without the rights that they think they have; too little
  /// scope with a key is 403.
  Admission admit(const Request& request, Scope needed) const;

 private:
  using Keys = std::unordered_map<std::string, AccessKey>;  // by digest
  /// What a changed file differs in.
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    bool operator==(const Stamp&) const = default;
  };

  Gate(std::string path, Scope without_key) : path_(std::move(path)), without_key_(without_key) {}
  Result<Stamp> stamp() const;
  Result<std::shared_ptr<const Keys>> read() const;
  std::shared_ptr<const Keys> keys() const;

  const std::string path_;
  const Scope without_key_;
  Stamp stamp_;  // for refresh() only
  mutable std::mutex mutex_;
  std::shared_ptr<const Keys> keys_;
};

}  // namespace watertight::server
