// SPDX-License-Identifier: GPL-3.0-or-later
//
// Short texts that resemble each other, compressed with a dictionary that they share: the texts of
// features in a store. The one place that knows how they are compressed.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "base/bytes.h"
#include "base/result.h"

namespace watertight::packing {

/// The bytes that texts have in common. Never changes. Thread-safe.
class TextDictionary {
 public:
  /// Takes any bytes. Errors: limit_exceeded without memory.
  static Result<std::shared_ptr<const TextDictionary>> of(Bytes content);
  ~TextDictionary();
  TextDictionary(const TextDictionary&) = delete;
  TextDictionary& operator=(const TextDictionary&) = delete;
  const Bytes& content() const { return content_; }

 private:
  struct Prepared;
  explicit TextDictionary(Bytes content);
  friend Result<Bytes> pack(std::string_view text, const TextDictionary* dictionary);
  friend Result<std::string> unpack(ByteView packed, const TextDictionary* dictionary,
                                    std::uint64_t most_bytes);

  const Bytes content_;
  std::unique_ptr<const Prepared> prepared_;
};

using DictionaryPointer = std::shared_ptr<const TextDictionary>;

/// Compresses a text, with a dictionary unless it is null: one Zstandard frame (RFC 8878) without
/// magic number, size, checksum and name of the dictionary. Errors: limit_exceeded without memory.
/// Cost: about 0.6 ms for 3 kB.
Result<Bytes> pack(std::string_view text, const TextDictionary* dictionary);

/// The text of pack(). Memory grows with the output, never with a size that the bytes state.
/// Errors: malformed; limit_exceeded as soon as the output exceeds `most_bytes`.
Result<std::string> unpack(ByteView packed, const TextDictionary* dictionary,
                           std::uint64_t most_bytes);

/// The least number of samples from which a dictionary is made.
constexpr std::size_t kFewestSamples = 32;

/// Makes a dictionary for `expected` texts like the samples, of the size at which dictionary and
/// texts together are smallest. Returns `current` (null: none) when no new one makes them at least
/// 4 % smaller, or when the samples are too few. Errors: limit_exceeded without memory. Cost: about
/// 1 s for 1,000 samples of 3 kB.
Result<DictionaryPointer> train(std::span<const std::string> samples, std::uint64_t expected,
                                const DictionaryPointer& current = {});

/// The bytes of the texts when they are packed with a dictionary (null: none). Errors: pack().
Result<std::uint64_t> packed_bytes(std::span<const std::string> texts,
                                   const TextDictionary* dictionary);

}  // namespace watertight::packing
