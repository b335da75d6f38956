// SPDX-License-Identifier: GPL-3.0-or-later
//
// Functions that drive the modes for integers in tests: a stream of one solid, without a page or
// blob around the stream.
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

/// The models of a layout before their first decision. The layout must last as long as the program.
/// The next call for it sets the same bank back: that takes far less time than a new bank, above
/// all under sanitizers.
codec::ModelBank& new_models(const codec::ModelLayout& layout);

/// The canonical form of a boundary on its grid; nothing if the boundary has no grid.
std::optional<codec::IntegerSolid> integers_of(const OrientedBoundary& boundary);

/// The stream of a solid. Errors: those of the mode.
Result<Bytes> write(const IntegerMode& mode, const codec::IntegerSolid& solid,
                    const codec::PageMemory& memory = {});

/// The solid of a stream. Errors: those of the mode; malformed if bytes are left.
Result<codec::IntegerSolid> read(const IntegerMode& mode, ByteView bytes,
                                 const codec::PageMemory& memory = {}, const Limits& limits = {});

/// The positions of the corners of a ring.
using PlacedRing = std::vector<codec::GridPoint>;
using PlacedFacet = std::vector<PlacedRing>;
using PlacedShell = std::vector<PlacedFacet>;

/// The shells of a solid as positions, sorted: equal for equal solids, in whatever order their
/// arrays are. Requires indices in range.
std::vector<PlacedShell> placed(const codec::IntegerSolid& solid);

/// Writes a solid, reads it back, and requires that it is equal.
void check_round_trip(const IntegerMode& mode, const codec::IntegerSolid& solid,
                      const codec::PageMemory& memory = {});

/// Reads every prefix of a stream, then `changes` copies with up to three bytes changed; each
/// result must be within the limits, have its indices in range, and differ from the solid of the
/// stream.
void check_damaged(const IntegerMode& mode, const codec::IntegerSolid& solid, int changes);

}  // namespace watertight::test
