// SPDX-License-Identifier: GPL-3.0-or-later
//
// One stream of binary decisions through an arithmetic coder, in one of three directions: it is
// written, read, or only measured. Each part of the format is one function for all three
// directions. The function hands each decision to the stream, with the true value unless it reads,
// and goes on with the value that the stream returns. All arithmetic is on integers. Source: the
// carry-less coder of M. Mahoney's lpaq (32-bit interval).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/assert.h"
#include "base/bytes.h"
#include "base/limits.h"

namespace watertight::codec {

/// The parts of a stream, for reports on sizes.
enum class StreamPart : std::uint8_t { frame, position, connectivity, facets, coordinates, order };
inline constexpr std::size_t kStreamParts = 6;
using StreamCosts = std::array<std::uint64_t, kStreamParts>;

/// Costs are in units of 2^-kCostBits bit: in 1/65536 bit.
inline constexpr int kCostBits = 16;

class EntropyStream {
 public:
  static EntropyStream writer() { return EntropyStream(Direction::write, {}); }
  /// A meter fails once its cost reaches `limit`, so that whoever looks for less can stop.
  static EntropyStream meter(std::uint64_t limit = ~std::uint64_t{0}) {
    EntropyStream stream(Direction::measure, {});
    stream.limit_ = stream.pause_ = limit;
    return stream;
  }
  /// A meter that also keeps its decisions, for append(). Memory: 4 bytes a decision.
  static EntropyStream recorder(std::uint64_t limit = ~std::uint64_t{0}) {
    EntropyStream stream = meter(limit);
    stream.is_recording_ = true;
    return stream;
  }
  /// `bytes` must outlive the stream.
  static EntropyStream reader(ByteView bytes) { return EntropyStream(Direction::read, bytes); }
  /// A reader whose costs are all 0, which is faster.
  static EntropyStream reader_without_costs(ByteView bytes) {
    EntropyStream stream = reader(bytes);
    stream.has_costs_ = false;
    return stream;
  }

  bool is_reading() const { return direction_ == Direction::read; }
  bool is_recorder() const { return is_recording_; }

  /// Codes one decision whose probability of being 1 is `ones_of_65536` / 65536, 1 to 65535.
  /// Returns `value` when writing or measuring, else the value that was read.
  bool code(bool value, std::uint32_t ones_of_65536) {
    WATERTIGHT_ASSERT(ones_of_65536 > 0 && ones_of_65536 < 65536);
    if (!is_reading() || failed_) return code_known(value, ones_of_65536);
    const std::uint32_t middle = split(ones_of_65536);
    const bool result = window_ <= middle;
    if (result) {
      high_ = middle;
    } else {
      low_ = middle + 1;
    }
    if (((low_ ^ high_) >> 24) == 0) shift_out();
    if (has_costs_) add_cost(result, ones_of_65536);
    return result;
  }
  /// Codes a number below `size` with all values equally likely (truncated binary). Requires size >
  /// 0 and, unless reading, value < size.
  std::uint64_t code_uniform(std::uint64_t value, std::uint64_t size);
  /// Codes the `count` low bits of a number, high ones first, all equally likely. Requires count <=
  /// 64.
  std::uint64_t code_bits(std::uint64_t value, int count);
  /// As code_bits(), several bits at a time where the interval is wide enough; the bytes are
  /// others.
  std::uint64_t code_plain_bits(std::uint64_t value, int count);

  /// Codes the decisions of a recorder again, which costs far less than to find their
  /// probabilities. Requires that this stream writes or measures.
  void append(const EntropyStream& recorder);

  /// Reports that the values read so far are malformed. Reading returns zeros from then on. A
  /// reader that runs past the end of its bytes fails by itself. Callers bound their loops, and ask
  /// failed() in every loop that could be long.
  void fail() { failed_ = true; }
  bool failed() const { return failed_ || (cost_ >= pause_ && is_over()); }

  /// Makes failed() ask `limits.cancel` now and then, and be true once that is true. A reader
  /// without costs never asks.
  void heed(const Limits& limits);

  /// When reading, the number of bytes taken so far, including the few that the coder reads ahead.
  std::size_t position() const { return std::min(position_, source_.size()); }
  /// The cost of the decisions so far, in 1/65536 bit; within 0.1 % of the bytes.
  std::uint64_t cost() const { return cost_; }
  std::uint64_t cost(StreamPart part) const { return costs_[static_cast<std::size_t>(part)]; }
  const StreamCosts& costs() const { return costs_; }
  /// Books the costs of the decisions from here on under `part`. Changes nothing else.
  void enter(StreamPart part) { part_ = static_cast<std::size_t>(part); }
  /// Ends a written stream. Returns the shortest bytes from which a reader gets the same decisions,
  /// and among byte strings of that length the smallest.
  Bytes finish() &&;
  /// True if nothing failed and the bytes end exactly as a writer would have ended them.
  bool is_finished() const;

 private:
  enum class Direction : std::uint8_t { write, read, measure };
  struct Decision {
    std::uint16_t ones_of_65536 = 0;
    bool value = false;
    std::uint8_t part = 0;
  };
  EntropyStream(Direction direction, ByteView source);
  /// The end of the part of the interval that stands for a yes.
  std::uint32_t split(std::uint32_t ones_of_65536) const {
    return low_ + static_cast<std::uint32_t>(
                      (static_cast<std::uint64_t>(high_ - low_) * ones_of_65536) >> 16);
  }
  bool code_known(bool value, std::uint32_t ones_of_65536);
  void add_cost(bool value, std::uint32_t ones_of_65536);
  std::uint32_t code_chunk(std::uint32_t value, int count);
  void shift_out();
  std::uint32_t next_byte();
  /// Whether the limit is reached or the work cancelled, at a pause.
  bool is_over() const;

  Direction direction_;
  bool failed_ = false;
  bool is_recording_ = false;
  bool has_costs_ = true;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = 0xFFFFFFFFU;
  std::uint32_t window_ = 0;  // reading: the next four bytes of the source
  std::size_t position_ = 0;  // reading: bytes taken, counting those past the end
  ByteView source_;
  Bytes bytes_;
  std::uint64_t limit_ = ~std::uint64_t{0};
  mutable std::uint64_t pause_ = ~std::uint64_t{0};  // the cost from which failed() looks further
  const CancelPoll* cancel_ = nullptr;
  std::uint64_t cost_ = 0;
  StreamCosts costs_{};
  std::size_t part_ = 0;
  std::vector<Decision> decisions_;  // those of a recorder
};

}  // namespace watertight::codec
