// SPDX-License-Identifier: GPL-3.0-or-later
//
// The whole path of a document, shared by service and command line: it is validated, encoded and
// stored; a stored one is decoded and written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/cancel.h"
#include "codec/blob.h"
#include "formats/city_json/city_json.h"
#include "formats/document.h"
#include "pipeline/repaired/solid_repair.h"
#include "repair/repair.h"
#include "store/solid_store.h"
#include "validate/certify.h"
#include "validate/groups.h"
#include "validate/surface/inspect_surface.h"

namespace watertight::pipeline {

struct InspectedSolid {
  SolidSource source;
  Inspection inspection;
  /// Present for a surface, which is judged by the rules of rings and facets and is no solid.
  std::optional<validate::SurfaceFacts> surface = {};
  /// What became of a solid that was not valid as it was read, if solids were repaired.
  std::optional<repair::RepairSummary> repair = {};
  std::optional<formats::Tessellation> tessellation = {};  // of a curved solid
};

/// The number of surfaces of a feature, or of many.
struct SurfaceCounts {
  std::uint64_t checked = 0;
  std::uint64_t with_findings = 0;
  std::uint64_t closed = 0;        // in one shell or several
  std::uint64_t closed_valid = 0;  // that would be a valid solid
  void add(const validate::SurfaceInspection& surface);
  void add(const SurfaceCounts& other);
};

/// Solids of a feature that are compared with each other: the members of one CompositeSolid, or the
/// solids of one building and its parts in one level of detail. For a feature that is a cell of an
/// indoor model: its solids, which are compared with those of other features.
struct InspectedGroup {
  validate::GroupKind kind = validate::GroupKind::composite_solid;
  std::string object_id;             // the composite's object, the building, or the cell
  std::string lod;                   // as written, "" when absent
  std::vector<std::size_t> members;  // indices into the feature's solids, ascending
  validate::GroupReport report;      // Place::solid is an index into `members`
};

struct InspectedFeature {
  /// The feature with its own solids, then those of each instance of a geometry template that is
  /// not valid or in whose group something was found, as placed, with rounded vertices; then an
  /// empty one for each part that could not be read; then the surfaces that are closed or in which
  /// something was found. So a feature that is valid has no other solids than its own, and
  /// surfaces.
  Feature feature;
  std::vector<InspectedSolid> solids;  // one for each of feature.solids, in order
  std::size_t own = 0;                 // how many of them are the feature's own solids
  std::vector<InspectedGroup> groups;  // in order of their first members
  SurfaceCounts surfaces = {};         // of all surfaces that were inspected
  Verdict verdict() const;             // the worst of solids and groups; valid without any
};

/// What becomes of surfaces in a validation.
struct SurfaceRule {
  formats::Surfaces reading = formats::Surfaces::read;
  Severity severity = Severity::warning;  // CertifyOptions::severity_of_surfaces
};

/// The rule of this name: `ignore`; `check`, findings are warnings; `judge`, they are errors;
/// `as-solids`, closed surfaces are solids, and findings in others are warnings. Errors:
/// invalid_argument.
Result<SurfaceRule> surface_rule_named(const std::string& name);

/// How curved solids are read wherever they are judged or stored: one whose facets cross at this
/// chord, in metres, is tessellated at a smaller one.
formats::CurvedReading curved_reading(double chord = formats::kUsualChord);
/// The exponent of a lattice whose step in metres is this text, a power of ten. Errors:
/// invalid_argument.
Result<int> lattice_exponent_of(std::string_view step);

/// The options with what the reader of a solid noted about it. Keeps references to `submitted`.
CertifyOptions options_for(const SubmittedSolid& submitted, const CertifyOptions& options);

/// The worse of two verdicts: invalid, then undecided, then valid.
Verdict worse(Verdict a, Verdict b);

class TemplateInspector;
class CellInspector;
class StageTimes;

/// The options for groups, with the limit of findings of `options`, and with its poll if they have
/// none.
validate::GroupOptions group_options(const validate::GroupOptions& groups,
                                     const CertifyOptions& options);

/// Validates every solid of a feature, its instances of the geometry templates that `templates`
/// knows (null: of none), and the groups of both. The results of a feature that is a cell are taken
/// from `cells` if not null; without, the cell is not compared with others. Guarantees one
/// InspectedSolid per solid. A solid with vertices that the reader rounded, or rings that the
/// source left open, gets the findings for them. The limit of findings and the cancellation of
/// solids hold for groups too.
InspectedFeature inspect(Feature feature, delaunay::EngineWorkers* workers,
                         const CertifyOptions& options, const validate::GroupOptions& groups = {},
                         TemplateInspector* templates = nullptr, CellInspector* cells = nullptr);

/// Inspects the surfaces of the feature, which it takes out of it. Adds those that are closed or in
/// which something was found to the solids.
void add_surfaces(InspectedFeature& inspected, const CertifyOptions& options);

/// The outcome of one solid of a document.
struct SolidOutcome {
  SolidSource source;
  Report report;
  std::string report_json;       // the JSON of the report, without times
  std::size_t blob_bytes = 0;    // 0 unless encoded
  std::size_t source_bytes = 0;  // bytes as plain arrays: 24 a vertex, 4 a ring vertex
};

/// The outcome of one feature of a document.
struct FeatureOutcome {
  std::string id;
  bool has_own_id = true;  // false: named by IngestOptions::unnamed
  std::uint64_t line = 0;  // of a sequence, from 1; 0 in other documents
  Verdict verdict = Verdict::undecided;
  std::vector<SolidOutcome> solids;
  std::vector<InspectedGroup> groups;
  /// What became of the solids that were not valid as they were read (IngestOptions::repair).
  std::vector<SolidRepair> repairs;
  /// The geometries that Policy::skip has left out of the feature that is stored.
  std::vector<formats::GeometryPlace> left_out;
  /// A CityJSONFeature or CityJSON of what is left out; "" without it, and for other formats.
  std::string rejected;
  bool is_stored = false;
  std::uint64_t version = 0;  // 0 unless stored
};

using store::Policy;

/// The policy named "refuse", "skip" or "keep". Errors: invalid_argument.
Result<Policy> policy_named(const std::string& name);
std::string_view to_string(Policy policy);

/// Called with the number of features that are done and of all, from one thread at a time.
using Progress = std::function<void(std::size_t, std::size_t)>;

/// Whether the certificates' Steiner vertices go into the blobs (mode `bitmap` only, and with
/// delaunay::LadderOptions::keeps_facets).
enum class SteinerVertices : std::uint8_t { leave_out, keep };

/// How a feature is encoded, and for which collection.
struct FeatureEncoding {
  std::string collection;
  EncodeOptions encode;
  SteinerVertices steiner = SteinerVertices::leave_out;
  formats::Contract contract = formats::Contract::exact;
};

struct IngestOptions : FeatureEncoding {
  CertifyOptions certify;
  validate::GroupOptions groups;
  /// Absent: that of the collection; refuse where there is none. A collection that the write makes
  /// gets this policy.
  std::optional<Policy> policy;
  /// How solids are repaired before they are judged; absent: not at all. Its `certify` is not used.
  std::optional<repair::RepairOptions> repair;
  /// How the document was read (ReadOptions::surfaces): Policy::skip reads features again.
  formats::Surfaces surfaces = formats::Surfaces::ignore;
  /// The name of features that have no id: "house" makes house, house-2, ...; "": they are refused.
  std::string unnamed;
  store::WriteCondition condition;  // for each feature that is stored
  /// The bytes of encoded features that wait in memory; more wait in a temporary file.
  std::size_t batch_bytes = std::size_t{8} << 20U;
  std::size_t threads = 1;
  CancelPoll is_cancelled = {};
  Progress progress = {};        // of encode_document()
  StageTimes* stages = nullptr;  // gets the time of each stage; null: nobody counts it
};

/// A feature with its solids encoded: those that are proven as blobs, the others in the skeleton.
struct EncodedFeature : store::FeatureRecord {
  /// Feature::skeleton; before it, a line for each solid that is not proven and for each whose
  /// equal vertices were merged; after it, a line feed and Feature::layout if the feature has one
  /// (pipeline/stored/stored_feature.cpp).
  std::string skeleton;
};

/// A document with its solids encoded; `header` and `framing` are those of Document.
struct EncodedDocument {
  std::string format;  // to_string(Format)
  SharedText header;
  Bytes framing;
  std::vector<EncodedFeature> features;
};

/// Encodes a feature with its own solids. A solid whose verdict is valid becomes a blob; any other,
/// which only `Policy::keep` gives to this function, stays as it came. For contract
/// boundary, document.header must be a boundary_header(). Errors: those of encode().
Result<EncodedFeature> encode_feature(const InspectedFeature& feature, const Document& document,
                                      const FeatureEncoding& options);

/// The proven solids of a feature, in order, from its blobs and its page. Errors: those of
/// decode(); malformed.
Result<std::vector<Decoded>> decode_solids(const store::FeatureRecord& feature,
                                           const Limits& limits = {});
/// The blob of a solid of a feature, which is encoded again if it is in the page. Requires a proven
/// solid. Errors: those of decode_solids() and encode().
Result<Bytes> blob_of(const store::FeatureRecord& feature, std::size_t solid,
                      const Limits& limits = {});

/// The document (with one feature) that encode_feature() was given. Errors: malformed when
/// encode_feature() did not make the feature; those of decode().
Result<Document> decode_feature(const EncodedFeature& feature, const Limits& limits = {});
/// The document of a feature whose proven solids are decoded already, in the order of
/// feature.solids; the feature's blobs are not used.
Result<Document> decode_feature(const EncodedFeature& feature, std::vector<Solid> solids,
                                const Limits& limits = {});

/// The number of geometries of the feature that are no solids, by type; they are kept as they came
/// and no proof is about them. For city models. Cost: linear in the skeleton.
std::map<std::string, std::uint64_t> other_geometries(const EncodedFeature& feature);

/// The text of a feature as the store keeps it: the skeleton, and what of measures, reports and
/// findings does not follow from the solids. Cost: that of decoding the solids.
std::string stored_text(const EncodedFeature& feature);
/// The feature as the store keeps it, its text packed with a dictionary (null: none), and its
/// solids in a page where that is smaller. Errors: those of packing::pack() and decode().
Result<StoredFeature> pack(EncodedFeature feature, const packing::DictionaryPointer& dictionary);
/// The same when the text, which is stored_text(feature), was made before.
Result<StoredFeature> pack(const std::string& text, EncodedFeature feature,
                           const packing::DictionaryPointer& dictionary);

/// The solids whose measures and reports unpack() makes, at the cost of decoding them.
enum class Reports : std::uint8_t { none, of_unproven, all };
/// The feature that pack() was given, with its page if it has one. Errors: those of
/// packing::unpack(); malformed.
Result<EncodedFeature> unpack(StoredFeature stored, const Limits& limits = {},
                              Reports reports = Reports::all);
/// The document of a stored feature: unpack(), then decode_feature().
Result<Document> from_stored(StoredFeature stored, const Limits& limits = {});

/// The result of a document in numbers.
struct IngestCounts {
  std::uint64_t total = 0;  // the number of features
  std::uint64_t invalid = 0;
  std::uint64_t undecided = 0;
  std::uint64_t stored = 0;
  std::uint64_t unproven = 0;           // the number of solids that were kept without proof
  std::uint64_t unproven_features = 0;  // the number of features that were kept without proof
  std::uint64_t twins = 0;  // the number of stored features that have the box of another one
  Verdict verdict = Verdict::valid;  // the worst of all features

