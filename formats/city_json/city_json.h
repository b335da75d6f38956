// SPDX-License-Identifier: GPL-3.0-or-later
//
// CityJSON and CityJSONSeq: whole documents, sequences line by line, and skeletons reduced to a
// contract. Callers that accept any format use formats/document.h.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
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
struct TemplateSolids {
  std::vector<SubmittedSolid> solids;
  std::vector<SubmittedSolid> surfaces;  // Document::template_surfaces
  std::vector<std::string> notes;        // the templates that cannot be read
};

/// The solids of the header's geometry templates (Document::templates), each template on a lattice
/// of its own; most headers have none and cost nothing. A template that cannot be read is a solid
/// without facets (902), and a note. Errors: malformed with JSON Pointer, for the list of templates
/// or of their vertices. Cost: linear.
Result<TemplateSolids> read_geometry_templates(const CityHeader& header, const Limits& limits = {},
                                               Surfaces surfaces = Surfaces::ignore);
/// The text of write_feature(), without reading the header again.
Result<std::string> write_city_json_feature(const CityHeader& header, const Feature& feature);

/// The skeleton of a feature of a city model for its solids in canonical form. `contract` is
/// lattice or boundary. A solid that is no oriented boundary keeps its order. Errors: malformed
/// when the skeleton does not fit.
Result<std::string> canonical_skeleton(const Feature& feature, Contract contract);
/// The header that goes with skeletons of contract boundary. Errors: malformed.
Result<std::string> boundary_header(std::string_view header);

/// Reads a CityJSON, or a CityJSONFeature alone. The vertices of the latter are known only if it
/// states a transform of its own; else its solids cannot be read.
Result<Document> read_city_json(std::string_view text, const ReadOptions& options);
/// Whether a text is a CityJSONFeature and no more, as far as it is there: over several lines, or
/// in one line after which nothing follows.
bool is_lone_feature(std::string_view text);
/// Reads a CityJSONFeature alone under the header of the documents to which it belongs, as the one
/// line of a sequence: line ends become spaces. Errors: those of read_document().
Result<Document> read_lone_feature(std::string text, const std::string& header,
                                   const ReadOptions& options);
Result<Document> read_city_json_seq(std::string_view text, const ReadOptions& options);
Result<std::string> write_city_json(const Document& document);
Result<std::string> write_city_json_seq(const Document& document);

/// A geometry of a city object: the index of it in the object's list.
struct GeometryPlace {
  std::string object_id;
  std::uint32_t geometry = 0;
  friend auto operator<=>(const GeometryPlace&, const GeometryPlace&) = default;
};

/// A city model in two texts: one without the chosen geometries, one with them alone and with the
/// objects that have them. Both have the vertices that they use.
struct DividedText {
  std::string rest;
  std::string chosen;
  std::size_t geometries_left = 0;  // the geometries of `rest`
};

/// Divides a CityJSON or CityJSONFeature. Errors: malformed; limit_exceeded. Cost: linear, the text
/// as JSON values.
Result<DividedText> divide_city_model(std::string_view text, const std::set<GeometryPlace>& chosen,
                                      const Limits& limits = {});

/// The number of geometries of a skeleton that are no solids of it, by type: they are kept as they
/// came. Empty for a text that is no skeleton of a city model. Cost: linear.
std::map<std::string, std::uint64_t> other_geometries(std::string_view skeleton);

/// The ids of the city objects of a skeleton, in its order. Empty for a text that is no skeleton of
/// a city model. Cost: linear.
std::vector<std::string> object_ids(std::string_view skeleton);

/// Makes geometries of type Solid of the surfaces that Surfaces::as_solids has read as solids;
/// lists of values by facet get a level for the shell. Returns how many. Errors: malformed. Cost:
/// linear, the text of such features as JSON values.
Result<std::uint64_t> turn_surfaces_into_solids(Document& document);

/// A solid that takes the place of one of a feature.
struct SolidEdit {
  std::size_t number = 0;  // of the solid in Feature::solids
  Solid solid;  // has the vertices of that solid, all of them in their order, and may have more
  std::vector<Index> facet_source;  // facet -> facet of that solid, kNone for a new one
};

/// Puts other solids into a feature. Semantics, materials and textures follow their facets; a new
/// facet gets the semantic surface ClosureSurface where the geometry has semantics, and no texture;
/// nor does a facet whose rings have changed. The bytes of the text that was read do not come back.
/// Errors: malformed when the skeleton cannot be read. Cost: linear, the skeleton as JSON values.
Status replace_solids(Feature& feature, std::vector<SolidEdit> edits);

/// The solids of a document of another format as generic city objects of one CityJSON 2.0, on the
/// finest of their decimal grids. Features of GML that keep their city model (keep_city_model())
/// become that. Errors: unsupported for coordinates on no decimal grid.
Result<Document> as_city_model(const Document& document);

}  // namespace watertight::formats
