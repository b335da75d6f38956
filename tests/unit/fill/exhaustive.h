// SPDX-License-Identifier: GPL-3.0-or-later
//
// The best filling of a few points by trying all of them, for comparison.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fill/triangulate_loops.h"

namespace watertight::fill::test {

/// The least sum of angles (radians) or areas over all surfaces with these loops as their
/// borders that are manifold, oriented and without handles; nothing if there is none. Knows nothing
/// of domains: it adds triangles to open edges until none is open. Of the options it reads the
/// objective, senses, facets behind and allowed triangles; it tries all triples. Cost: exponential.
std::optional<double> least_weight(std::span<const Point> points, std::span<const Loop> loops,
                                   const FillOptions& options);

/// Whether triangles are a manifold, connected surface without handles with these borders. Senses
/// of loops but the first may differ if `has_both_senses`.
bool is_filling(std::span<const Loop> loops, std::span<const Triangle> triangles,
                bool has_both_senses);

}  // namespace watertight::fill::test
