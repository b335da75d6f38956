// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads the sections of vertices and of Steiner vertices of modes raw and bitmap
// (docs/format-plain.md). Integer coordinates are stored as differences of sorted vertices, all
// others as IEEE doubles.
#pragma once

#include <span>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "geometry/point.h"

namespace watertight::codec {

/// True if every coordinate is an integer of magnitude at most 2^53.
bool are_integers(std::span<const Point> points);

/// Requires strictly increasing points. Cost: linear.
Bytes write_vertices(std::span<const Point> points);

/// Guarantees strictly increasing, finite points without -0.
/// Errors: malformed; limit_exceeded. Every vertex takes at least three bytes of the section.
Result<std::vector<Point>> read_vertices(ByteView section, const Limits& limits);

/// Steiner vertices: per point a flag byte (bit 0, 1, 2: the coordinate of that axis is an integer
/// below 2^53 in magnitude, stored as such), then the coordinates. Requires increasing points.
Bytes write_steiner_vertices(std::span<const Point> points);

/// Errors: as read_vertices.
Result<std::vector<Point>> read_steiner_vertices(ByteView section, const Limits& limits);

}  // namespace watertight::codec
