// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/priority.h"

#include <sys/resource.h>

namespace watertight::server {

void step_back() {
  constexpr int kNice = 10;
  thread_local const bool has_stepped_back = setpriority(PRIO_PROCESS, 0, kNice) == 0;
  static_cast<void>(has_stepped_back);  // without success the thread computes as any other does
}

}  // namespace watertight::server
