// SPDX-License-Identifier: GPL-3.0-or-later
//
// How work that takes long is called off.
#pragma once

#include <functional>

namespace watertight {

/// Asked now and then by work that may take long: true when its result is no longer wanted (time is
/// up, the client has left, the service stops). Empty: the work is never called off.
using CancelPoll = std::function<bool()>;

}  // namespace watertight
