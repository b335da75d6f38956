// SPDX-License-Identifier: GPL-3.0-or-later
//
// The number of bytes that a solid takes in each mode, by parts: for `encode --explain`.
#pragma once

#include <vector>

#include "codec/blob.h"

namespace watertight::codec {

struct ModeSize {
  Mode mode = Mode::raw;
  std::size_t bytes = 0;              // size of the blob; 0 if the mode cannot hold the solid
  std::vector<BlobInfo::Part> parts;  // the sizes of the parts of that blob
};

/// Encodes the solid of `blob` anew in every mode. Errors: those of decode(). Cost: encoding in all
/// modes.
Result<std::vector<ModeSize>> explain(ByteView blob, const Limits& limits = {});

}  // namespace watertight::codec