  void add(Verdict of_feature);
  /// Adds the numbers of another document.
  void add(const IngestCounts& other);
};

/// The most twins that are named.
inline constexpr std::size_t kMostTwins = 100;

struct IngestOutcome : IngestCounts {
  std::vector<FeatureOutcome> features;        // in document order; all, or those that were kept
  std::vector<store::Twins> first_twins = {};  // at most kMostTwins
};

/// A document encoded feature by feature, but not stored.
struct EncodeOutcome {
  EncodedDocument document;  // features in document order; none if the policy is to refuse them
  IngestOutcome outcome;
};

/// Validates and encodes a document. Errors: cancelled; those of encode().
Result<EncodeOutcome> encode_document(Document document, delaunay::EngineWorkers* workers,
                                      const IngestOptions& options);

/// Validates, encodes and stores a document that is in memory
/// (pipeline/streaming/ingestion.h). Errors: those of Ingestion.
Result<IngestOutcome> ingest(Document document, SolidStore& store, delaunay::EngineWorkers* workers,
                             const IngestOptions& options);

/// Reads a document, whole, that is to be written as `to`. A GML document that becomes a city model
/// keeps more of it than its solids, and its notes say what has no place there. Errors: those of
/// formats::read_document().
Result<Document> read_to_convert(ByteView bytes, Format from, Format to,
                                 formats::ReadOptions options);

/// The document in another format; facets with holes become triangles where the format has no holes
/// (OBJ, OFF). Errors: those of write_document(); not_encodable naming a facet that has no
/// triangulation.
Result<Bytes> convert_document(const Document& document, Format format);

}  // namespace watertight::pipeline
