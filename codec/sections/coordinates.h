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

/// Writes a section of vertices. Requires strictly increasing points. Cost: linear.
Bytes write_vertices(std::span<const Point> points);

/// Reads a section of vertices. Guarantees strictly increasing, finite points without -0. Errors:
/// malformed; limit_exceeded. Every vertex takes at least three bytes of the section.
Result<std::vector<Point>> read_vertices(ByteView section, const Limits& limits);

/// Writes a section of Steiner vertices: for each point a flag byte (bits 0, 1, 2: the coordinate
/// of this axis is an integer of magnitude at most 2^53 and is stored as one), then the
/// coordinates. Requires increasing points.
Bytes write_steiner_vertices(std::span<const Point> points);

/// Reads a section of Steiner vertices. Errors: those of read_vertices().
Result<std::vector<Point>> read_steiner_vertices(ByteView section, const Limits& limits);

}  // namespace watertight::codec
