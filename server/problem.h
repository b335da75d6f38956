// SPDX-License-Identifier: GPL-3.0-or-later
//
// Problem details (RFC 9457): the one form of every error answer of the service.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "server/transport/http.h"

namespace watertight::server {

/// The start of the `type` of a problem, which its kind follows.
inline constexpr std::string_view kProblemPrefix = "urn:watertight:problem:";

struct Problem {
  unsigned status = 500;
  std::string kind;    // "not-found", "malformed", ...: one per cause, listed in docs/api.md
  std::string detail;  // one sentence for the sender
  std::optional<std::uint64_t> byte_offset = {};  // offset into the request body
  std::string pointer = {};                       // JSON Pointer into the request body
  /// Further members as a JSON object ("" = none), e.g. the report of an invalid document.
  std::string extension = {};
  std::vector<HeaderField> headers = {};
  std::string note = {};  // for the log, never for the sender
};

/// The answer application/problem+json with type, title (the kind in words), status, detail,
/// byteOffset, pointer and the extension's members.
Response to_response(const Problem& problem);

/// The problem of an error met while reading the request body (400, 413, 415), the store (404, 409,
/// 503) or the request itself (400).
Problem to_problem(const Error& error);

}  // namespace watertight::server
