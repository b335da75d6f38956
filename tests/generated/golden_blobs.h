// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solids and options of the files in tests/golden/blobs: one file each, <version>/<name>.blob.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codec/blob.h"

namespace watertight::generated {

struct Golden {
  std::string name;
  OrientedBoundary boundary;
  Acceptance acceptance;
  Mode mode = Mode::bitmap;
  bool keep_order = true;
  bool with_steiner = false;  // the tetrahedralization is schoenhardt_certificate()
  std::uint8_t models = codec::kModelNumber;
};

/// The golden solids: some solids, each in every mode that can hold it.
std::vector<Golden> goldens();
Result<Bytes> encode_golden(const Golden& golden);

}  // namespace watertight::generated
