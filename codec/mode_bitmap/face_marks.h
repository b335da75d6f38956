// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads the bitmap, one mark for each face of the Delaunay tetrahedralization in the
// order of sorted vertex triples, and the list of unrecovered faces (docs/format-plain.md, "Mode
// bitmap"). The marks are plain bits, or arithmetic coded with models that depend on the marks
// before.
#pragma once

#include <span>
#include <vector>

#include "base/bytes.h"
#include "codec/mode_bitmap/bit_coder.h"
#include "delaunay/canonical_delaunay.h"

namespace watertight::codec::bitmap {

/// The counts of a boundary in the Delaunay tetrahedralization of its nodes.
struct FaceCounts {
  Index steiner_vertices = 0;
  Index delaunay_faces = 0;
  Index marked_faces = 0;
  Index unrecovered_faces = 0;
  friend bool operator==(const FaceCounts&, const FaceCounts&) = default;
};

/// Writes the section of marks. Requires one mark for each face. Cost: O(n log n).
Bytes write_marks(BitCoding coding, const delaunay::CanonicalDelaunay& delaunay,
                  const std::vector<bool>& marks);

/// Reads a section of marks. Errors: malformed if it has not exactly one mark for each face.
Result<std::vector<bool>> read_marks(ByteView section, BitCoding coding,
                                     const delaunay::CanonicalDelaunay& delaunay);

/// Writes a list of faces. Requires strictly increasing triples of increasing vertices.
Bytes write_face_list(std::span<const Triangle> faces);

/// Reads a list of faces: strictly increasing triples of increasing vertices below `vertex_count`.
/// Errors: malformed. Each face takes at least three bytes of the section.
Result<std::vector<Triangle>> read_face_list(ByteView section, std::size_t vertex_count);

}  // namespace watertight::codec::bitmap
