// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/body_coding.h"

#include <algorithm>
#include <string>

#include "base/ascii.h"
#include "server/problem.h"

namespace watertight::server {
namespace {

constexpr std::size_t kStep = std::size_t{1} << 16U;

/// A source of the bytes of a text, which must outlive it.
ByteSource source_of_text(std::string_view text) {
  return [text](std::span<std::uint8_t> bytes) mutable -> Result<std::size_t> {
    const std::size_t count = std::min(text.size(), bytes.size());
    std::copy_n(text.begin(), count, bytes.begin());
    text.remove_prefix(count);
    return count;
  };
}

std::string_view trimmed(std::string_view text) {
  const std::size_t start = std::min(text.find_first_not_of(" \t"), text.size());
  return text.substr(start, text.find_last_not_of(" \t") + 1 - start);
}

Result<std::string> expanded(std::string_view packed, archives::Compression coding,
                             std::uint64_t most,
                             const std::function<bool(std::uint64_t bytes)>& has_room,
                             const CancelPoll& is_cancelled) {
  const ByteSource source =
      archives::expanded(source_of_text(packed), coding, {most, 0}, archives::kWindowOfHttp);
  std::string body;
  std::string piece(kStep, '\0');
  const std::span<std::uint8_t> space(reinterpret_cast<std::uint8_t*>(piece.data()), piece.size());
  for (;;) {
    if (is_cancelled()) return Error{ErrorCode::cancelled, "the request took too long"};
    const auto count = source(space);
    if (!count) return count.error();
    if (*count == 0) return body;
    if (!has_room(body.size() + *count)) {
      return Error{ErrorCode::unavailable, "too many large requests are being received"};
    }
    body.append(piece, 0, *count);
  }
}

}  // namespace

std::optional<archives::Compression> coding_of(const Request& request) {
  auto coding = archives::Compression::none;
  for (const HeaderField& field : request.headers) {
    if (field.name != "content-encoding") continue;
    const std::string name = lower_case(trimmed(field.value));
    if (name == "identity") continue;
    if (coding != archives::Compression::none) return std::nullopt;
    if (name == "gzip" || name == "x-gzip") {
      coding = archives::Compression::gzip;
    } else if (name == "zstd") {
      coding = archives::Compression::zstd;
    } else {
      return std::nullopt;
    }
  }
  return coding;
}

std::optional<Response> expand_body(Request& request, archives::Compression coding,
                                    std::uint64_t most,
                                    const std::function<bool(std::uint64_t bytes)>& has_room,
                                    const CancelPoll& is_cancelled) {
  auto body = expanded(request.body, coding, most, has_room, is_cancelled);
  if (!body) {
    Problem problem = to_problem(body.error());
    if (body.error().code == ErrorCode::unavailable) problem.kind = "busy";
    return to_response(problem);
  }
  request.body = *std::move(body);
  return std::nullopt;
}

}  // namespace watertight::server
