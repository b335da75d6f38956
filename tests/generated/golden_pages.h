// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solids of the golden pages and page files in tests/golden/blobs/version-1, and bytes that
// every decoder refuses.
#pragma once

#include <string>
#include <vector>

#include "codec/blob.h"

namespace watertight::generated {

struct GoldenPage {
  std::string file;  // name.page, or name.wtpf for a page file whose pages have three solids
  std::vector<OrientedBoundary> solids;
  std::vector<Mode> modes;  // the modes of the solids, used in turn
  std::uint8_t models = codec::kModelNumber;
};

std::vector<GoldenPage> golden_pages();
Result<Bytes> encode_golden_page(const GoldenPage& golden);

struct Refused {
  std::string name;
  std::string kind;  // one of blob, page, wtpf
  ErrorCode error;
  Bytes bytes;
};

/// Bytes that every decoder refuses. They use the neutral set of priors, so they never change.
std::vector<Refused> refused();
/// The refused bytes as a table: name, kind, error, bytes in hexadecimal.
std::string refused_csv();

}  // namespace watertight::generated
