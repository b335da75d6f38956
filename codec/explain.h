// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a solid takes in each mode, and what of it goes where: for `encode --explain`.
#pragma once

#include <vector>

#include "codec/blob.h"

namespace watertight::codec {

struct ModeSize {
  Mode mode = Mode::raw;
  std::size_t bytes = 0;              // of the whole blob; 0: the mode cannot hold the solid
  std::vector<BlobInfo::Part> parts;  // of those bytes
};

/// Encodes what `blob` holds anew in every mode. Errors: as decode(). Cost: that of all modes.
Result<std::vector<ModeSize>> explain(ByteView blob, const Limits& limits = {});

}  // namespace watertight::codec
