// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solids behind the golden pages and page files of tests/golden/blobs/version-1, and bytes that
// every decoder refuses.
#pragma once

#include <string>
#include <vector>

#include "codec/blob.h"

namespace watertight::generated {

struct GoldenPage {
  std::string file;  // name.page, or name.wtpf for a page file of pages of three solids
  std::vector<OrientedBoundary> solids;
  std::vector<Mode> modes;  // in turn
  std::uint8_t models = codec::kModelNumber;
};

std::vector<GoldenPage> golden_pages();
Result<Bytes> encode_golden_page(const GoldenPage& golden);

struct Refused {
  std::string name;
  std::string kind;  // blob, page or wtpf
  ErrorCode error;
  Bytes bytes;
};

/// With the neutral set of priors: the same for ever.
std::vector<Refused> refused();
/// As a table: name, kind, error, bytes in hex.
std::string refused_csv();

}  // namespace watertight::generated
