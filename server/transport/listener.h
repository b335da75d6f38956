// SPDX-License-Identifier: GPL-3.0-or-later
//
// The HTTP/1.1 server under the routes: listens, limits, hands requests to worker threads and
// drains. It knows nothing of solids; an Application makes the answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "base/cancel.h"
#include "base/result.h"
#include "server/transport/http.h"

namespace watertight::server {

/// Whether a request goes on, and by whose right.
struct Admission {
  std::string key;  // the name of the access key, for the log; "" = none
  std::optional<Response> refusal = std::nullopt;
  std::shared_ptr<BodySink> sink = nullptr;  // for the body; null: it stays in memory
  std::uint64_t sink_bytes = 0;              // the most bytes that the sink takes
  std::string user = {};  // whom the proxy names that sent the key, for the log; "" = nobody
};

/// An answered request, as it is logged. The texts live as long as the call.
struct AnsweredRequest {
  std::string_view method;  // as the client wrote it
  std::string_view target;
  unsigned status = 0;      // 0: the client left before its request was whole
  std::uint64_t bytes = 0;  // of the body of the answer
  double seconds = 0;       // from the first byte of the request to the last one of the answer
};

/// The functions that answer requests. Several threads call both at once.
struct Application {
  /// Chooses the threads for a request whose body has so many bytes. A body above 64 KiB is not yet
  /// in the request, and a quick request never gets it.
  std::function<Lane(const Request&, std::uint64_t body_bytes)> lane;
  std::function<Response(const Request&, const CancelPoll&)> respond;
  /// Asked at once when a header has come, before the body is read. Null: all requests go on.
  std::function<Admission(const Request&)> admit = nullptr;
  /// Called after each answer, from the I/O thread. Null: nobody counts.
  std::function<void(const AnsweredRequest&)> answered = nullptr;
  /// Called when a stop has waited long enough: what respond() is doing should fail soon.
  std::function<void()> interrupt = nullptr;
};

/// One line about an answered request or an event, already formatted as key=value pairs.
using LogLine = std::function<void(const std::string& line)>;

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;    // 0: any free port
  std::string tls_certificate;  // the chain of certificates as PEM text; "": plain HTTP
  std::string tls_key;          // its key, as PEM text
  bool is_encrypted() const { return !tls_certificate.empty(); }
  std::uint32_t header_bytes = 16 * 1024;
  std::uint64_t body_bytes = 256ULL << 20;            // the most bytes of the body of one request
  std::uint64_t body_bytes_together = 1024ULL << 20;  // the most for all requests being received
  double idle_seconds = 60;                           // the longest time between requests
  double header_seconds = 10;   // the longest time from the first byte of a header to its last
  double body_seconds = 20;     // for the body, plus one for each body_rate bytes that have arrived
  double body_rate = 20e3;      // bytes per second
  double answer_seconds = 300;  // the longest time of computing; then engines are cancelled
  double write_seconds = 20;    // for an answer, plus one for each write_rate bytes of it
  double write_rate = 20e3;     // bytes per second
  double drain_seconds = 30;    // the longest time for requests in flight when stopping
  std::size_t connections = 5000;
  std::size_t connections_per_address = 0;  // of one client's address; 0: as many as of all
  std::size_t works_per_address = 0;        // requests that compute or wait to; 0: no limit
  std::size_t computing_threads = 2;
  std::size_t small_threads = 16;  // most of the time they wait for the database
  std::size_t reading_threads = 4;
  /// They compute half the time: more would take turns on the processors.
  std::size_t item_threads = std::thread::hardware_concurrency() + 1;
  std::size_t computing_queue = 64;  // requests waiting for a computing thread; more get 503
  std::size_t small_queue = 1000;
  std::size_t reading_queue = 5000;
  std::size_t item_queue = 1000;
  std::size_t downloads = 16;  // answers in parts (Response::rest) at once; more get 503
  std::size_t watchers = 64;   // the same, of those with pauses (Response::pause)
  std::size_t uploads = 64;    // bodies that go to a sink at once; more get 503
};

/// Ok for a certificate and a key that a server can use. Errors: invalid_argument.
Status check_tls(const std::string& certificate, const std::string& key);

/// A listening server with its threads.
class HttpServer {
 public:
  /// Starts to listen. Errors: invalid_argument (address), unavailable (address in use, no
  /// permission).
  static Result<std::unique_ptr<HttpServer>> start(const ServerOptions& options,
                                                   Application application, LogLine log);
  virtual ~HttpServer() = default;
  virtual std::uint16_t port() const = 0;
  /// Stops gracefully: accepts no more connections, closes idle ones, lets requests in flight
  /// finish within drain_seconds, then cancels and closes the rest. Blocks until done; later calls
  /// do nothing.
  virtual void stop() = 0;
};

}  // namespace watertight::server
