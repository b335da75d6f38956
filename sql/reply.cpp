// SPDX-License-Identifier: GPL-3.0-or-later
#include "sql/reply.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>

namespace watertight::sql {
namespace {

// The most bytes of a result: a varlena of PostgreSQL holds less than 1 GiB.
constexpr std::size_t kLargestValue = (1ULL << 30) - 1024;
// The memory of this process that validating or encoding takes for each facet or vertex, an
// estimate: up to 2 KiB measured on closed meshes of 250,000 to 1,000,000 triangles, without the
// helper, which has a limit of its own.
constexpr std::uint64_t kBytesPerElement = 4096;

char* copy_of(std::string_view text) noexcept {
  char* const copy = static_cast<char*>(std::malloc(text.size() + 1));  // NOLINT: freed by C
  if (copy == nullptr) return nullptr;
  std::memcpy(copy, text.data(), text.size());
  copy[text.size()] = '\0';
  return copy;
}

}  // namespace

void fail(wt_reply* reply, std::string_view state, std::string_view message,
          std::string_view detail) noexcept {
  wt_failure& failure = reply->failure;
  std::memcpy(failure.sqlstate, state.data(), 5);
  const std::size_t length = std::min(message.size(), sizeof(failure.message) - 1);
  std::memcpy(failure.message, message.data(), length);
  failure.message[length] = '\0';
  // The message must not end within a UTF-8 character.
  for (std::size_t end = length; end < message.size() && end > 0; --end) {
    if ((static_cast<unsigned char>(message[end]) & 0xC0) != 0x80) {
      failure.message[end] = '\0';
      break;
    }
  }
  if (!detail.empty()) failure.detail = copy_of(detail);
}

void fail(wt_reply* reply, const Error& error) {
  std::string_view state = "XX000";
  switch (error.code) {
    case ErrorCode::malformed:
      state = "22P03";  // invalid_binary_representation
      break;
    case ErrorCode::unsupported:
      state = "0A000";  // feature_not_supported
      break;
    case ErrorCode::limit_exceeded:
      state = "54000";  // program_limit_exceeded
      break;
    case ErrorCode::cancelled:
      state = "57014";  // query_canceled
      break;
    case ErrorCode::unavailable:
      state = "58000";  // system_error
      break;
    case ErrorCode::not_encodable:
    case ErrorCode::not_found:
    case ErrorCode::conflict:
    case ErrorCode::precondition_failed:
    case ErrorCode::invalid_argument:
      state = "22023";  // invalid_parameter_value
      break;
  }
  std::string detail;
  if (error.byte_offset) {
    detail = "At byte " + std::to_string(*error.byte_offset) + ".";
  } else if (!error.pointer.empty()) {
    detail = "At " + error.pointer + ".";
  }
  fail(reply, state, error.message, detail);
}

void answer(wt_reply* reply, ByteView bytes) {
  if (bytes.size() > kLargestValue) {
    fail(reply, "54000", "the result is larger than a value can be (1 GiB)");
    return;
  }
  reply->bytes = static_cast<std::uint8_t*>(std::malloc(bytes.size() + 1));  // NOLINT: freed by C
  if (reply->bytes == nullptr) {
    fail(reply, "53200", "out of memory");
    return;
  }
  std::copy(bytes.begin(), bytes.end(), reply->bytes);
  reply->bytes[bytes.size()] = 0;
  reply->size = bytes.size();
}

Limits CallLimits::of_input() const {
  Limits limits;
  limits.cancel = &poll_;
  if (job_.max_memory == 0) return limits;
  const std::uint64_t elements = memory_bytes() / kBytesPerElement;
  limits.bytes = std::min(limits.bytes, memory_bytes());
  limits.vertices = std::min(limits.vertices, elements);
  limits.facets = std::min(limits.facets, elements);
  limits.rings = std::min(limits.rings, elements);
  limits.shells = std::min(limits.shells, elements);
  return limits;
}

Status CallLimits::check() const {
  if (is_interrupted()) return Error{ErrorCode::cancelled, "cancelled"};
  if (!is_late()) return Done{};
  return Error{ErrorCode::limit_exceeded, "the call took longer than watertight.max_seconds (" +
                                              std::to_string(job_.max_seconds) + " s)"};
}

Error CallLimits::of_reading(Error error) const {
  if (error.code == ErrorCode::cancelled) {
    if (const Status in_time = check(); !in_time) return in_time.error();
  }
  const Limits built_in;
  const bool is_setting = error.code == ErrorCode::limit_exceeded && job_.max_memory > 0 &&
                          of_input().facets < built_in.facets;
  if (is_setting) {
    error.message += " (watertight.max_memory is " + std::to_string(job_.max_memory) + " MB)";
  }
  return error;
}

}  // namespace watertight::sql
