// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compressed bodies of requests (Content-Encoding, RFC 9110 section 8.4). Internal to transport/.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "archives/expansion.h"
#include "base/cancel.h"
#include "server/transport/http.h"

namespace watertight::server {

/// The codings that bodies may have, as the value of Accept-Encoding (RFC 7694).
inline constexpr std::string_view kBodyCodings = "gzip, zstd";

/// The coding that the Content-Encoding fields of a request name: none without one, and for
/// "identity". nullopt for a coding that is not read, and for several.
std::optional<archives::Compression> coding_of(const Request& request);

/// Puts the expanded body of a request in the place of the compressed one. `has_room` is called
/// with the bytes of it whenever there are more; false ends the work. Returns the problem with the
/// body, if any (400 with the byte offset in the compressed body; 413 beyond `most` bytes, and for
/// Zstandard with a window above 8 MiB; 503); then the request stays as it is. Requires gzip or
/// zstd. Cost: linear in the expanded bytes; memory: these and the window.
std::optional<Response> expand_body(Request& request, archives::Compression coding,
                                    std::uint64_t most,
                                    const std::function<bool(std::uint64_t bytes)>& has_room,
                                    const CancelPoll& is_cancelled);

}  // namespace watertight::server
