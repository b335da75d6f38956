// SPDX-License-Identifier: GPL-3.0-or-later
//
// Memory of one call for containers that end with it.
#pragma once

#include <array>
#include <cstddef>
#include <memory_resource>

namespace watertight {

/// Gives a block on the stack first, which is all that small inputs need, then memory of the heap.
/// What is given back is free again when the object ends, and not before.
class WorkMemory {
 public:
  std::pmr::memory_resource* get() { return &resource_; }

 private:
  alignas(std::max_align_t) std::array<std::byte, 8192> block_;
  std::pmr::monotonic_buffer_resource resource_{block_.data(), block_.size()};
};

}  // namespace watertight
