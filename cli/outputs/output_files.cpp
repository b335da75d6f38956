// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs/output_files.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace watertight::cli {
namespace {

/// A request to the process that keeps the rights: to open the next file, or to give a file its
/// name.
struct Request {
  enum class Kind : std::uint8_t { open, commit };
  Kind kind = Kind::open;
  std::uint32_t number = 0;
};

/// Its answer; that to `open` comes with the file's descriptor.
struct WriterAnswer {
  bool is_done = false;
  std::array<char, 256> reason{};  // ends with a zero byte
};

WriterAnswer answer_of(const Status& status) {
  WriterAnswer answer;
  answer.is_done = status.has_value();
  if (!status) {
    const std::string& message = status.error().message;
    std::copy_n(message.begin(), std::min(message.size(), answer.reason.size() - 1),
                answer.reason.begin());
  }
  return answer;
}

/// A message of one descriptor and the bytes of `answer`, as sendmsg() and recvmsg() take it.
class Message {
 public:
  explicit Message(WriterAnswer& answer) {
    part_ = {&answer, sizeof(answer)};
    header_.msg_iov = &part_;
    header_.msg_iovlen = 1;
    header_.msg_control = control_.data();
    header_.msg_controllen = control_.size();
  }
  Message(const Message&) = delete;
  Message& operator=(const Message&) = delete;
  msghdr* header() { return &header_; }
  void set(int descriptor) {
    cmsghdr* const control = CMSG_FIRSTHDR(&header_);
    control->cmsg_level = SOL_SOCKET;
    control->cmsg_type = SCM_RIGHTS;
    control->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(control), &descriptor, sizeof(int));
  }
  void set_none() {
    header_.msg_control = nullptr;
    header_.msg_controllen = 0;
  }
  /// The descriptor that came, -1 if none did.
  int descriptor() {
    const cmsghdr* const control = CMSG_FIRSTHDR(&header_);
    if (control == nullptr || control->cmsg_type != SCM_RIGHTS) return -1;
    int descriptor = -1;
    std::memcpy(&descriptor, CMSG_DATA(control), sizeof(int));
    return descriptor;
  }

 private:
  iovec part_{};
  msghdr header_{};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control_{};
};

