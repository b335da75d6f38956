// SPDX-License-Identifier: GPL-3.0-or-later
//
// Replaces geometry/parallel.cpp where there are no threads.
#include "geometry/parallel.h"

namespace watertight::geometry {

void for_each_piece(std::size_t count, unsigned /*threads*/,
                    const std::function<void(std::size_t, bool)>& work,
                    const std::function<void()>& /*wait*/) {
  for (std::size_t i = 0; i < count; ++i) work(i, true);
}

}  // namespace watertight::geometry
