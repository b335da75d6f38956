// SPDX-License-Identifier: GPL-3.0-or-later
//
// The choices that modes have for a solid before it is written. Apart from modes.h, so that no mode
// sees the types of another.
#pragma once

#include <optional>

#include "codec/mode_parallelogram/vertex_options.h"

namespace watertight::codec {

struct WriterChoice {
  /// For mode parallelogram; nothing: its code_solid() chooses by itself.
  std::optional<parallelogram::VertexOptions> vertex_options;
};

}  // namespace watertight::codec
