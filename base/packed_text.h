// SPDX-License-Identifier: GPL-3.0-or-later
//
// A skeleton as a store keeps it: compressed. It has a type of its own so that it is not taken for
// the text itself.
#pragma once

#include "base/bytes.h"

namespace watertight {

/// A compressed text, which formats/text/packed_text.h makes and opens; other files only pass it
/// on.
struct PackedText {
  Bytes bytes;
  friend bool operator==(const PackedText&, const PackedText&) = default;
};

}  // namespace watertight
