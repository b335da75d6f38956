// SPDX-License-Identifier: GPL-3.0-or-later
//
// The worker's side of the socket.
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <new>
#include <system_error>
#include <thread>

#include "base/checksum.h"
#include "workers/frames.h"
#include "workers/worker_pool.h"

namespace watertight::workers {
namespace {

/// Reads exactly `count` bytes. False at the end of the stream.
bool receive(std::uint8_t* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t got = recv(kWorkerSocket, bytes, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

bool transmit(ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(kWorkerSocket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

bool transmit_reply(ReplyStatus status, ByteView payload) {
  ByteWriter header;
  header.u32(static_cast<std::uint32_t>(payload.size()));
  header.u32(crc32c(payload));
  header.u8(static_cast<std::uint8_t>(status));
  return transmit(header.bytes()) && transmit(payload);
}

/// Ends the process when the parent ends, which closes the socket: a job could run for long after
/// that.
void end_with_parent() {
  pollfd watched{kWorkerSocket, POLLRDHUP, 0};
  while (true) {
    const int ready = poll(&watched, 1, -1);
    if (ready > 0 && (watched.revents & (POLLRDHUP | POLLHUP | POLLERR | POLLNVAL)) != 0) break;
  }
  _exit(kExitParentGone);
}

void watch_parent() {
  if (const char* parent = std::getenv(kParentVariable)) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (std::to_string(getppid()) != parent) _exit(kExitParentGone);
  }
  try {
    std::thread(end_with_parent).detach();
  } catch (const std::system_error&) {
    // Without this thread the end of the stream and the limits still end the process.
  }
}

int idle_milliseconds() {
  const char* text = std::getenv(kIdleVariable);
  const long value = text != nullptr ? std::strtol(text, nullptr, 10) : 0;
  return value > 0 && value <= 2'000'000'000 ? static_cast<int>(value) : -1;
}

/// Waits for a job; false if no job came in time.
bool await_job(int milliseconds) {
  pollfd watched{kWorkerSocket, POLLIN, 0};
  int ready = 0;
  do {
    ready = poll(&watched, 1, milliseconds);
  } while (ready < 0 && errno == EINTR);
  return ready != 0;
}

struct Answer {
  ReplyStatus status = ReplyStatus::ok;
  Bytes payload;
};

Answer answer(const std::function<Bytes(ByteView)>& handle, ByteView request) {
  try {
    return {ReplyStatus::ok, handle(request)};
  } catch (const std::bad_alloc&) {
    return {ReplyStatus::out_of_memory, {}};
  } catch (const std::exception& exception) {
    const ByteView what = as_bytes(exception.what());
    return {ReplyStatus::exception, Bytes(what.begin(), what.end())};
  } catch (...) {
    return {ReplyStatus::exception, {}};
  }
}

}  // namespace

int serve_jobs(const std::function<Bytes(ByteView)>& handle) {
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);  // no program that it may start gets more rights
  watch_parent();
  const int idle = idle_milliseconds();
  while (true) {
    if (!await_job(idle)) return kExitIdle;
    std::array<std::uint8_t, kRequestHeader> header{};
    if (!receive(header.data(), header.size())) return kExitEndOfFile;
    ByteReader reader(header);
    const std::size_t length = reader.u32();
    const std::uint32_t checksum = reader.u32();
    Bytes request;
    try {
      request.resize(length);
    } catch (const std::bad_alloc&) {
      transmit_reply(ReplyStatus::out_of_memory, {});
      return kExitBadRequest;
    }
    if (!receive(request.data(), request.size())) return kExitEndOfFile;
    if (crc32c(request) != checksum) return kExitBadRequest;
    const Answer reply = answer(handle, request);
    if (!transmit_reply(reply.status, reply.payload)) return kExitEndOfFile;
    if (reply.status != ReplyStatus::ok) return kExitEndOfFile;
  }
}

}  // namespace watertight::workers
