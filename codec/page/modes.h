// SPDX-License-Identifier: GPL-3.0-or-later
//
// The entropy coded modes: each one a layout of models and one function that writes, reads or
// measures a solid on its page's grid (docs/format.md). For encode, decode and training.
#pragma once

#include "base/limits.h"
#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/page/integer_solid.h"

namespace watertight::codec {

struct WriterChoice;  // codec/page/writer_choice.h

/// The function of a mode. It only reads `memory`; the caller extends that after each solid.
/// Writing and measuring: requires a canonical solid and leaves it as it is; errors: not_encodable
/// where the mode cannot hold it (the stream and the bank are then useless). Reading: `solid` must
/// be empty; its vertices and facets come in any order; errors: malformed; limit_exceeded before
/// anything large is allocated.
using CodeSolid = Status(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                         IntegerSolid& solid, const WriterChoice& choice, const Limits& limits);

}  // namespace watertight::codec

/// Mode `polygon` (B): connectivity first, then coordinates by planes and right angles.
namespace watertight::codec::polygon {
const ModelLayout& model_layout();
CodeSolid code_solid;
}  // namespace watertight::codec::polygon

/// Mode `walk` (A): columns of coordinates, then the boundary among the Delaunay faces.
namespace watertight::codec::walk {
const ModelLayout& model_layout();
CodeSolid code_solid;
}  // namespace watertight::codec::walk

/// Mode `parallelogram`: a front over triangles, each vertex predicted from those around it.
namespace watertight::codec::parallelogram {
struct VertexOptions;  // codec/mode_parallelogram/vertex_options.h

const ModelLayout& model_layout();
CodeSolid code_solid;
/// The options that write a canonical solid in fewest bytes, from trials on a part of it. `models`
/// are as they were afterwards. Errors: not_encodable.
Result<VertexOptions> choose_options(const IntegerSolid& solid, ModelBank& models,
                                     const PageMemory& memory, const Limits& limits);
}  // namespace watertight::codec::parallelogram
