// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids with cavities from formats that hold one shell per file (TetGen POLY, STL, PLY, OFF): one
// file gives the exterior shell, others the interior ones. For the command line and tests.
#pragma once

#include <span>

#include "base/limits.h"
#include "base/result.h"
#include "formats/document.h"

namespace watertight::formats {

/// The solid `exterior` with every shell of `interior` appended as interior shells, in order, on
/// one lattice for all shells. Keeps the source and the reference system of `exterior`. Facets stay
/// oriented as they are; vertices of different solids stay different even if equal. Errors:
/// limit_exceeded; those of lattice_of_decimals(). Cost: linear, some 100 ns per vertex.
Result<SubmittedSolid> with_interior_shells(const SubmittedSolid& exterior,
                                            std::span<const SubmittedSolid> interior,
                                            const Limits& limits = {});

}  // namespace watertight::formats
