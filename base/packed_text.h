// SPDX-License-Identifier: GPL-3.0-or-later
//
// A skeleton as a store keeps it: compressed. It has a type of its own so that it is not taken for
// the text itself.
#pragma once

#include <memory>

#include "base/bytes.h"

namespace watertight {

namespace packing {
class TextDictionary;
}

/// A compressed text; other files than its makers (packing/text_dictionary.h in stores,
/// formats/text/packed_text.h in Watertight files) only pass it on.
struct PackedText {
  Bytes bytes;
  /// The dictionary with which the bytes were made, null for none.
  std::shared_ptr<const packing::TextDictionary> dictionary = {};
  friend bool operator==(const PackedText& a, const PackedText& b) { return a.bytes == b.bytes; }
};

}  // namespace watertight
