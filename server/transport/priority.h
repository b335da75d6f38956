// SPDX-License-Identifier: GPL-3.0-or-later
//
// The priority of threads that compute long.
#pragma once

namespace watertight::server {

/// Makes the scheduler prefer other threads to this one, so that long computing does not delay
/// short requests when there are more threads than cores. Threads that it starts inherit that.
void step_back();

}  // namespace watertight::server
