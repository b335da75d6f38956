// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: M. Mahoney, lpaq1 (2007), the carry-less binary arithmetic coder.
// Departures: probabilities have 16 bits; the last bytes are the shortest ones inside the interval;
// a decoder that runs past the end fails.
#include "codec/mode_bitmap/bit_coder.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace watertight::codec::bitmap {
namespace {

constexpr std::uint32_t kLeast = 32;  // in 1/65536: to code a bit takes 1/1400 to 11 bits
constexpr std::uint32_t kLongestMemory = 30;

// The rate is 65536 / (count + 1.6): the first observation moves the estimate by 0.62 of the error,
// the 31st and all later ones by 1/32.
constexpr std::array<std::uint32_t, kLongestMemory + 1> make_rates() {
  std::array<std::uint32_t, kLongestMemory + 1> rates{};
  for (std::uint32_t count = 0; count <= kLongestMemory; ++count) {
    rates[count] = 655360U / (count * 10U + 16U);
  }
  return rates;
}
constexpr auto kRates = make_rates();

// An arithmetic stream ends inside the four bytes that the decoder keeps ahead.
constexpr std::size_t kLookahead = 4;

std::uint32_t split(std::uint32_t low, std::uint32_t high, std::uint32_t ones_of_65536) {
  const std::uint64_t range = std::uint64_t{high} - low;
  return low + static_cast<std::uint32_t>((range * ones_of_65536) >> 16);
}

/// The last bytes of an arithmetic stream: the shortest ones that, followed by zeros, lie in
/// [low, high], and of those the smallest. (The decoder reads zeros past the end.)
struct Tail {
  std::array<std::uint8_t, kLookahead> bytes{};
  std::ptrdiff_t size = 0;
};

Tail shortest_tail(std::uint32_t low, std::uint32_t high) {
  Tail tail;
  std::uint64_t value = 0;
  while (value < low || value > high) {
    ++tail.size;
    const std::uint64_t unit = std::uint64_t{1} << (32 - 8 * tail.size);
    value = (std::uint64_t{low} + unit - 1) / unit * unit;
  }
  for (std::size_t i = 0; i < kLookahead; ++i) {
    tail.bytes[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  }
  return tail;
}

}  // namespace

void AdaptiveBit::learn(bool bit) {
  const std::uint32_t rate = kRates[count_];
  if (bit) {
    ones_ += static_cast<std::uint32_t>((std::uint64_t{65536U - ones_} * rate) >> 16);
    if (ones_ > 65536U - kLeast) ones_ = 65536U - kLeast;
  } else {
    ones_ -= static_cast<std::uint32_t>((std::uint64_t{ones_} * rate) >> 16);
    if (ones_ < kLeast) ones_ = kLeast;
  }
  if (count_ < kLongestMemory) ++count_;
}

void BitEncoder::raw_bit(bool value) {
  pending_ |= static_cast<std::uint32_t>(value) << pending_count_;
  if (++pending_count_ == 8) {
    bytes_.push_back(static_cast<std::uint8_t>(pending_));
    pending_ = 0;
    pending_count_ = 0;
  }
}

void BitEncoder::narrow(bool value, std::uint32_t ones_of_65536) {
  const std::uint32_t middle = split(low_, high_, ones_of_65536);
  if (value) {
    high_ = middle;
  } else {
    low_ = middle + 1;
  }
  while (((low_ ^ high_) >> 24) == 0) {
    bytes_.push_back(static_cast<std::uint8_t>(high_ >> 24));
    low_ <<= 8;
    high_ = (high_ << 8) | 0xFFU;
  }
}

void BitEncoder::bit(bool value, AdaptiveBit& model) {
  if (coding_ == BitCoding::plain) {
    raw_bit(value);
    return;
  }
  narrow(value, model.ones_of_65536());
  model.learn(value);
}

void BitEncoder::unary(std::uint64_t value, AdaptiveBit& model) {
  for (std::uint64_t i = 0; i < value; ++i) bit(true, model);
  bit(false, model);
}

Bytes BitEncoder::finish() && {
  if (coding_ == BitCoding::plain) {
    if (pending_count_ > 0) bytes_.push_back(static_cast<std::uint8_t>(pending_));
    return std::move(bytes_);
  }
  const Tail tail = shortest_tail(low_, high_);
  bytes_.insert(bytes_.end(), tail.bytes.begin(), tail.bytes.begin() + tail.size);
  return std::move(bytes_);
}

BitDecoder::BitDecoder(ByteView bytes, BitCoding coding) : bytes_(bytes), coding_(coding) {
  if (coding_ == BitCoding::plain) return;
  for (std::size_t i = 0; i < kLookahead; ++i) code_ = (code_ << 8) | next_byte();
}

std::uint32_t BitDecoder::next_byte() {
  const std::uint32_t byte = position_ < bytes_.size() ? bytes_[position_] : 0U;
  ++position_;
  if (position_ > bytes_.size() + kLookahead) failed_ = true;
  return byte;
}

bool BitDecoder::raw_bit() {
  if (position_ >= bytes_.size()) {
    failed_ = true;
    return false;
  }
  const bool value = ((bytes_[position_] >> bit_position_) & 1U) != 0;
  if (++bit_position_ == 8) {
    bit_position_ = 0;
    ++position_;
  }
  return value;
}

bool BitDecoder::narrow(std::uint32_t ones_of_65536) {
  if (failed_) return false;
  const std::uint32_t middle = split(low_, high_, ones_of_65536);
  const bool value = code_ <= middle;
  if (value) {
    high_ = middle;
  } else {
    low_ = middle + 1;
  }
  while (((low_ ^ high_) >> 24) == 0) {
    low_ <<= 8;
    high_ = (high_ << 8) | 0xFFU;
    code_ = (code_ << 8) | next_byte();
  }
  return value;
}

bool BitDecoder::bit(AdaptiveBit& model) {
  if (coding_ == BitCoding::plain) return raw_bit();
  const bool value = narrow(model.ones_of_65536());
  model.learn(value);
  return value;
}

std::uint64_t BitDecoder::unary(std::uint64_t limit, AdaptiveBit& model) {
  for (std::uint64_t value = 0; value <= limit; ++value) {
    if (!bit(model)) return value;
    if (failed_) break;
  }
  failed_ = true;
  return 0;
}

bool BitDecoder::is_finished() const {
  if (failed_) return false;
  if (coding_ == BitCoding::arithmetic) {
    const Tail tail = shortest_tail(low_, high_);
    const ByteView rest = bytes_.subspan(std::min(position_ - kLookahead, bytes_.size()));
    return std::equal(rest.begin(), rest.end(), tail.bytes.begin(), tail.bytes.begin() + tail.size);
  }
  if (bit_position_ == 0) return position_ == bytes_.size();
  const bool is_last = position_ + 1 == bytes_.size();
  return is_last && (bytes_[position_] >> bit_position_) == 0;
}

}  // namespace watertight::codec::bitmap
