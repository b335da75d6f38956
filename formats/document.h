// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads documents into features with solids, and writes them again. A feature keeps everything that
// is not solid geometry in a skeleton, so that writing returns the same document (docs/formats.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "base/result.h"
#include "base/shared_text.h"
#include "geometry/cell_graph.h"
#include "geometry/placement.h"
#include "geometry/solid.h"

namespace watertight::formats {

/// U+FEFF in UTF-8, which some programs write before a text.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

enum class Format : std::uint8_t {
  city_json,
  city_json_seq,
  obj,
  off,
  wkt,
  ewkb,
  gml,      // GML 3.2 solids, CityGML 1 to 3; written as CityGML 2.0
  json_fg,  // read only
  stl,      // text and binary; read only, welded by equal coordinates
  ply,      // text and binary; read only
  poly,     // TetGen; read only
  ifc,      // IFC4, as ISO 10303-21 text; read only, curved solids are tessellated
  step,     // STEP AP203, AP214 and AP242; read only, curved solids are tessellated
  brep,     // boundary representations in JSON; read only, tessellated
  bpt       // Bezier patches; read only, tessellated
};
std::string_view to_string(Format format);
/// The format of this name. Errors: malformed.
Result<Format> format_named(std::string_view name);

/// The format by the file name ("x.city.json", "x.jsonl", "x.obj", "x.off", "x.wkt", "x.wkb",
/// "x.ewkb", "x.gml", "x.xml", "x.stl", "x.ply", "x.poly", "x.ifc", "x.step", "x.brep.json",
/// "x.bpt"), else by the first bytes. Errors: unsupported.
Result<Format> detect_format(std::string_view file_name, ByteView bytes);

/// Whether detect_format() knows the ending of a file name.
bool has_known_ending(std::string_view file_name);

/// Where a solid stands in its document.
struct SolidSource {
  std::string object_id;      // CityObject id; OBJ object name; "" elsewhere
  std::string geometry_type;  // "Solid", "MultiSolid", "CompositeSolid", "POLYHEDRALSURFACE Z", ...
  std::string lod;            // as written, "" when absent
  std::uint32_t geometry = 0;  // index of the geometry within its object
  std::uint32_t ordinal = 0;   // index of the solid within its geometry
  std::string pointer;         // JSON Pointer to the solid's array of shells; "" when not JSON
  /// The Building that the object is or is a part of (rule 601), "" for other objects.
  std::string building_id = {};
  std::uint64_t line = 0;  // the line of a GML document on which the solid starts, from 1; else 0
};

/// How a curved solid became a polyhedron. Lengths are in metres.
struct Tessellation {
  std::uint64_t faces = 0;  // of the curved solid
  std::uint64_t edges = 0;
  std::uint64_t samples = 0;    // vertices on edges, ends included
  std::uint64_t triangles = 0;  // of curved faces
  double chord = 0;             // the limit (ReadOptions::chord)
  double chord_error = 0;       // the largest measured distance of a triangle from its surface
  double gap = 0;               // the largest distance of an edge from a surface of its faces
  int rounds = 1;               // of sampling edges
  std::uint64_t turned = 0;     // faces that the file has the wrong way round
  int halvings = 0;             // of the chord that was asked for, until no facets crossed
  std::uint64_t strips = 0;     // of the triangles of curved faces
  std::uint64_t indices = 0;    // of all strips
  double mean_least_angle = 0;  // degrees: of the triangles of curved faces; 0 without any
  double worst_least_angle = 0;
  struct LeftOut {
    std::string face;  // "#104"
    std::string reason;
  };
  std::vector<LeftOut> left_out = {};
  struct FaceStrips {
    std::string face;
    /// Vertices of the solid; every three in turn are a triangle, every second one the other way
    /// round, and one with two equal vertices is none.
    std::vector<std::vector<Index>> strips;
  };
  std::vector<FaceStrips> face_strips = {};  // if CurvedReading::keeps_strips; of curved faces
};

/// True for a geometry whose boundaries are facets without shells around them (MultiSurface,
/// CompositeSurface, and the surfaces of GML), by its type. Pointers to its places have no step for
/// the shell.
bool is_surface(const SolidSource& source);

struct SubmittedSolid {
  Solid solid;  // vertices in order of first use; equal vertices are not merged
  SolidSource source;
  std::vector<Index> rounded = {};  // vertices whose source digits were rounded
  /// Rings whose last position does not repeat the first, in formats that demand it (finding 103);
  /// indices into the rings of `solid`, ascending.
  std::vector<Index> unclosed_rings = {};
  /// The gml:id of the polygon of each facet, "" where it has none; empty when no polygon has one.
  std::vector<std::string> facet_ids = {};
  /// The gml:id of each ring, "" where it has none; empty when no ring has one.
  std::vector<std::string> ring_ids = {};
  /// The lines of a GML document on which the polygon of each facet and each ring start; from 1, 0
  /// for a ring that is missing. Empty in other formats.
  std::vector<std::uint64_t> facet_lines = {};
  std::vector<std::uint64_t> ring_lines = {};
  /// Why the solid could not be read, "" if it was. `solid` has no shell then, and is not valid.
  std::string unreadable = {};
  /// Unused vertices of a file whose list of vertices is for this solid alone.
  geometry::UnusedVertices unused = {};
  bool is_origin_rounded = false;  // LatticePoints::is_origin_rounded
  /// How the solid was repaired, as JSON (docs/report.md, "Repairs"); "" for one that came so.
  std::string repair = {};
  std::optional<Tessellation> tessellation = {};  // of a curved solid
};

/// An instance of a geometry template. It is validated where its placement puts it, like a solid,
/// but is no solid of the feature: writing takes it from the skeleton.
struct TemplateInstance {
  SolidSource source;                 // `pointer` leads to the instance; `lod` is empty
  std::uint64_t template_number = 0;  // SolidSource::geometry of its solids in Document::templates
  geometry::Placement placement;
};

/// A part of a feature that could not be read, for validation only: the skeleton has it as it came.
struct UnreadablePart {
  SolidSource source;  // `pointer` leads to the fault or to the geometry that has it
  Error error;
};

/// One feature: a top-level city object with its descendants; one `o` object of an OBJ file; one
/// geometry elsewhere.
struct Feature {
  std::string id;
  std::string type;  // type of the top-level object, "" when there is none
  std::uint32_t srid = 0;
  std::vector<SubmittedSolid> solids;
  /// Everything but the solids' geometry, as UTF-8 JSON; write_feature needs it. Opaque.
  std::string skeleton;
  /// How the text of the document was written (ReadOptions::keep_text), so that the same bytes come
  /// back; empty: compact JSON is written. Opaque (formats/text/text_layout.h).
  Bytes layout = {};
  /// Instances of geometry templates, also of templates that are no solids; in document order.
  std::vector<TemplateInstance> instances = {};
  std::vector<UnreadablePart> unreadable = {};  // in document order
  /// Surfaces, each with its facets in one shell and on a lattice of its own, for validation only:
  /// the skeleton has them as they came. Empty without ReadOptions::surfaces; in document order.
  std::vector<SubmittedSolid> surfaces = {};
  Index cell = kNone;  // the index in Document::graph.cells of the cell that the feature is
};

/// The number of solids of a feature, with its surfaces and its parts that could not be read.
std::uint64_t solid_count(const Feature& feature);
/// Errors: limit_exceeded for more than Limits::solids.
Status check_solid_count(const Feature& feature, const Limits& limits);

struct Document {
  Format format = Format::city_json;
  /// The values that features share (CityJSON: version, transform, metadata, templates, ...), as
  /// the first line of a CityJSONSeq: UTF-8 JSON. "" for formats that share nothing.
  SharedText header;
  std::vector<Feature> features;
  std::vector<std::string> notes;  // readings of doubtful input, one clause each
  /// Solids of CityJSON geometry templates, for validation only: writing takes them from `header`.
  /// Coordinates are the templates' own, on no reference system; `source.pointer` is, for example,
  /// "/geometry-templates/templates/0/boundaries" and `source.geometry` the template's index.
  std::vector<SubmittedSolid> templates = {};
  /// Surfaces of geometry templates, as Feature::surfaces; in the templates' own coordinates.
  std::vector<SubmittedSolid> template_surfaces = {};
  /// Instances that belong to no feature: in GML an object without solids is not a feature.
  std::vector<TemplateInstance> instances = {};
  /// Of a document read with ReadOptions::keep_text: the bytes between the lines of a CityJSONSeq,
  /// empty for line feeds; in formats other than those of CityJSON the bytes of the document, with
  /// references to the solids of all features (formats/text/kept_text.h). Opaque.
  Bytes framing = {};
  /// The graph of an indoor model (IndoorGML), for validation only; empty in other documents.
  geometry::CellGraph graph = {};
};

/// The contract levels: how much of a document comes back.
enum class Contract : std::uint8_t {
  exact,    // the bytes of the document if it kept its text (keep_text), else its values in order
  lattice,  // the values of the document; solids in canonical form (geometry/canonical_form.h),
            // lists by facet or ring in the same order, and vertices numbered by the solids
  boundary  // solids in canonical form; else only city objects with types, parents and children
};
std::string_view to_string(Contract contract);
/// The contract of this name. Errors: invalid_argument.
Result<Contract> contract_named(std::string_view name);

/// The surfaces of a document: MultiSurface and CompositeSurface of CityJSON, and geometries of GML
/// that are surfaces or polygons.
enum class Surfaces : std::uint8_t {
  ignore,    // they stay as they came
  read,      // Feature::surfaces has them as well
  as_solids  // as `read`, but one that is one closed shell is a solid of its feature instead
};

inline constexpr double kUsualChord = 0.01;  // metres

/// How curved solids become polyhedra.
struct CurvedReading {
  double chord = kUsualChord;  // metres: how far triangles may be from their surfaces
  /// The step of the lattice of vertices, as a power of ten of a metre; nothing: the largest that
  /// is not above a hundredth of the chord.
  std::optional<int> lattice_exponent = {};
  bool keeps_strips = false;  // in Tessellation::face_strips
  /// Whether facets of a solid cross. A solid where they do is tessellated again with half the
  /// chord, at most 4 times and with at most 100,000 triangles; if they still cross, it stays as it
  /// was. Null: nobody looks.
  bool (*has_crossing)(const Solid& solid) = nullptr;
};

struct ReadOptions {
  Limits limits;
  /// Whether a CityJSON document becomes one feature per top-level object (stores), or one feature
  /// whose skeleton returns the whole document (files). The solids are equal either way.
  bool split_features = true;
  /// Whether a document and a CityJSONFeature of a sequence can be written byte for byte as they
  /// were read. A document other than a sequence keeps its text unless `split_features` is true.
  bool keep_text = false;
  Surfaces surfaces = Surfaces::ignore;
  CurvedReading curved = {};
};

/// Reads a document. Errors: malformed, unsupported or limit_exceeded with byte offset (syntax) or
/// JSON Pointer (content). Cost: linear; boundaries of CityJSON never become JSON values.
Result<Document> read_document(ByteView bytes, Format format, const ReadOptions& options = {});

/// The text of a feature with its solids put back: a CityJSONFeature (one line) for CityJSON and
/// CityJSONSeq. Solids must be in the order and with the facet, ring and vertex order of the
/// feature that was read. Errors: malformed if skeleton and solids do not fit, or if the feature's
/// layout belongs to another text.
Result<std::string> write_feature(const Document& document, const Feature& feature);

/// The bytes of a whole document. City models become a CityJSON of all features (city_json), or a
/// header line and feature lines (city_json_seq), or a CityGML 2.0 (gml; write_city_gml()); a
/// document that kept its text returns it in its own format. For obj, off, wkt and ewkb: the solids
/// of all features. Other formats can only be written as the text that was kept. Errors: malformed
/// if the solids are not those of the text; unsupported when a format cannot hold the document
/// (OFF: several solids; OBJ, OFF: rings with holes, which only `convert` triangulates).
Result<Bytes> write_document(const Document& document, Format format);

}  // namespace watertight::formats

namespace watertight {

using formats::Document;
using formats::Feature;
using formats::Format;
using formats::SolidSource;
using formats::SubmittedSolid;

}  // namespace watertight
