// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/messages.h"

#include <array>
#include <boost/asio/ip/address.hpp>
#include <cstdio>
#include <ctime>

#include "base/ascii.h"
#include "server/problem.h"
#include "server/transport/body_coding.h"

namespace watertight::server {
namespace {

namespace http = boost::beast::http;
using boost::system::error_code;

std::string lower(boost::beast::string_view text) {
  return lower_case(std::string_view(text.data(), text.size()));
}

bool is_loopback(std::string_view address) {
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(std::string(address), error);
  return !error && parsed.is_loopback();
}

/// Whether the host of a Host field is this machine, by a name or address that no other machine
/// has.
bool is_this_machine(std::string_view host) {
  const bool is_v6 = host.starts_with('[');
  const std::size_t end = is_v6 ? host.find(']') : host.find(':');
  const std::string name = lower_case(host.substr(is_v6 ? 1 : 0, is_v6 ? end - 1 : end));
  return name == "localhost" || is_loopback(name);
}

/// The refusal of what a page of another site has a browser send: it could write, or, under a name
/// of its own for this address, read.
std::optional<Response> refusal_of_origin(const RequestParser& parser,
                                          const ServerOptions& options) {
  const auto& request = parser.get();
  const std::string host = lower(request[http::field::host]);
  if (is_loopback(options.address) && request.count(http::field::host) > 0 &&
      !is_this_machine(host)) {
    return problem(421, "host",
                   "this service listens on the loopback address and answers for localhost only");
  }
  const bool is_safe = request.method() == http::verb::get ||
                       request.method() == http::verb::head ||
                       request.method() == http::verb::options;
  if (is_safe || request.count(http::field::origin) == 0) return std::nullopt;
  const std::string origin = lower(request[http::field::origin]);
  if (origin == "http://" + host || origin == "https://" + host) return std::nullopt;
  return problem(403, "origin", "a page of another site cannot change what is stored here");
}

/// The time as RFC 9110, section 5.6.7 writes it: "Sun, 22 Nov 2026 16:45:00 GMT".
std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%s, %02d %s %04d %02d:%02d:%02d GMT", kDays[utc.tm_wday],
                utc.tm_mday, kMonths[utc.tm_mon], utc.tm_year + 1900, utc.tm_hour, utc.tm_min,
                utc.tm_sec);
  return text.data();
}

}  // namespace

Response problem(unsigned status, std::string kind, std::string detail) {
  return to_response(Problem{status, std::move(kind), std::move(detail), {}, {}, {}, {}});
}

Response busy(std::string detail) {
  Problem answer{503, "busy", std::move(detail), {}, {}, {}, {}};
  answer.headers.push_back({"Retry-After", "5"});
  return to_response(answer);
}

Response too_many(std::string detail) {
  Problem answer{429, "too-many-requests", std::move(detail), {}, {}, {}, {}};
  answer.headers.push_back({"Retry-After", "5"});
  return to_response(answer);
}

Response too_large(std::uint64_t most) {
  return problem(413, "limit-exceeded",
                 "the request body is larger than " + std::to_string(most) + " bytes");
}

std::optional<Response> answer_to(const error_code& error, const ServerOptions& options) {
  if (error == http::error::header_limit) {
    return problem(
        431, "header-too-large",
        "the request header is larger than " + std::to_string(options.header_bytes) + " bytes");
  }
  if (error == http::error::bad_version) {
    return problem(505, "http-version", "this service speaks HTTP/1.1 and HTTP/1.0");
  }
  const bool is_over = error == http::error::end_of_stream ||
                       error == http::error::partial_message ||
                       error.category() != make_error_code(http::error::end_of_stream).category();
  if (is_over) return std::nullopt;
  return problem(400, "malformed", "not an HTTP request: " + error.message());
}

bool takes_body(const RequestParser& parser) {
  const http::verb method = parser.get().method();
  return method == http::verb::post || method == http::verb::put || method == http::verb::patch;
}

std::optional<Response> refusal_of(const RequestParser& parser, const ServerOptions& options) {
  const auto& request = parser.get();
  if (request.version() >= 11 && request.count(http::field::host) != 1) {
    return problem(400, "malformed", "the request needs exactly one Host field");
  }
  if (auto refusal = refusal_of_origin(parser, options)) return refusal;
  if (request.count(http::field::transfer_encoding) > 0) {
    // Any other coding could end elsewhere for a proxy before this service (RFC 9112, section 6.1).
    const bool is_chunked = request.version() >= 11 &&
                            request.count(http::field::transfer_encoding) == 1 &&
                            lower(request[http::field::transfer_encoding]) == "chunked" &&
                            request.count(http::field::content_length) == 0;
    if (!is_chunked) {
      return problem(501, "transfer-encoding",
                     "the only Transfer-Encoding that this service reads is chunked, in HTTP/1.1 "
                     "and without Content-Length");
    }
  }
  if (takes_body(parser) && !parser.chunked() && !parser.content_length()) {
    return problem(411, "length-required",
                   "send Content-Length or Transfer-Encoding: chunked with the body");
  }
  if (!coding_of(to_request(parser))) {
    Problem problem{415,
                    "unsupported",
                    "a body may have one Content-Encoding, one of: " + std::string(kBodyCodings),
                    {},
                    {},
                    {},
                    {}};
    problem.headers.push_back({"Accept-Encoding", std::string(kBodyCodings)});
    return to_response(problem);
  }
  return std::nullopt;
}

Request to_request(const RequestParser& parser) {
  const auto& message = parser.get();
  Request request;
  request.method = std::string(message.method_string());
  request.target = std::string(message.target());
  for (const auto& field : message) {
    request.headers.push_back({lower(field.name_string()), std::string(field.value())});
  }
  return request;
}

template <class Body>
ResponseMessage<Body> head_of(const Response& response, bool keep_alive, unsigned version) {
  ResponseMessage<Body> message;
  message.version(version);
  message.result(response.status);
  message.reason(std::string(reason_phrase(response.status)));
  message.set(http::field::server, "watertight");
  message.set(http::field::date, date_now());
  if (!response.content_type.empty()) {
    message.set(http::field::content_type, response.content_type);
  }
  message.set("X-Content-Type-Options", "nosniff");
  for (const HeaderField& field : response.headers) message.insert(field.name, field.value);
  message.keep_alive(keep_alive);
  return message;
}

ResponseMessage<http::string_body> to_message(Response&& response, bool is_head, bool keep_alive,
                                              unsigned version) {
  auto message = head_of<http::string_body>(response, keep_alive, version);
  const bool has_no_body = response.status == 204 || response.status == 304;
  if (!has_no_body) message.content_length(response.body.size());
  if (!is_head && !has_no_body) message.body() = std::move(response.body);
  return message;
}

std::string quoted(std::string_view text) {
  std::string word = "\"";
  for (const char c : text.substr(0, 512)) {
    const bool is_plain = c >= 0x20 && c < 0x7F && c != '"' && c != '\\';
    word.push_back(is_plain ? c : '?');
  }
  return word + "\"";
}

template ResponseMessage<http::string_body> head_of(const Response&, bool, unsigned);
template ResponseMessage<http::buffer_body> head_of(const Response&, bool, unsigned);

}  // namespace watertight::server
