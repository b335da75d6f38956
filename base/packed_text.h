// SPDX-License-Identifier: GPL-3.0-or-later
//
// A skeleton as a store keeps it: compressed, which its type separates from plain text.
#pragma once

#include "base/bytes.h"

namespace watertight {

/// formats/text/packed_text.h makes and opens it; others only pass it on.
struct PackedText {
  Bytes bytes;
  friend bool operator==(const PackedText&, const PackedText&) = default;
};

}  // namespace watertight
