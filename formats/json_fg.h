// SPDX-License-Identifier: GPL-3.0-or-later
//
// JSON-FG (OGC 21-045r1): GeoJSON whose features have a `place` in any reference system, which may
// be a Polyhedron. Internal to formats/; the public interface is formats/document.h.
#pragma once

#include <string_view>

#include "formats/document.h"

namespace watertight::formats {

/// Features with a `place` of type Polyhedron or MultiPolyhedron become solids; `geometry` is not
/// read. Errors: malformed with byte offset or JSON Pointer; unsupported for documents in which no
/// feature has such a place, for prisms, and for collections of other types; limit_exceeded.
Result<Document> read_json_fg(std::string_view text, const ReadOptions& options);

}  // namespace watertight::formats
