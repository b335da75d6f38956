// SPDX-License-Identifier: GPL-3.0-or-later
//
// Short texts that resemble each other, packed with examples that they share: the texts of features
// in a store. The one place that knows how they are packed.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/bytes.h"
#include "base/result.h"
#include "columns/columns.h"

namespace watertight::packing {

/// Examples of texts. Never changes. Thread-safe. Memory: kDictionaryMemory.
class TextDictionary {
 public:
  /// The dictionary of content(). Cost: about 10 ms for each 100 kB of examples. Errors: malformed;
  /// unsupported for a dictionary of a newer program.
  static Result<std::shared_ptr<const TextDictionary>> of(Bytes content);
  /// The share of a text's bytes that packed texts took when it was made.
  double fit() const { return fit_; }
  const Bytes& content() const { return content_; }

 private:
  TextDictionary(Bytes content, double fit, std::shared_ptr<const columns::Examples> examples)
      : content_(std::move(content)), fit_(fit), examples_(std::move(examples)) {}
  friend Result<Bytes> pack(std::string_view text, const TextDictionary* dictionary);
  friend Result<std::string> unpack(ByteView packed, const TextDictionary* dictionary,
                                    std::uint64_t most_bytes);

  const Bytes content_;
  const double fit_;
  const std::shared_ptr<const columns::Examples> examples_;
};

using DictionaryPointer = std::shared_ptr<const TextDictionary>;

/// The bytes of memory that a dictionary takes, roughly.
constexpr std::size_t kDictionaryMemory = 2 << 20;

/// Packs a text by columns (docs/format-columns.md), with a dictionary unless it is null. Cost:
/// about 0.3 ms for 3 kB.
Result<Bytes> pack(std::string_view text, const TextDictionary* dictionary);

/// The text of pack(). Memory grows with the output, never with a size that the bytes state.
/// Errors: malformed; limit_exceeded as soon as the output exceeds `most_bytes`. Cost: about 0.2 ms
/// for 3 kB.
Result<std::string> unpack(ByteView packed, const TextDictionary* dictionary,
                           std::uint64_t most_bytes);

/// The least number of samples from which a dictionary is made.
constexpr std::size_t kFewestSamples = 32;

/// Whether a dictionary is there that packs the samples about as well as those for which it was
/// made. Cost: 24 of the samples are packed.
Result<bool> still_fits(const TextDictionary* dictionary, std::span<const std::string> samples);

/// The examples of a dictionary have so many bytes at most; a longer text is no example.
constexpr std::uint64_t kMostExampleBytes = 256 << 10;

/// The dictionary for `expected` texts like the samples: one with some of the samples as examples;
/// or `current` (null: none) when no new one makes dictionary and texts together at least 4 %
/// smaller, or when the samples are too few. Cost: up to 0.2 s.
Result<DictionaryPointer> best_dictionary(std::span<const std::string> samples,
                                          std::uint64_t expected,
                                          const DictionaryPointer& current = {});

}  // namespace watertight::packing
