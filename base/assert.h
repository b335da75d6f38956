// SPDX-License-Identifier: GPL-3.0-or-later
//
// WATERTIGHT_ASSERT(condition): a contract between parts of this program. Checked in Debug, fuzz
// and sanitizer builds, where a broken contract prints the place and aborts; free in Release.
// Never for input: bad input is an Error or a Finding.
#pragma once

namespace watertight {
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);
}

#ifdef WATERTIGHT_CHECKED
#define WATERTIGHT_ASSERT(condition)  \
  ((condition) ? static_cast<void>(0) \
               : ::watertight::assertion_failed(#condition, __FILE__, __LINE__))
#else
#define WATERTIGHT_ASSERT(condition) static_cast<void>(sizeof(!(condition)))
#endif
