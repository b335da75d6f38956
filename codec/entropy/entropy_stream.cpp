// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/entropy/entropy_stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "base/assert.h"

namespace watertight::codec {
namespace {

constexpr std::uint32_t kHalf = 32768;
constexpr std::size_t kWindow = 4;  // the number of bytes that a reader keeps ahead

/// Between two questions whether the work is cancelled lie so many decisions as have this cost:
/// less than a millisecond.
constexpr std::uint64_t kCostOfPause = std::uint64_t{4096} << kCostBits;

/// The last bytes of a stream: the shortest ones that, followed by zeros, lie in [low, high]; of
/// those the smallest.
struct Tail {
  std::array<std::uint8_t, kWindow> bytes{};
  std::size_t size = 0;
};

Tail shortest_tail(std::uint32_t low, std::uint32_t high) {
  Tail tail;
  for (std::size_t size = 0; size <= kWindow; ++size) {
    const std::uint64_t unit = std::uint64_t{1} << (8 * (kWindow - size));
    const std::uint64_t value = (low + unit - 1) / unit * unit;
    if (value > high) continue;
    tail.size = size;
    for (std::size_t i = 0; i < size; ++i) {
      tail.bytes[i] = static_cast<std::uint8_t>(value >> (8 * (kWindow - 1 - i)));
    }
    break;
  }
  return tail;
}

/// log2(65536 / ones) in 1/65536 bit, by repeated squaring.
constexpr std::uint32_t cost_of(std::uint32_t ones) {
  int whole = 0;
  std::uint64_t mantissa = static_cast<std::uint64_t>(ones) << 15;  // ones / 65536 in units of
                                                                    // 2^-31
  while (mantissa < (std::uint64_t{1} << 31)) {
    mantissa <<= 1;
    ++whole;
  }
  std::uint32_t fraction = 0;  // the fraction of log2(mantissa / 2^31)
  for (int i = 0; i < kCostBits; ++i) {
    mantissa = (mantissa * mantissa) >> 31;
    fraction <<= 1;
    if (mantissa >= (std::uint64_t{1} << 32)) {
      mantissa >>= 1;
      fraction |= 1U;
    }
  }
  return (static_cast<std::uint32_t>(whole) << kCostBits) - fraction;
}

/// The costs of answers by the upper 12 bits of their probability, computed for the middle of the
/// 16 probabilities that share these bits.
constexpr auto kCosts = [] {
  std::array<std::uint32_t, 4096> costs{};
  for (std::uint32_t i = 0; i < costs.size(); ++i) costs[i] = cost_of(16 * i + 8);
  return costs;
}();

}  // namespace

EntropyStream::EntropyStream(Direction direction, ByteView source)
    : direction_(direction), source_(source) {
  if (direction_ != Direction::read) return;
  for (std::size_t i = 0; i < kWindow; ++i) window_ = (window_ << 8) | next_byte();
}

std::uint32_t EntropyStream::next_byte() {
  const std::uint32_t byte = position_ < source_.size() ? source_[position_] : 0U;
  ++position_;
  if (position_ > source_.size() + kWindow) failed_ = true;
  return byte;
}

void EntropyStream::heed(const Limits& limits) {
  cancel_ = limits.cancel;
  if (cancel_ != nullptr) pause_ = cost_;
}

bool EntropyStream::is_over() const {
  if (cost_ >= limit_) return true;
  if (cancel_ == nullptr) return false;
  if (*cancel_ && (*cancel_)()) return true;
  pause_ = std::min(limit_, cost_ + kCostOfPause);
  return false;
}

void EntropyStream::shift_out() {
  while (((low_ ^ high_) >> 24) == 0) {
    if (direction_ == Direction::write) {
      bytes_.push_back(static_cast<std::uint8_t>(low_ >> 24));
    } else {
      window_ = (window_ << 8) | next_byte();
    }
    low_ <<= 8;
    high_ = (high_ << 8) | 0xFFU;
  }
}

void EntropyStream::add_cost(bool value, std::uint32_t ones_of_65536) {
  const std::uint32_t cost = kCosts[(value ? ones_of_65536 : 65536 - ones_of_65536) >> 4];
  cost_ += cost;
  costs_[part_] += cost;
}

bool EntropyStream::code_known(bool value, std::uint32_t ones_of_65536) {
  if (failed_) return false;
  if (direction_ == Direction::write) {
    const std::uint32_t middle = split(ones_of_65536);
    if (value) {
      high_ = middle;
    } else {
      low_ = middle + 1;
    }
    shift_out();
  }
  if (is_recording_) {
    decisions_.push_back(
        {static_cast<std::uint16_t>(ones_of_65536), value, static_cast<std::uint8_t>(part_)});
  }
  add_cost(value, ones_of_65536);
  return value;
}

void EntropyStream::append(const EntropyStream& recorder) {
  WATERTIGHT_ASSERT(!is_reading() && recorder.is_recording_);
  for (const Decision& decision : recorder.decisions_) {
    if (failed()) return;
    part_ = decision.part;
    code(decision.value, decision.ones_of_65536);
  }
}

std::uint64_t EntropyStream::code_bits(std::uint64_t value, int count) {
  std::uint64_t result = 0;
  for (int i = count - 1; i >= 0; --i) {
    result = (result << 1) | static_cast<std::uint64_t>(code(((value >> i) & 1U) != 0, kHalf));
  }
  return result;
}

/// Codes a number of so few bits that each has a part of the interval of the same width.
std::uint32_t EntropyStream::code_chunk(std::uint32_t value, int count) {
  const std::uint32_t width = (high_ - low_) >> static_cast<unsigned>(count);
  const std::uint32_t last = (std::uint32_t{1} << static_cast<unsigned>(count)) - 1;
  const std::uint32_t result = is_reading() ? std::min((window_ - low_) / width, last) : value;
  low_ += result * width;
  if (result != last) high_ = low_ + width - 1;
  shift_out();
  return result;
}

std::uint64_t EntropyStream::code_plain_bits(std::uint64_t value, int count) {
  constexpr int kChunk = 8;
  constexpr std::uint32_t kWide = 1U << 16U;
  std::uint64_t result = 0;
  while (count > 0) {
    const int bits = std::min(count, kChunk);
    count -= bits;
    const auto chunk = static_cast<std::uint32_t>((value >> static_cast<unsigned>(count)) &
                                                  ((1U << static_cast<unsigned>(bits)) - 1));
    const bool is_wide = direction_ != Direction::measure && !failed_ && high_ - low_ >= kWide;
    result = (result << static_cast<unsigned>(bits)) |
             (is_wide ? code_chunk(chunk, bits) : code_bits(chunk, bits));
    if (is_wide && has_costs_) cost_ += static_cast<std::uint64_t>(bits) << kCostBits;
  }
  return result;
}

std::uint64_t EntropyStream::code_uniform(std::uint64_t value, std::uint64_t size) {
  WATERTIGHT_ASSERT(size > 0 && (is_reading() || value < size));
  // Truncated binary: the first `shorts` values take one bit less than the others.
  const int width = static_cast<int>(std::bit_width(size)) - 1;
  const std::uint64_t shorts = (std::uint64_t{2} << width) - size;
  const bool is_short = value < shorts;
  const std::uint64_t word = is_short ? value : (value + shorts) >> 1;
  const std::uint64_t front = code_bits(word, width);
  if (is_reading() ? front < shorts : is_short) return front;
  return ((front << 1) | code_bits((value + shorts) & 1U, 1)) - shorts;
}

Bytes EntropyStream::finish() && {
  const Tail tail = shortest_tail(low_, high_);
  bytes_.insert(bytes_.end(), tail.bytes.begin(), tail.bytes.begin() + tail.size);
  return std::move(bytes_);
}

bool EntropyStream::is_finished() const {
  if (failed_) return false;
  const Tail tail = shortest_tail(low_, high_);
  const ByteView rest = source_.subspan(std::min(position_ - kWindow, source_.size()));
  return std::equal(rest.begin(), rest.end(), tail.bytes.begin(), tail.bytes.begin() + tail.size);
}

}  // namespace watertight::codec
