// SPDX-License-Identifier: GPL-3.0-or-later
//
// portable_decoder <BLOB: decodes standard input and prints a summary. The program is the decoder
// alone, as a build without an operating system would have it: see portable.sh.
#include <cinttypes>
#include <cstdio>
#include <vector>

#include "codec/blob.h"

using namespace watertight;

int main() {
  Bytes bytes(std::size_t{1} << 20);
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), stdin));
  const auto decoded = decode(bytes);
  if (!decoded) {
    std::printf("%s\n", to_string(decoded.error()).c_str());
    return 1;
  }
  std::printf("mode %s, %" PRIu32 " vertices, %" PRIu32 " facets\n",
              codec::to_string(decoded->info.mode).data(), decoded->info.vertices,
              decoded->info.facets);
  return 0;
}
