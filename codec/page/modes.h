// SPDX-License-Identifier: GPL-3.0-or-later
//
// The entropy coded modes: each one is a layout of models and one function that writes, reads or
// measures a solid on its page's grid (docs/format.md).
#pragma once

#include "base/limits.h"
#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/page/integer_solid.h"

namespace watertight::codec {

struct WriterChoice;  // codec/page/writer_choice.h

/// The function of a mode. It only reads `memory`; the caller adds each solid to the page memory
/// afterwards. When writing or measuring, `solid` must be canonical and stays unchanged; errors:
/// not_encodable if the mode cannot hold the solid (the stream and the bank are then useless). When
/// reading, `solid` must be empty, and gets its vertices and facets in any order; errors:
/// malformed; limit_exceeded before anything large is allocated.
using CodeSolid = Status(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                         IntegerSolid& solid, const WriterChoice& choice, const Limits& limits);

}  // namespace watertight::codec

/// Mode `polygon`: codes the facets first, then coordinates by planes and right angles.
namespace watertight::codec::polygon {
const ModelLayout& model_layout();
CodeSolid code_solid;
}  // namespace watertight::codec::polygon

/// Mode `walk`: codes columns of coordinates, then the boundary among the Delaunay faces.
namespace watertight::codec::walk {
const ModelLayout& model_layout();
CodeSolid code_solid;
}  // namespace watertight::codec::walk

/// Mode `parallelogram`: codes triangles along a front, each vertex predicted from those around it.
namespace watertight::codec::parallelogram {
struct VertexOptions;  // codec/mode_parallelogram/vertex_options.h

const ModelLayout& model_layout();
CodeSolid code_solid;
/// Returns the options with which a canonical solid takes the fewest bytes, by trials on a part of
/// the solid. Leaves `models` unchanged. Errors: not_encodable.
Result<VertexOptions> choose_options(const IntegerSolid& solid, ModelBank& models,
                                     const PageMemory& memory, const Limits& limits);
}  // namespace watertight::codec::parallelogram
