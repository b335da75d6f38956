// SPDX-License-Identifier: GPL-3.0-or-later
//
// A compressed text, told apart from plain text by its type: skeletons as a store keeps them.
#pragma once

#include "base/bytes.h"

namespace watertight {

/// formats/text/packed_text.h makes and opens it; others only pass it on.
struct PackedText {
  Bytes bytes;
  friend bool operator==(const PackedText&, const PackedText&) = default;
};

}  // namespace watertight
