// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solids and options behind tests/golden/blobs: one file each, <version>/<name>.blob.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codec/blob.h"

namespace watertight::generated {

struct Golden {
  std::string name;
  std::size_t size = 0;  // bytes of the file of version 0
  OrientedBoundary boundary;
  Acceptance acceptance;
  Mode mode = Mode::bitmap;
  bool keep_order = true;
  bool with_steiner = false;  // with schoenhardt_certificate()
  std::uint8_t models = codec::kModelNumber;
};

/// Files that are only decoded.
std::vector<Golden> version_0_goldens();
/// Blobs of the present version: some solids, each in every mode that can hold it.
std::vector<Golden> goldens();
Result<Bytes> encode_golden(const Golden& golden);

}  // namespace watertight::generated
