// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/explain.h"

#include <utility>

#include "codec/encode_boundary.h"

namespace watertight::codec {

Result<std::vector<ModeSize>> explain(ByteView blob, const Limits& limits) {
  const auto decoded = decode(blob, limits);
  if (!decoded) return decoded.error();
  const auto boundary = OrientedBoundary::make(decoded->solid);
  if (!boundary) return boundary.error();
  std::vector<ModeSize> sizes;
  for (const Mode mode :
       {Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon, Mode::parallelogram}) {
    ModeSize size;
    size.mode = mode;
    EncodeOptions options;
    options.mode = mode;
    options.keep_order = decoded->info.has_order;
    if (const auto again = encode_boundary(*boundary, decoded->info.acceptance, options)) {
      size.bytes = again->size();
      if (auto info = describe(*again, limits)) size.parts = std::move(info->parts);
    }
    sizes.push_back(std::move(size));
  }
  return sizes;
}

}  // namespace watertight::codec
