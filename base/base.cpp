// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <cstdlib>

#include "base/assert.h"
#include "base/result.h"

namespace watertight {

std::string_view to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::malformed:
      return "malformed";
    case ErrorCode::unsupported:
      return "unsupported";
    case ErrorCode::limit_exceeded:
      return "limit-exceeded";
    case ErrorCode::not_encodable:
      return "not-encodable";
    case ErrorCode::cancelled:
      return "cancelled";
    case ErrorCode::not_found:
      return "not-found";
    case ErrorCode::conflict:
      return "conflict";
    case ErrorCode::precondition_failed:
      return "precondition-failed";
    case ErrorCode::unavailable:
      return "unavailable";
    case ErrorCode::invalid_argument:
      return "invalid-argument";
  }
  return "unknown";
}

std::string to_string(const Error& error) {
  std::string text{to_string(error.code)};
  text += ": " + error.message;
  if (error.byte_offset) text += " (at byte " + std::to_string(*error.byte_offset) + ")";
  if (!error.detail.empty()) text += " (" + error.detail + ")";
  if (!error.pointer.empty()) text += " (at " + error.pointer + ")";
  return text;
}

void assertion_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken contract: %s\n", file, line, condition);
  std::abort();
}

}  // namespace watertight
