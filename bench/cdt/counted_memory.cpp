// SPDX-License-Identifier: GPL-3.0-or-later
#include "counted_memory.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> held{0};
std::atomic<std::size_t> most_held{0};
std::size_t held_before = 0;

void* count(void* block) {
  if (block == nullptr) return nullptr;
  const std::size_t now = held += malloc_usable_size(block);
  if (now > most_held) most_held = now;
  return block;
}

void* count_or_end(void* block) {
  if (block == nullptr) std::abort();
  return count(block);
}

}  // namespace

void* operator new(std::size_t size) { return count_or_end(std::malloc(size)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return count(std::malloc(size));
}
void* operator new(std::size_t size, std::align_val_t align) {
  const auto step = static_cast<std::size_t>(align);
  return count_or_end(std::aligned_alloc(step, (size + step - 1) / step * step));
}
void operator delete(void* block) noexcept {
  held -= malloc_usable_size(block);
  std::free(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept { operator delete(block); }
void operator delete(void* block, std::size_t) noexcept { operator delete(block); }
void operator delete(void* block, std::align_val_t) noexcept { operator delete(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  operator delete(block);
}

namespace watertight::bench {

void count_bytes_from_here() {
  held_before = held;
  most_held = held_before;
}

std::size_t most_bytes_held() { return most_held - held_before; }

}  // namespace watertight::bench
