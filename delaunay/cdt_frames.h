// SPDX-License-Identifier: GPL-3.0-or-later
//
// The messages between the ladder and the engine executables: a constrained Delaunay job and its
// answer as bytes. Both readers trust nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/bytes.h"
#include "base/result.h"
#include "delaunay/tetrahedralization.h"

namespace watertight::delaunay {

/// The kinds of constraints.
enum class Constraints : std::uint8_t {
  patches = 0,   // the polygons (with holes) that the triangles of a facet make up
  triangles = 1  // every triangle by itself
};

struct CdtJob {
  Constraints constraints = Constraints::patches;
  PiecewiseLinearComplex complex;
};

/// Either a tetrahedralization or the engine's reason for having none.
struct CdtAnswer {
  std::optional<Tetrahedralization> tetrahedralization;
  std::string refusal;
  /// CPU time of the engine's own call, without reading the job and writing the answer.
  double engine_seconds = 0;
};

Bytes write_job(const CdtJob& job);
/// Errors: malformed (counts, indices and coordinates are checked; facet numbers are dense).
Result<CdtJob> read_job(ByteView bytes);

/// Writes no points of the input, only Steiner points.
Bytes write_answer(const CdtAnswer& answer);
/// `vertices` are the input's points, which become the first points of the result.
/// Errors: malformed (counts, indices, facet numbers and coordinates are checked).
Result<CdtAnswer> read_answer(ByteView bytes, const std::vector<Point>& vertices,
                              Index facet_count);

}  // namespace watertight::delaunay
