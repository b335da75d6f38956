// SPDX-License-Identifier: GPL-3.0-or-later
//
// The modes for integers as their tests drive them: a stream of one solid, without page and blob
// around it.
#pragma once

#include <optional>
#include <vector>

#include "codec/page/modes.h"
#include "codec/page/writer_choice.h"
#include "tests/generated/generated_solids.h"

namespace watertight::test {

struct IntegerMode {
  const codec::ModelLayout& (*model_layout)();
  codec::CodeSolid* code_solid;
};
inline constexpr IntegerMode kWalk{codec::walk::model_layout, codec::walk::code_solid};
inline constexpr IntegerMode kPolygon{codec::polygon::model_layout, codec::polygon::code_solid};
inline constexpr IntegerMode kParallelogram{codec::parallelogram::model_layout,
                                            codec::parallelogram::code_solid};

/// The canonical form of a boundary on its grid; nothing if it is on none.
std::optional<codec::IntegerSolid> integers_of(const OrientedBoundary& boundary);

/// The stream of a solid. Errors: those of the mode.
Result<Bytes> write(const IntegerMode& mode, const codec::IntegerSolid& solid,
                    const codec::PageMemory& memory = {});

/// The solid of a stream. Errors: those of the mode; malformed if bytes are left.
Result<codec::IntegerSolid> read(const IntegerMode& mode, ByteView bytes,
                                 const codec::PageMemory& memory = {}, const Limits& limits = {});

/// Shells of facets of rings of positions.
using PlacedRing = std::vector<codec::GridPoint>;
using PlacedFacet = std::vector<PlacedRing>;
using PlacedShell = std::vector<PlacedFacet>;

/// Equal for equal solids, however their arrays are arranged. Requires indices in range.
std::vector<PlacedShell> placed(const codec::IntegerSolid& solid);

/// Writes and reads, and requires the same solid.
void check_round_trip(const IntegerMode& mode, const codec::IntegerSolid& solid,
                      const codec::PageMemory& memory = {});

/// Reads every prefix of a stream, then `changes` copies with up to three bytes changed: what
/// comes back is within the limits, with indices in range, and it is not the solid of the stream.
void check_damaged(const IntegerMode& mode, const codec::IntegerSolid& solid, int changes);

}  // namespace watertight::test
