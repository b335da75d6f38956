// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compressed answers (Accept-Encoding, RFC 9110 section 12.5.3). Internal to server/.
#pragma once

#include <string_view>

#include "server/handlers.h"

namespace watertight::server {

/// The end of the tag of an answer that is compressed: the same representation, other bytes.
inline constexpr std::string_view kGzipTag = "-gzip";

/// Whether a client takes gzip.
bool takes_gzip(const Request& request);

/// Whether answers of a media type become much smaller: texts, but not what is compressed already.
bool is_compressible(std::string_view type);

/// The answer, compressed if the client takes that and it is a text that is long enough and whole;
/// or the work that makes it. Its tag then ends with kGzipTag. Cost: that of archives::gzip().
Response with_coding(const Request& request, Response response);

}  // namespace watertight::server
