// SPDX-License-Identifier: GPL-3.0-or-later
//
// Parts of an answer by the field Range (RFC 9110, section 14). Internal to server/.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "server/transport/http.h"

namespace watertight::server {

/// The bytes from `first` to `last`, both included.
struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// The range that a GET asks for, of a body of `size` bytes with the tag `etag`.
struct WantedRange {
  enum class Kind : std::uint8_t { whole, part, unsatisfiable };
  Kind kind = Kind::whole;
  ByteRange part = {};  // for Kind::part
};

/// Takes several ranges, other units and a Range whose If-Range does not fit for no Range at all,
/// as the standard allows.
WantedRange wanted_range(const Request& request, std::string_view etag, std::uint64_t size);

/// The field Content-Range of a part of a body of `size` bytes.
HeaderField content_range(const ByteRange& part, std::uint64_t size);

/// 416: the range begins after the end of the body.
Response beyond(std::uint64_t size);

/// Makes a whole answer with status 200 and an ETag the part that the request asks for: 206, or 416
/// for a range beyond the end. Leaves other answers as they are.
Response in_range(const Request& request, Response whole);

}  // namespace watertight::server
