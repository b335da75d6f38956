// SPDX-License-Identifier: GPL-3.0-or-later
//
// Texts of city models in few bytes. A text is taken apart into marks (brackets, keys, white space)
// and values; each value is predicted from the values of its column, that is of its path in the
// document, and from those around it, and goes to one entropy coded stream
// (docs/format-columns.md). Any text comes back byte for byte; texts of JSON come back from few
// bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"

namespace watertight::columns {

/// How a text is taken apart. Wrong kinds cost bytes only.
enum class TextKind : std::uint8_t {
  bytes,  // any bytes: one value
  json,   // JSON, for example the skeleton of a feature
  xml,    // XML, for example a document of CityGML
  table   // a line with a name, then lines of cells with tabs between them
};

struct Text {
  TextKind kind = TextKind::bytes;
  std::string_view text;
};

/// Texts from which a coder has learned, so that a text like them takes few bytes by itself. Never
/// changes. Thread-safe. Memory: some 2 MB.
class Examples {
 public:
  /// Packs examples for of(). Cost: that of packing the texts.
  static Bytes pack_examples(std::span<const Text> texts);
  /// Learns from packed examples by reading them, which may be hostile. Errors: those of
  /// unpack_texts().
  static Result<std::shared_ptr<const Examples>> of(ByteView examples, std::uint64_t most_bytes);
  ~Examples();
  Examples(const Examples&) = delete;
  Examples& operator=(const Examples&) = delete;

  /// Packs one text. Each is packed and unpacked as if it were the only one. Cost: a copy of 1 MB,
  /// and 10 MB a second.
  Bytes pack(const Text& text) const;
  /// The text that was packed. `bytes` may be hostile. Errors: those of unpack_texts().
  Result<std::string> unpack(ByteView bytes, std::uint64_t most_bytes) const;

 private:
  struct Learned;
  explicit Examples(std::unique_ptr<const Learned> learned);
  std::unique_ptr<const Learned> learned_;
};

/// Packs texts. Later ones cost less where they resemble earlier ones. Cost: linear, about 10 MB a
/// second; unpack_texts() reads 10 to 25.
Bytes pack_texts(std::span<const Text> texts);

/// The texts that were packed. `bytes` may be hostile: time is bounded by its length and the length
/// of the texts. Errors: malformed; limit_exceeded as soon as the texts have more than
/// `most_bytes`.
Result<std::vector<std::string>> unpack_texts(ByteView bytes, std::uint64_t most_bytes);

/// The error for texts of a form that only newer programs know.
Error unknown_form(std::uint64_t form);

/// The examples of the format (docs/format-columns.md, "Examples"), packed by a coder that has
/// learned nothing: those of packed texts, or those of single texts. They are part of the format
/// and never change. For tests.
Bytes packed_examples(bool are_for_single_texts);

}  // namespace watertight::columns
