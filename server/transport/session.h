// SPDX-License-Identifier: GPL-3.0-or-later
//
// One connection: reads requests within limits, has each answered in its lane, writes the answers.
// Includes Asio: for session.cpp and listener.cpp only.
#pragma once

#include <utility>  // before Asio: Boost 1.74 uses std::exchange without including it

#include <algorithm>
#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <unordered_map>

#include "server/budget.h"
#include "server/transport/client_stream.h"
#include "server/transport/listener.h"

namespace watertight::server {

/// Threads for the requests of one lane, and the number of requests that they may have to do.
struct LaneThreads {
  LaneThreads(std::size_t count, std::size_t queue)
      : threads(std::max<std::size_t>(count, 1)), places(queue + count) {}
  boost::asio::thread_pool threads;
  Budget places;
  std::atomic<std::chrono::steady_clock::time_point> last_answer{};  // of a status below 500
};

/// How many things of a kind each client's address has. Only for the I/O thread.
class AddressCounts {
 public:
  /// Counts one more, unless the address has `most` (0: no limit).
  bool take(const std::string& address, std::size_t most) {
    std::size_t& count = counts_[address];
    if (most != 0 && count >= most) return false;
    ++count;
    return true;
  }
  void give_back(const std::string& address) {
    const auto found = counts_.find(address);
    if (--found->second == 0) counts_.erase(found);
  }

 private:
  std::unordered_map<std::string, std::size_t> counts_;
};

/// One of the things that are counted by address, while it is there.
class AddressShare {
 public:
  AddressShare(AddressCounts& counts, std::string address, std::size_t most)
      : counts_(counts), address_(std::move(address)), is_granted_(counts_.take(address_, most)) {}
  ~AddressShare() {
    if (is_granted_) counts_.give_back(address_);
  }
  AddressShare(const AddressShare&) = delete;
  AddressShare& operator=(const AddressShare&) = delete;
  bool is_granted() const { return is_granted_; }

 private:
  AddressCounts& counts_;
  std::string address_;
  bool is_granted_;
};

/// The stream of a connection, shared with the listener so that stopping can close idle
/// connections.
struct Connection {
  Connection(boost::asio::ip::tcp::socket socket, TlsContext* tls)
      : stream(std::move(socket), tls) {}
  ClientStream stream;
  /// The activity of the connection and when it began; for the stream's executor only.
  enum class State : std::uint8_t { idle, receiving, answering };
  State state = State::idle;
  std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
  std::uint64_t body_bytes = 0;  // of the request that is being received
  bool makes_room = false;       // closed for another connection; its session has not ended yet
  /// Begins an activity; one that goes on keeps its beginning.
  void enter(State next) {
    if (state == next && next == State::idle) return;
    state = next;
    since = std::chrono::steady_clock::now();
    body_bytes = 0;
  }
  std::string peer;
};

/// The state that all sessions of a server share. It outlives them.
struct SessionEnvironment {
  SessionEnvironment(const ServerOptions& server_options, Application server_application,
                     LogLine server_log);

  /// The threads of a lane other than quick.
  LaneThreads& threads_of(Lane lane);

  ServerOptions options;
  Application application;
  LogLine log;
  LaneThreads computing;
  LaneThreads small;
  LaneThreads reading;
  LaneThreads items;
  Budget bodies;
  Budget downloads;
  Budget watchers;
  Budget uploads;
  boost::asio::thread_pool disk;  // where sinks take bodies
  std::atomic<bool> is_draining = false;
  std::atomic<bool> is_cancelled = false;
  std::atomic<std::size_t> sessions = 0;

  // For the I/O thread only.
  std::list<std::shared_ptr<Connection>> connections;  // those of the sessions
  AddressCounts connections_of;
  AddressCounts works_of;
  /// The keys of the works that are being done, each with the timer on which the sessions wait that
  /// are next.
  std::unordered_map<std::string, std::shared_ptr<boost::asio::steady_timer>> keys;
};

/// Serves one connection until it closes.
boost::asio::awaitable<void> run_session(std::shared_ptr<Connection> connection,
                                         SessionEnvironment& environment);

/// Sends `refusal` to a connection beyond a limit, whose request is not read, and closes it.
boost::asio::awaitable<void> refuse_session(std::shared_ptr<Connection> connection,
                                            Response refusal);

}  // namespace watertight::server
