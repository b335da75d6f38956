// SPDX-License-Identifier: GPL-3.0-or-later
//
// The limits of a call of the bridge (sql/bridge.h), and how it fills its reply.
#pragma once

#include <chrono>
#include <exception>
#include <new>
#include <string_view>

#include "base/bytes.h"
#include "base/cancel.h"
#include "base/limits.h"
#include "base/result.h"
#include "sql/bridge.h"

namespace watertight::sql {

/// Makes the reply a failure. The message is cut off between characters where it is too long.
void fail(wt_reply* reply, std::string_view state, std::string_view message,
          std::string_view detail = {}) noexcept;
/// The same with the SQLSTATE of an error.
void fail(wt_reply* reply, const Error& error);
/// Gives the reply its value, or makes it a failure where a value cannot be as long.
void answer(wt_reply* reply, ByteView bytes);

/// Runs `work`; whatever it throws becomes a failure of the reply.
template <class Work>
void guarded(wt_reply* reply, const Work& work) noexcept {
  try {
    work();
  } catch (const std::bad_alloc&) {
    fail(reply, "53200", "out of memory");
  } catch (const std::exception& exception) {
    fail(reply, "XX000", exception.what());
  } catch (...) {
    fail(reply, "XX000", "an unknown exception");
  }
}

inline ByteView bytes_of(const wt_job& job) { return {job.bytes, job.size}; }

/// The limits that the settings watertight.max_seconds and watertight.max_memory set for a call.
class CallLimits {
 public:
  explicit CallLimits(const wt_job& job) : job_(job) {}
  CallLimits(const CallLimits&) = delete;  // limits and polls that it gave refer to it
  CallLimits& operator=(const CallLimits&) = delete;

  /// The limits of what is read, within the built-in ones; they end the work when it must end.
  Limits of_input() const;

  std::uint64_t memory_bytes() const { return std::uint64_t{job_.max_memory} << 20; }

  bool is_late() const {
    return job_.max_seconds > 0 && Clock::now() - start_ >= std::chrono::seconds(job_.max_seconds);
  }

  const CancelPoll& poll() const { return poll_; }

  /// The reason why the call must end now, if it must.
  Status check() const;

  /// An error of a reader or decoder, which names the setting if it is what limits.
  Error of_reading(Error error) const;

 private:
  using Clock = std::chrono::steady_clock;
  bool is_interrupted() const { return job_.poll != nullptr && job_.poll(); }

  const wt_job& job_;
  Clock::time_point start_ = Clock::now();
  CancelPoll poll_ = [this] { return is_late() || is_interrupted(); };
};

}  // namespace watertight::sql
