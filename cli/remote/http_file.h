// SPDX-License-Identifier: GPL-3.0-or-later
//
// A file on a web server that is read in ranges (RFC 9110, "Range Requests"), by libcurl. Any
// server of static files will do.
#pragma once

#include <string>
#include <string_view>

#include "base/limits.h"
#include "pipeline/file/file_bytes.h"

namespace watertight::cli {

/// Whether an argument is an http or https URL.
bool is_url(std::string_view argument);

/// Opens a file by its end: one request. Each read is a request for a range, of the same file: one
/// that changes meanwhile is an error. A server without ranges gives a small file whole, a large
/// one is refused. Certificates are verified; at most 5 redirects are followed, none from https to
/// http. Errors: not_found; unavailable (no connection, a refusal, a timeout); unsupported (no
/// ranges); conflict (the file changed); limit_exceeded.
Result<pipeline::FileBytes> open_http_file(const std::string& url);

/// All bytes of a file on a web server. Errors: as above.
Result<Bytes> read_http_file(const std::string& url, const Limits& limits);

}  // namespace watertight::cli
