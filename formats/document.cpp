// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/document.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/quantity.h"
#include "formats/city_json/city_json.h"
#include "formats/curved/curved_files.h"
#include "formats/ewkb.h"
#include "formats/gml/city/city.h"
#include "formats/gml/gml.h"
#include "formats/gml/written/city_gml.h"
#include "formats/json_fg.h"
#include "formats/mesh/mesh_places.h"
#include "formats/mesh/mesh_text.h"
#include "formats/text/kept_text.h"
#include "formats/text/ring_search.h"

namespace watertight::formats {
namespace {

Bytes bytes_of(const std::string& text) { return Bytes(text.begin(), text.end()); }

bool is_city(Format format) {
  return format == Format::city_json || format == Format::city_json_seq;
}

// Whether the rings of a format's solids are not in its text.
bool is_curved(Format format) {
  return format == Format::ifc || format == Format::step || format == Format::brep ||
         format == Format::bpt;
}

// Errors: malformed for a solid that could not be read, and so cannot be written.
Status all_readable(std::span<const Feature> features) {
  for (const Feature& feature : features) {
    for (const SubmittedSolid& solid : feature.solids) {
      if (!solid.unreadable.empty()) return Error{ErrorCode::malformed, solid.unreadable};
    }
  }
  return Done{};
}

// Errors: limit_exceeded for more solids than a text of this length, or one feature, may have.
Status check_solid_counts(const Document& document, std::uint64_t bytes, const Limits& limits) {
  std::uint64_t count = 0;
  for (const Feature& feature : document.features) {
    if (Status status = check_solid_count(feature, limits); !status) return status;
    count += solid_count(feature);
  }
  if (count <= limits.solids_of(bytes)) return Done{};
  return Error{ErrorCode::limit_exceeded, "more than " + std::to_string(limits.solids_of(bytes)) +
                                              " solids in " + quantity(bytes, "byte")};
}

// Writes the solids of all features, one after the other.
Result<Bytes> write_solids(std::span<const Feature> features, Format format) {
  if (auto status = all_readable(features); !status) return std::move(status).error();
  const auto has_solids = [](const Feature& feature) { return !feature.solids.empty(); };
  if (std::none_of(features.begin(), features.end(), has_solids)) {
    return Error{ErrorCode::unsupported,
                 "there is no solid to write as " + std::string(to_string(format))};
  }
  if (format == Format::obj || format == Format::off) {
    auto text = format == Format::obj ? write_obj(features) : write_off(features);
    if (!text) return std::move(text).error();
    return bytes_of(*text);
  }
  if (format != Format::wkt && format != Format::ewkb) {
    return Error{ErrorCode::unsupported,
                 std::string(to_string(format)) + " can be read, but not written"};
  }
  Bytes out;
  for (const Feature& feature : features) {
    for (const SubmittedSolid& solid : feature.solids) {
      const Bytes bytes =
          format == Format::wkt ? bytes_of(write_wkt(solid.solid) + '\n') : write_ewkb(solid.solid);
      out.insert(out.end(), bytes.begin(), bytes.end());
    }
  }
  return out;
}

// The document as it was read with ReadOptions::keep_text.
Result<Bytes> write_kept(const Document& document) {
  Bytes written;
  if (needs_written(document.framing)) {
    auto solids = write_solids(document.features, document.format);
    if (!solids) return solids;
    written = *std::move(solids);
  }
  return restored_bytes(document.framing, solids_of(document), written, Limits{}.bytes);
}

// Keeps the bytes of a document whose reader does not keep them itself, in the form of fewest
// bytes.
void keep_bytes(ByteView bytes, Document& document) {
  std::vector<Bytes> forms{keep_whole(bytes)};
  if (const auto written = write_solids(document.features, document.format)) {
    forms.push_back(keep_as_written(bytes, *written));
  }
  const bool is_stl = document.format == Format::stl;
  const auto solids = solids_of(document);
  if (const auto places = indexed_places(bytes, document.format)) {
    if (auto form = keep_with_indices(bytes, *places, solids)) forms.push_back(*std::move(form));
  }
  if (is_stl && is_binary_stl(bytes)) {
    forms.push_back(keep_with_rings(bytes, binary_stl_rings(bytes), solids));
  } else if (document.format != Format::ewkb && !is_curved(document.format)) {
    const auto end = is_stl ? RingEnd::open : RingEnd::closed;
    forms.push_back(keep_with_rings(bytes, find_rings(as_text(bytes), solids, end), solids));
  }
  const auto is_shorter = [](const Bytes& a, const Bytes& b) { return a.size() < b.size(); };
  document.framing = std::move(*std::min_element(forms.begin(), forms.end(), is_shorter));
}

}  // namespace

std::string_view to_string(Format format) {
  switch (format) {
    case Format::city_json:
      return "city-json";
    case Format::city_json_seq:
      return "city-json-seq";
    case Format::obj:
      return "obj";
    case Format::off:
      return "off";
    case Format::wkt:
      return "wkt";
    case Format::ewkb:
      return "ewkb";
    case Format::gml:
      return "gml";
    case Format::json_fg:
      return "json-fg";
    case Format::stl:
      return "stl";
    case Format::ply:
      return "ply";
    case Format::poly:
      return "poly";
    case Format::ifc:
      return "ifc";
    case Format::step:
      return "step";
    case Format::brep:
      return "brep";
    case Format::bpt:
      return "bpt";
  }
  return "";
}

std::string_view to_string(Contract contract) {
  switch (contract) {
    case Contract::exact:
      return "exact";
    case Contract::lattice:
      return "lattice";
    case Contract::boundary:
      return "boundary";
  }
  return "";
}

Result<Contract> contract_named(std::string_view name) {
  for (const Contract contract : {Contract::exact, Contract::lattice, Contract::boundary}) {
    if (to_string(contract) == name) return contract;
  }
  return Error{ErrorCode::invalid_argument,
               "a contract is exact, lattice or boundary, not '" + std::string(name) + "'"};
}

Result<Format> format_named(std::string_view name) {
  for (const Format format :
       {Format::city_json, Format::city_json_seq, Format::obj, Format::off, Format::wkt,
        Format::ewkb, Format::gml, Format::json_fg, Format::stl, Format::ply, Format::poly,
        Format::ifc, Format::step, Format::brep, Format::bpt}) {
    if (to_string(format) == name) return format;
  }
  return Error{ErrorCode::malformed, "stored in an unknown format '" + std::string(name) + "'"};
}

namespace {

// A GML document; for a store, with the city model of its features.
Result<Document> read_gml_document(ByteView bytes, const ReadOptions& options) {
  auto document = read_gml(bytes, options);
  if (!document || !options.keep_text || !options.split_features) return document;
  keep_city_model(*document, bytes, options.limits);
  return document;
}

Result<Document> read_as(ByteView bytes, Format format, const ReadOptions& options) {
  switch (format) {
    case Format::city_json:
      return read_city_json(as_text(bytes), options);
    case Format::city_json_seq:
      return read_city_json_seq(as_text(bytes), options);
    case Format::obj:
      return read_obj(as_text(bytes), options.limits);
    case Format::off:
      return read_off(as_text(bytes), options.limits);
    case Format::json_fg:
      return read_json_fg(as_text(bytes), options);
    case Format::stl:
      return read_stl(bytes, options.limits);
    case Format::ply:
      return read_ply(bytes, options.limits);
    case Format::poly:
      return read_poly(as_text(bytes), options.limits);
    case Format::wkt:
      return read_wkt_document(as_text(bytes), options.limits);
    case Format::ewkb:
      return read_ewkb_document(bytes, options.limits);
    case Format::gml:
      return read_gml_document(bytes, options);
    case Format::ifc:
      return read_ifc(as_text(bytes), options);
    case Format::step:
      return read_step(as_text(bytes), options);
    case Format::brep:
      return read_brep(as_text(bytes), options);
    case Format::bpt:
      return read_bpt(as_text(bytes), options);
    default:
      break;
  }
  return Error{ErrorCode::unsupported, "no reader for " + std::string(to_string(format))};
}

// Whether a byte order mark precedes the text of a mesh or of WKT. The readers of JSON and XML skip
// it themselves.
bool has_byte_order_mark(ByteView bytes, Format format) {
  switch (format) {
    case Format::obj:
    case Format::off:
    case Format::ply:
    case Format::poly:
    case Format::wkt:
    case Format::ifc:
    case Format::step:
    case Format::bpt:
      return as_text(bytes).starts_with(kByteOrderMark);
    case Format::stl:
      return as_text(bytes).starts_with(kByteOrderMark) && !is_binary_stl(bytes);
    default:
      return false;
  }
}

}  // namespace

std::uint64_t solid_count(const Feature& feature) {
  return feature.solids.size() + feature.unreadable.size() + feature.surfaces.size();
}

Status check_solid_count(const Feature& feature, const Limits& limits) {
  const std::uint64_t count = solid_count(feature);
  if (count <= limits.solids) return Done{};
  return Error{ErrorCode::limit_exceeded, quantity(count, "solid") + " in the feature '" +
                                              feature.id + "'; the limit is " +
                                              std::to_string(limits.solids)};
}

Result<Document> read_document(ByteView bytes, Format format, const ReadOptions& options) {
  if (bytes.size() > options.limits.bytes) {
    return Error{ErrorCode::limit_exceeded, std::to_string(bytes.size()) + " bytes; the limit is " +
                                                std::to_string(options.limits.bytes)};
  }
  const bool has_mark = has_byte_order_mark(bytes, format);
  auto document = read_as(has_mark ? bytes.subspan(kByteOrderMark.size()) : bytes, format, options);
  if (!document) {
    Error error = std::move(document).error();
    if (has_mark && error.byte_offset) *error.byte_offset += kByteOrderMark.size();
    return error;
  }
  if (Status status = check_solid_counts(*document, bytes.size(), options.limits); !status) {
    return std::move(status).error();
  }
  if (has_mark) document->notes.emplace_back("byte order mark skipped");
  const bool keeps_text = options.keep_text && !options.split_features;
  if (keeps_text && !is_city(format) && format != Format::gml) keep_bytes(bytes, *document);
  return document;
}

Result<std::string> write_feature(const Document& document, const Feature& feature) {
  if (is_city(document.format)) {
    auto header = read_city_json_header(document.header, kOwnText);
    if (!header) return std::move(header).error();
    return write_city_json_feature(*header, feature);
  }
  auto bytes = write_solids({&feature, 1}, document.format);
  if (!bytes) return std::move(bytes).error();
  return std::string(as_text(*bytes));
}

Result<Bytes> write_document(const Document& document, Format format) {
  const bool is_kept = format == document.format && !document.framing.empty();
  if (!is_city(format) && is_kept) return write_kept(document);
  if (!is_city(format) && format != Format::gml) return write_solids(document.features, format);
  if (!is_city(document.format)) {
    if (auto status = all_readable(document.features); !status) return std::move(status).error();
    auto model = as_city_model(document);
    if (!model) return std::move(model).error();
    auto written = write_document(*model, format);
    if (written || written.error().code != ErrorCode::malformed) return written;
    // Nothing is wrong with the document: its decimals span more digits than one grid has.
    return Error{
        ErrorCode::unsupported,
        "a city model needs one decimal grid for all coordinates: " + written.error().message};
  }
  auto text = format == Format::gml         ? write_city_gml(document)
              : format == Format::city_json ? write_city_json(document)
                                            : write_city_json_seq(document);
  if (!text) return std::move(text).error();
  return bytes_of(*text);
}

}  // namespace watertight::formats
