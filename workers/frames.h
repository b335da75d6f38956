// SPDX-License-Identifier: GPL-3.0-or-later
//
// The frames on the socket between a pool and its processes, and the constants that both sides use.
// Private to workers/.
//
//   request:  u32 payload length | u32 CRC-32C of the payload | payload
//   reply:    u32 payload length | u32 CRC-32C of the payload | u8 ReplyStatus | payload
//
// Integers are little-endian.
#pragma once

#include <cstddef>
#include <cstdint>

namespace watertight::workers {

inline constexpr int kWorkerSocket = 3;
inline constexpr std::size_t kRequestHeader = 8;
inline constexpr std::size_t kReplyHeader = 9;

enum class ReplyStatus : std::uint8_t { ok = 0, out_of_memory = 1, exception = 2 };

/// Exit statuses of a process that ended by itself.
inline constexpr int kExitEndOfFile = 0;
inline constexpr int kExitBadRequest = 97;
inline constexpr int kExitIdle = 98;  // idle, before the first byte of a request
inline constexpr int kExitParentGone = 99;

/// Environment variables that a pool sets for its processes.
inline constexpr const char* kIdleVariable = "WATERTIGHT_WORKER_IDLE_MS";
inline constexpr const char* kParentVariable = "WATERTIGHT_WORKER_PARENT";

}  // namespace watertight::workers
