// SPDX-License-Identifier: GPL-3.0-or-later
//
// A worker that misbehaves on demand: the request names the fault. Any other request is returned
// unchanged.
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/checksum.h"
#include "workers/worker_pool.h"

namespace {

using watertight::Bytes;
using watertight::ByteView;
using watertight::ByteWriter;

void send_raw(ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(3, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;
    bytes = bytes.subspan(std::size_t(sent));
  }
}

[[noreturn]] void sleep_for_ever() {
  while (true) pause();
}

Bytes text_bytes(const std::string& text) {
  const ByteView view = watertight::as_bytes(text);
  return {view.begin(), view.end()};
}

/// The environment of the worker that tests examine, one item on each line.
Bytes surroundings() {
  std::string text;
  rlimit core{};
  getrlimit(RLIMIT_CORE, &core);
  text += "core=" + std::to_string(core.rlim_cur) + "\n";
  rlimit used{};
  getrlimit(RLIMIT_CPU, &used);
  text += "hard=" + std::string(used.rlim_max == RLIM_INFINITY ? "no" : "yes") + "\n";
  const int none = prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0);
  text += "privileges=" + std::string(none == 1 ? "no" : "yes") + "\n";
  text += "leader=" + std::string(getpgrp() == getpid() ? "yes" : "no") + "\n";
  text += "descriptors=";
  for (int descriptor = 0; descriptor < 1024; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) >= 0) text += std::to_string(descriptor) + ",";
  }
  text += "\n";
  for (int descriptor = 0; descriptor < 3; ++descriptor) {
    std::error_code failed;
    text += std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), failed)
                .string() +
            "\n";
  }
  std::ofstream file("file-in-the-directory");
  text += "writable=" + std::string(file.good() ? "yes" : "no") + "\n";
  sigset_t blocked;
  sigemptyset(&blocked);
  sigprocmask(SIG_SETMASK, nullptr, &blocked);
  text += "blocked=" + std::string(sigismember(&blocked, SIGUSR1) == 1 ? "yes" : "no") + "\n";
  text += "secret=" + std::string(std::getenv("WATERTIGHT_TEST_SECRET") ? "yes" : "no") + "\n";
  return text_bytes(text);
}

void send_header(std::uint32_t length, std::uint32_t checksum, std::uint8_t status) {
  ByteWriter header;
  header.u32(length);
  header.u32(checksum);
  header.u8(status);
  send_raw(header.bytes());
}

/// Overflows the stack: each call takes a page, and the function never returns.
int overflow_the_stack(int depth) {
  volatile char page[4096];
  page[depth % 4096] = static_cast<char>(depth);
  return depth > 0 ? overflow_the_stack(depth + 1) + page[0] : 0;
}

void misbehave_on_the_wire(const std::string& fault) {
  if (fault == "garbage") {
    send_raw(text_bytes("this is no frame at all, but long enough to look like one"));
    sleep_for_ever();
  }
  if (fault == "wrong-checksum") {
    send_header(4, 1, 0);
    send_raw(text_bytes("four"));
    sleep_for_ever();
  }
  if (fault == "huge-reply") {
    send_header(0xFFFFFFFF, 0, 0);
    sleep_for_ever();
  }
  if (fault == "half-reply") {
    send_header(1000, 0, 0);
    _exit(0);
  }
  if (fault == "killed-mid-frame") {
    send_header(1000, 0, 0);
    send_raw(text_bytes("the first of a thousand bytes"));
    raise(SIGKILL);
  }
  if (fault == "half-header") {
    send_raw(text_bytes("abc"));
    sleep_for_ever();
  }
  if (fault == "too-long") {
    send_header(4, 0, 0);
    send_raw(text_bytes("more than the four bytes announced"));
    sleep_for_ever();
  }
  if (fault == "flood") {
    send_header(1'000'000, 0, 0);
    const std::string chunk(1 << 16, 'x');
    while (true) send_raw(text_bytes(chunk));
  }
  if (fault == "unknown-status") {
    send_header(0, 0, 77);
    sleep_for_ever();
  }
  if (fault == "second-reply") {
    // The job gets its answer; another answer follows without a request.
    send_header(0, 0, 0);
    send_header(0, 0, 0);
    sleep_for_ever();
  }
  if (fault == "slow-drip") {
    send_header(100000, 0, 0);
    while (true) {
      send_raw(text_bytes("."));
      usleep(2000);
    }
  }
}

Bytes handle(ByteView request) {
  const std::string fault(
      watertight::as_text(request.first(std::min<std::size_t>(request.size(), 40))));
  misbehave_on_the_wire(fault);
  if (fault == "crash") raise(SIGSEGV);
  if (fault == "abort") std::abort();
  if (fault == "exit") _exit(7);
  if (fault == "hang") sleep_for_ever();
  if (fault == "spin") {
    while (getpid() > 0) {
    }
  }
  if (fault == "burn") {
    const std::clock_t start = std::clock();
    while (std::clock() - start < CLOCKS_PER_SEC / 10) {
    }
    return text_bytes("burnt");
  }
  if (fault == "orphan") {
    // The child process keeps the socket open and lives on, unless the whole process group is
    // killed.
    if (fork() == 0) sleep_for_ever();
    _exit(5);
  }
  if (fault == "child") {
    const pid_t child = fork();
    if (child == 0) sleep_for_ever();
    return text_bytes(std::to_string(child));
  }
  if (fault == "memory") return Bytes(std::size_t{8} << 30);
  if (fault == "memory-bit-by-bit") {
    std::vector<Bytes> kept;
    while (true) kept.emplace_back(std::size_t{1} << 20, std::uint8_t{1});
  }
  if (fault == "stack") std::_Exit(overflow_the_stack(1));
  if (fault == "exception") throw std::runtime_error("thrown on purpose");
  if (fault == "surroundings") return surroundings();
  if (fault == "process") return text_bytes(std::to_string(getpid()));
  return {request.begin(), request.end()};
}

}  // namespace

int main() { return watertight::workers::serve_jobs(handle); }
