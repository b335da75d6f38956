// SPDX-License-Identifier: GPL-3.0-or-later
//
// The choices that modes leave to the writer of a solid. This file is not part of modes.h, so that
// no mode sees the types of another mode.
#pragma once

#include <optional>

#include "codec/mode_parallelogram/vertex_options.h"

namespace watertight::codec {

struct WriterChoice {
  /// The options of mode parallelogram; nothing if its code_solid() is to choose them.
  std::optional<parallelogram::VertexOptions> vertex_options;
};

}  // namespace watertight::codec
