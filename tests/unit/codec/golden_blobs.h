// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solids and options behind tests/golden/blobs: one file each, named <name>.blob.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codec/blob.h"

namespace watertight::generated {

struct Golden {
  std::string name;
  std::size_t size = 0;  // bytes of the file
  OrientedBoundary boundary;
  Acceptance acceptance;
  Mode mode = Mode::bitmap;
  bool keep_order = true;
  bool with_steiner = false;  // with schoenhardt_certificate()
};

std::vector<Golden> goldens();
Result<Bytes> encode_golden(const Golden& golden);

}  // namespace watertight::generated
