// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes solids of what readers collect: rings of indices into a file's vertices, or rings of
// points. Internal to formats/.
#pragma once

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/limits.h"
#include "formats/document.h"
#include "geometry/solid.h"

namespace watertight::formats {

/// Renumbers the ring vertices in order of first use; returns the old number of each new vertex.
/// `number_of` has an entry per vertex of the file; every entry is kNone before and after the call.
std::vector<Index> number_by_first_use(SolidArrays& arrays, std::vector<Index>& number_of);

/// The vertices of a text file.
struct DecimalVertices {
  std::vector<std::array<GridNumber, 3>> positions;
  std::vector<bool> is_rounded;
  std::vector<Index> number_of;  // an entry kNone per vertex, for number_by_first_use()
};

/// A solid whose ring vertices are indices into `vertices`; vertices with different indices stay
/// different even if equal. Vertices that no ring uses are left out; SubmittedSolid::unused counts
/// them.
Result<SubmittedSolid> indexed_solid(SolidArrays arrays, DecimalVertices& vertices,
                                     SolidSource source, const Limits& limits);

/// The document of a file with one shell: adds one feature of one solid to `document`, which has a
/// format and may have notes. `arrays` has facets and no shell yet.
Result<Document> one_shell_document(Document document, std::string geometry_type,
                                    SolidArrays arrays, DecimalVertices& vertices,
                                    const Limits& limits);

/// A solid whose ring vertices are indices into `points`, with a point for each vertex of each
/// ring. Equal points become one vertex, because formats with points instead of indices express
/// shared vertices by equal coordinates only.
Result<SubmittedSolid> solid_of_points(SolidArrays arrays, const geometry::LatticePoints& points,
                                       SolidSource source, std::uint32_t srid,
                                       const Limits& limits);

/// The document of a reader of WKT or EWKB, which reads one geometry after the other, each a
/// feature in its own reference system. Reads at least one geometry. Errors: those of
/// Reader::read().
template <class Reader>
Result<Document> document_of_geometries(Reader reader, Format format) {
  Document document;
  document.format = format;
  do {
    auto solid = reader.read();
    if (!solid) return std::move(solid).error();
    Feature& feature = document.features.emplace_back();
    feature.srid = solid->solid.srid();
    feature.solids.push_back(*std::move(solid));
  } while (!reader.is_at_end());
  return document;
}

}  // namespace watertight::formats
