// SPDX-License-Identifier: GPL-3.0-or-later
//
// The way in which a caller ends work that takes long.
#pragma once

#include <functional>

namespace watertight {

/// A function that long work calls now and then. It returns true when nobody wants the result any
/// more (time is up, the client has left, the service stops). Empty: the work is never ended.
using CancelPoll = std::function<bool()>;

}  // namespace watertight
