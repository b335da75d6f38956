// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads bits for the marks and the facets of mode bitmap: either plain, eight to a byte,
// or through an adaptive binary arithmetic coder. Its models and arithmetic use integers only, so
// that every compiler and machine writes the same bytes. Source: the carry-less coder of
// M. Mahoney's lpaq (32-bit interval, 16-bit probabilities).
#pragma once

#include <cstdint>

#include "base/bytes.h"

namespace watertight::codec::bitmap {

enum class BitCoding : std::uint8_t { plain = 0, arithmetic = 1 };

/// The probability of a 1, learned from the bits so far. It moves fast at first, and becomes a
/// moving average later.
class AdaptiveBit {
 public:
  /// `ones_of_65536` is the first estimate, 32 to 65504; `confidence` is the number of observations
  /// that the estimate is worth (0 to 30).
  constexpr AdaptiveBit() : AdaptiveBit(32768, 0) {}
  constexpr AdaptiveBit(std::uint32_t ones_of_65536, std::uint32_t confidence)
      : ones_(ones_of_65536), count_(confidence) {}
  std::uint32_t ones_of_65536() const { return ones_; }
  void learn(bool bit);

 private:
  std::uint32_t ones_;
  std::uint32_t count_;
};

/// Writes bits. Cost: constant per bit.
class BitEncoder {
 public:
  explicit BitEncoder(BitCoding coding) : coding_(coding) {}
  /// Writes one bit under a model. A plain encoder ignores the model.
  void bit(bool value, AdaptiveBit& model);
  /// Writes a number in unary: one 1 for each unit, then a 0, each under `model`.
  void unary(std::uint64_t value, AdaptiveBit& model);
  /// Ends the stream.
  Bytes finish() &&;

 private:
  void raw_bit(bool value);
  void narrow(bool value, std::uint32_t ones_of_65536);

  BitCoding coding_;
  Bytes bytes_;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = 0xFFFFFFFFU;
  std::uint32_t pending_ = 0;  // plain: bits of the unfinished byte
  int pending_count_ = 0;
};

/// Reads the bits that a BitEncoder wrote. Past the end the decoder returns zeros, and failed()
/// becomes true. Callers bound their loops themselves, and ask failed() at the end and in every
/// loop that could be long.
class BitDecoder {
 public:
  BitDecoder(ByteView bytes, BitCoding coding);
  bool bit(AdaptiveBit& model);
  /// Reads a number in unary. Fails if it is above `limit`.
  std::uint64_t unary(std::uint64_t limit, AdaptiveBit& model);
  bool failed() const { return failed_; }
  /// True if no read failed and the bytes end exactly as an encoder would have ended them.
  bool is_finished() const;

 private:
  bool raw_bit();
  bool narrow(std::uint32_t ones_of_65536);
  std::uint32_t next_byte();

  ByteView bytes_;
  BitCoding coding_;
  std::size_t position_ = 0;  // bytes read, counting those past the end
  std::uint32_t low_ = 0;
  std::uint32_t high_ = 0xFFFFFFFFU;
  std::uint32_t code_ = 0;
  int bit_position_ = 0;  // plain: the index of the next bit of bytes_[position_]
  bool failed_ = false;
};

}  // namespace watertight::codec::bitmap