/// Repeats a system call that signals interrupt.
template <class Call>
ssize_t until_done(Call call) {
  for (;;) {
    const ssize_t result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

/// The work of the process that keeps the rights: it ends when nobody has the other socket any
/// more, and files that have no name then are gone.
void keep_rights(int socket, const std::string& output) {
  // Signals for the group of processes are for the other one, whose end ends this one.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  std::vector<files::FileWriter> files;
  Request request;
  while (until_done([&] { return ::recv(socket, &request, sizeof(request), MSG_WAITALL); }) ==
         static_cast<ssize_t>(sizeof(request))) {
    Status status = Done{};
    int descriptor = -1;
    if (request.kind == Request::Kind::open && files.size() < OutputFiles::kMost) {
      auto file = files::FileWriter::open(files::numbered_name(output, files.size()));
      if (file) {
        descriptor = file->descriptor();
        files.push_back(*std::move(file));
      } else {
        status = std::move(file).error();
      }
    } else if (request.kind == Request::Kind::commit && request.number < files.size()) {
      status = files[request.number].commit();
    } else {
      break;
    }
    WriterAnswer answer = answer_of(status);
    Message message(answer);
    if (descriptor >= 0) {
      message.set(descriptor);
    } else {
      message.set_none();
    }
    if (until_done([&] { return ::sendmsg(socket, message.header(), 0); }) < 0) break;
  }
}

/// The process that keeps the rights, seen from the one that gives them up.
class Keeper {
 public:
  static Result<Keeper> start(const std::string& output) {
    std::array<int, 2> sockets{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) return failed();
    const pid_t process = ::fork();
    if (process == 0) {
      ::close(sockets[0]);
      keep_rights(sockets[1], output);
      ::_exit(0);
    }
    ::close(sockets[1]);
    if (process > 0) return Keeper(sockets[0], process);
    ::close(sockets[0]);
    return failed();
  }
  Keeper(Keeper&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), process_(other.process_) {}
  Keeper& operator=(Keeper&&) = delete;
  ~Keeper() {
    if (socket_ < 0) return;
    ::close(socket_);
    until_done([&] { return ::waitpid(process_, nullptr, 0); });
  }

  /// Opens the next file and returns its descriptor.
  Result<int> open() {
    int descriptor = -1;
    if (Status status = ask({Request::Kind::open, 0}, &descriptor); !status) return status.error();
    if (descriptor < 0) return Error{ErrorCode::unavailable, "no file came"};
    return descriptor;
  }
  Status commit(std::size_t number) {
    return ask({Request::Kind::commit, static_cast<std::uint32_t>(number)}, nullptr);
  }

 private:
  Keeper(int socket, pid_t process) : socket_(socket), process_(process) {}
  static Error failed() { return Error{ErrorCode::unavailable, std::strerror(errno)}; }

  Status ask(const Request& request, int* descriptor) {
    WriterAnswer answer;
    Message message(answer);
    const bool is_answered =
        until_done([&] { return ::send(socket_, &request, sizeof(request), MSG_NOSIGNAL); }) ==
            static_cast<ssize_t>(sizeof(request)) &&
        until_done([&] {
          return ::recvmsg(socket_, message.header(), MSG_WAITALL | MSG_CMSG_CLOEXEC);
        }) == static_cast<ssize_t>(sizeof(answer));
    if (!is_answered) {
      return Error{ErrorCode::unavailable, "the process that keeps the rights to write has ended"};
    }
    if (descriptor != nullptr) *descriptor = message.descriptor();
    if (answer.is_done) return Done{};
    answer.reason.back() = '\0';
    return Error{ErrorCode::unavailable, answer.reason.data()};
  }

  int socket_;
  pid_t process_;
};

}  // namespace

struct OutputFiles::State {
  std::string output;
  std::optional<Keeper> keeper;
  std::vector<files::FileWriter> files;
};

OutputFiles::OutputFiles(std::unique_ptr<State> state) : state_(std::move(state)) {}
OutputFiles::OutputFiles(OutputFiles&&) noexcept = default;
OutputFiles::~OutputFiles() = default;

Result<OutputFiles> OutputFiles::open(const std::string& output, bool gives_up_rights) {
  OutputFiles files(std::make_unique<State>());
  files.state_->output = output;
  if (gives_up_rights && output != "-") {
    auto keeper = Keeper::start(output);
    if (!keeper) return std::move(keeper).error();
    files.state_->keeper.emplace(*std::move(keeper));
  }
  if (Status added = files.add(); !added) return std::move(added).error();
  return files;
}

Status OutputFiles::add() {
  if (size() == kMost || (size() == 1 && state_->output == "-")) {
    return Error{ErrorCode::limit_exceeded,
                 state_->output == "-" ? std::string("standard output takes one file only")
                                       : "there are more than " + std::to_string(kMost) + " files"};
  }
  if (!state_->keeper) {
    auto file = files::FileWriter::open(files::numbered_name(state_->output, size()));
    if (!file) return std::move(file).error();
    state_->files.push_back(*std::move(file));
    return Done{};
  }
  const auto descriptor = state_->keeper->open();
  if (!descriptor) return descriptor.error();
  state_->files.push_back(files::FileWriter::to(*descriptor));
  return Done{};
}

std::size_t OutputFiles::size() const { return state_->files.size(); }

std::string OutputFiles::name(std::size_t number) const {
  return state_->output == "-" ? "standard output" : files::numbered_name(state_->output, number);
}

Status OutputFiles::write(std::size_t number, std::string_view text) {
  return state_->files[number].write(text);
}

Status OutputFiles::commit() {
  for (std::size_t i = 0; i < size(); ++i) {
    Status status = state_->files[i].commit();
    if (status && state_->keeper) status = state_->keeper->commit(i);
    if (status) continue;
    Error error = std::move(status).error();
    error.message.insert(0, name(i) + ": ");
    return error;
  }
  return Done{};
}

}  // namespace watertight::cli
