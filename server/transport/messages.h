// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests and responses as the messages of Beast: what is refused before a body is read, the
// fields that every answer has. Includes Beast: for session.cpp and listener.cpp only.
#pragma once

#include <utility>  // before Asio: Boost 1.74 uses std::exchange without including it

#include <boost/beast/http.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/transport/http.h"
#include "server/transport/listener.h"

namespace watertight::server {

/// Reads a request whose body the caller takes a piece at a time.
using RequestParser = boost::beast::http::request_parser<boost::beast::http::buffer_body>;
template <class Body>
using ResponseMessage = boost::beast::http::response<Body>;

Response problem(unsigned status, std::string kind, std::string detail);

/// 503: the client may come back in some seconds.
Response busy(std::string detail);
/// 429: this client's address has as much as it may have at once.
Response too_many(std::string detail);

/// 413: the body has more than `most` bytes.
Response too_large(std::uint64_t most);

/// The answer to a request that could not be read; nothing when the connection is simply over.
std::optional<Response> answer_to(const boost::system::error_code& error,
                                  const ServerOptions& options);

/// True if a request with this method has a use for its body; that of others is read and dropped.
bool takes_body(const RequestParser& parser);

/// The refusal of a header before its body is read; nothing when the header is fine.
std::optional<Response> refusal_of(const RequestParser& parser, const ServerOptions& options);

/// The request whose header was read, without its body.
Request to_request(const RequestParser& parser);

/// Status and header fields of an answer, except those that state its length. `Body` is string_body
/// or buffer_body.
template <class Body>
ResponseMessage<Body> head_of(const Response& response, bool keep_alive, unsigned version);

/// A whole answer; without its body for HEAD.
ResponseMessage<boost::beast::http::string_body> to_message(Response&& response, bool is_head,
                                                            bool keep_alive, unsigned version);

/// The characters of a target or name as one word of a log line: printable ASCII, others as "?".
std::string quoted(std::string_view text);

}  // namespace watertight::server
