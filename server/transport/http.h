// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests and responses as plain values, so that routes are functions that need no socket; and the
// parts of HTTP that routes use: percent-decoding, query parameters, content types, Accept.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"

namespace watertight::server {

struct HeaderField {
  std::string name;  // lower case in requests
  std::string value;
};

struct Response;

/// Takes the body of a request piece by piece, so that a body can be longer than memory. One thread
/// at a time calls it; it may wait for a disk, and the client waits meanwhile.
class BodySink {
 public:
  virtual ~BodySink() = default;
  /// Returns the answer that ends the request, if the piece cannot be taken.
  virtual std::optional<Response> take(std::string_view piece) = 0;
};

struct Request {
  std::string method;  // "GET", ...
  std::string target;  // as received: path and query, percent-encoded
  std::vector<HeaderField> headers;
  std::string body;
  std::shared_ptr<BodySink> sink = nullptr;  // has the body, if present

  /// The value of the first field `name` (lower case); nullptr if there is none.
  const std::string* header(std::string_view name) const;
};

/// The threads that answer a request. Quick requests are answered on the I/O thread, whatever the
/// others do. Requests that only wait for the database, those for one small item that no cache has,
/// those that compute little, and those that may compute long each have threads of their own, so
/// that none waits for one of another kind.
enum class Lane : std::uint8_t { quick, reading, items, small, computing };

/// The next part of a body; "" after the last. An error cuts the answer off, whose status has been
/// sent. The work ends early, by an error, once the poll says that nobody waits for the part.
using BodyParts = std::function<Result<std::string>(const CancelPoll&)>;

struct FurtherWork;

struct Response {
  unsigned status = 200;
  std::string content_type;  // "" for a response without body
  std::string body;
  std::vector<HeaderField> headers = {};
  /// Makes the parts that follow `body` while they are sent; empty if `body` is whole. One thread
  /// at a time calls it, after the part before was sent, and never again once the client is gone.
  BodyParts rest = {};
  /// The time before each part of `rest`, for an answer that tells of something while it happens.
  /// Such an answer ends early when the server stops.
  std::chrono::milliseconds pause = std::chrono::milliseconds(0);
  /// If present, the answer is still to be made, by this work in another lane; the other members
  /// have no meaning then.
  std::shared_ptr<const FurtherWork> further = nullptr;
  std::string note = {};  // for the log, never for the client
};

/// The second step of an answer. Works with the same key are done one after another, so that the
/// later ones can use a result that the first one has kept; "" is no key.
struct FurtherWork {
  Lane lane = Lane::computing;
  std::string key;
  std::function<Response(const CancelPoll&)> make;
};

/// The standard phrase of a status, e.g. "Not Found".
std::string_view reason_phrase(unsigned status);

/// Decodes %XX. Errors: malformed on a broken escape, a NUL or text that is not
/// UTF-8.
Result<std::string> percent_decode(std::string_view text);

/// Encodes everything but unreserved characters (RFC 3986, section 2.3).
std::string percent_encode(std::string_view text);

/// True if the bytes are UTF-8 (no overlong forms, no surrogates).
bool is_utf8(std::string_view text);

/// A request target taken apart. Segments are decoded one by one, so an encoded slash stays inside
/// its segment. Segments are no paths of files: "." and ".." have no meaning.
struct Target {
  std::vector<std::string> segments;  // "collections", "a" for "/collections/a"; none for "/"
  std::vector<std::pair<std::string, std::string>> parameters;

  const std::string* parameter(std::string_view name) const;
};

/// Takes a request target apart. Errors: malformed (not an absolute path, an empty segment, a
/// broken escape); invalid_argument for a parameter given twice.
Result<Target> parse_target(std::string_view target);

/// A media type without its parameters, lower case: "application/json" for "Application/JSON;
/// charset=utf-8".
std::string media_type(std::string_view content_type);

/// Chooses among `offers` (media types, best first) by an Accept header (RFC 9110, section 12.5.1).
/// Returns the index of the offer with the highest quality, the earlier one on ties; nullopt when
/// none is acceptable. Without a header all are acceptable.
std::optional<std::size_t> negotiate(const std::string* accept,
                                     const std::vector<std::string_view>& offers);

}  // namespace watertight::server
