// SPDX-License-Identifier: GPL-3.0-or-later
//
// The outcome of a function that can fail on bad input: a value or an Error. For every folder.
// Findings about a solid are not Errors (they are data, see validate/report.h) and broken
// contracts are not Errors either (WATERTIGHT_ASSERT in base/assert.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "base/assert.h"

namespace watertight {

enum class ErrorCode : std::uint8_t {
  malformed,            // the bytes are not what they claim to be
  unsupported,          // well formed, but a feature or version this program does not know
  limit_exceeded,       // larger, deeper or slower than the caller allows
  not_encodable,        // a correct solid that a mode of the format cannot hold
  cancelled,            // the caller asked to stop
  not_found,            // a named thing does not exist
  conflict,             // a named thing exists already, or changed meanwhile
  precondition_failed,  // a condition of the caller on what is stored does not hold
  unavailable,          // a file, process or server cannot be used now; trying again can help
  invalid_argument      // an option or parameter has a value that is not allowed
};

/// The code as the lower-case word used in every report, e.g. "limit-exceeded".
std::string_view to_string(ErrorCode code);

/// The reason why something could not be done, and the place.
struct Error {
  ErrorCode code = ErrorCode::malformed;
  std::string message;                            // one sentence for the person who sent the input
  std::optional<std::uint64_t> byte_offset = {};  // offset into the bytes that were read
  std::string pointer = {};                       // JSON Pointer (RFC 6901) into the document
  std::string detail =
      {};  // for the log and the command line, never for a client: it may name files
};

/// The error on one line, with its detail: "malformed: <message> (at byte 17)".
std::string to_string(const Error& error);

/// A value or an error. Member names are those of std::expected (C++23).
template <class Value>
class [[nodiscard]] Result {
 public:
  using value_type = Value;

  Result(Value value) : state_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const { return std::holds_alternative<Value>(state_); }
  explicit operator bool() const { return has_value(); }

  /// Requires has_value().
  Value& operator*() & { return *operator->(); }
  const Value& operator*() const& { return *operator->(); }
  Value&& operator*() && { return std::move(*operator->()); }
  Value* operator->() {
    WATERTIGHT_ASSERT(has_value());
    return std::get_if<Value>(&state_);
  }
  const Value* operator->() const {
    WATERTIGHT_ASSERT(has_value());
    return std::get_if<Value>(&state_);
  }
  Value& value() & { return **this; }
  const Value& value() const& { return **this; }
  Value&& value() && { return std::move(**this); }

  /// Requires !has_value().
  const Error& error() const& {
    WATERTIGHT_ASSERT(!has_value());
    return *std::get_if<Error>(&state_);
  }
  Error&& error() && {
    WATERTIGHT_ASSERT(!has_value());
    return std::move(*std::get_if<Error>(&state_));
  }

 private:
  std::variant<Value, Error> state_;
};

/// The result of a function that has nothing to return.
struct Done {};
using Status = Result<Done>;

}  // namespace watertight
