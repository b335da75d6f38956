// SPDX-License-Identifier: GPL-3.0-or-later
//
// CityJSON and CityJSONSeq: whole documents, sequences line by line, and skeletons reduced to a
// contract. Callers that accept any format use formats/document.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/document.h"

namespace watertight::formats {

/// The values that all features of a city model share: the first line of a CityJSONSeq.
struct CityHeader {
  std::string text;  // the same text as Document::header
  std::string version;
  std::optional<geometry::Transform>
      transform;  // absent: vertices are coordinates (an error in a sequence)
  std::uint32_t srid = 0;
  std::uint64_t template_count = 0;  // geometry templates that features may refer to
};

/// Reading a CityJSONSeq line by line, in memory bounded by the longest line: the header is the
/// first line (or a Document::header), each further line a feature. Errors: those of read_document;
/// the JSON Pointer and byte offset are within the line. Cost: linear.
Result<CityHeader> read_city_json_header(std::string_view line, const Limits& limits = {});
Result<Feature> read_city_json_feature(const CityHeader& header, std::string_view line,
                                       const ReadOptions& options = {});
/// The solids of the header's geometry templates (Document::templates), each template on a lattice
/// of its own; most headers have none and cost nothing. Errors: malformed with JSON Pointer. Cost:
/// linear.
Result<std::vector<SubmittedSolid>> read_geometry_templates(const CityHeader& header,
                                                            const Limits& limits = {});
/// The text of write_feature(), without reading the header again.
Result<std::string> write_city_json_feature(const CityHeader& header, const Feature& feature);

/// The skeleton of a feature of a city model for its solids in canonical form. `contract` is
/// lattice or boundary. Errors: malformed when a solid is no oriented boundary or the skeleton does
/// not fit.
Result<std::string> canonical_skeleton(const Feature& feature, Contract contract);
/// The header that goes with skeletons of contract boundary. Errors: malformed.
Result<std::string> boundary_header(std::string_view header);

Result<Document> read_city_json(std::string_view text, const ReadOptions& options);
Result<Document> read_city_json_seq(std::string_view text, const ReadOptions& options);
Result<std::string> write_city_json(const Document& document);
Result<std::string> write_city_json_seq(const Document& document);

/// The solids of a document of another format as generic city objects of one CityJSON 2.0, on the
/// finest of their decimal grids. Features of GML that keep their city model (keep_city_model())
/// become that. Errors: unsupported for coordinates on no decimal grid.
Result<Document> as_city_model(const Document& document);

}  // namespace watertight::formats
