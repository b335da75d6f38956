// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands encode, decode, info and convert, which read files and write files.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/outputs/documents.h"
#include "cli/remote/http_file.h"
#include "cli/sources/input_list.h"
#include "cli/sources/ranged_file.h"
#include "cli/terminal/printable.h"
#include "cli/terminal/progress.h"
#include "codec/explain.h"
#include "files/files.h"
#include "files/inputs.h"
#include "pipeline/container.h"
#include "pipeline/outcome_json.h"
#include "validate/finding_kinds.h"

namespace watertight::cli {
namespace {

using Json = nlohmann::ordered_json;

bool replaces(const std::string& output, const std::string& input) {
  return output != "-" && files::is_same_file(output, input);
}

Exit refuse_to_replace(const std::string& input, const std::string& output) {
  return fail(input,
              {ErrorCode::invalid_argument, "the output '" + output + "' would replace the input"});
}

/// Warns of rounded coordinates: rounding changes even a valid solid, so it must not pass in
/// silence.
void tell_rounded(const std::string& file, const pipeline::IngestOutcome& outcome) {
  for (const pipeline::FeatureOutcome& feature : outcome.features) {
    for (const pipeline::SolidOutcome& solid : feature.solids) {
      for (const Finding& finding : solid.report.findings) {
        if (finding.code != validate::kCoordinatesRounded) continue;
        const std::string& place = solid.source.pointer;
        const std::string text =
            "warning 805: " + finding.detail + (place.empty() ? "" : " at " + place);
        std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(),
                     printable(text).c_str());
      }
    }
  }
}

/// Reads the one document that an argument stands for.
Result<files::WholeInput> read_argument(const std::string& argument) {
  const auto input = single_input(argument);
  if (!input) return input.error();
  return files::read_whole(*input, {});
}

Result<files::Input> load(const files::InputFile& file, const formats::ReadOptions& options) {
  const auto whole = files::read_whole(file, options.limits);
  if (!whole) return whole.error();
  return files::load_input(whole->name, whole->bytes, options);
}

Mode mode_named(const std::string& name) {
  for (const Mode mode :
       {Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon, Mode::parallelogram}) {
    if (name == codec::to_string(mode)) return mode;
  }
  return Mode::automatic;
}

Result<Bytes> pack(const EncodeCommand& command, const pipeline::EncodedDocument& document) {
  if (!command.is_bare) {
    pipeline::ContainerOptions options;
    options.pages.mode = mode_named(command.mode);
    options.purpose = *pipeline::file_purpose_named(command.purpose);
    return pipeline::write_container(document, options);
  }
  std::size_t solids = 0;
  const Bytes* blob = nullptr;
  for (const pipeline::EncodedFeature& feature : document.features) {
    solids += feature.solids.size();
    for (const StoredSolid& solid : feature.solids) {
      if (!solid.is_proven) {
        return Error{ErrorCode::not_encodable, "the solid is not valid, so there is no blob of it"};
      }
    }
    if (!feature.solids.empty()) blob = &feature.solids.front().blob;
  }
  if (solids == 1) return *blob;
  return Error{
      ErrorCode::invalid_argument,
      "--bare needs a document with exactly one solid; this one has " + std::to_string(solids)};
}

/// What an argument stands for: a Watertight file, or the bytes of something else.
struct Encoded {
  files::WholeInput whole;  // without bytes if it is on a web server
  std::optional<pipeline::ContainerFile> container;
};

/// Opens an argument. A torn end of a Watertight file is reported and left out.
Status open_encoded(const std::string& argument, Encoded& encoded) {
  if (is_url(argument)) {
    auto file = open_container(argument);
    if (!file) return std::move(file).error();
    encoded.container = *std::move(file);
    return Done{};
  }
  auto whole = read_argument(argument);
  if (!whole) return std::move(whole).error();
  encoded.whole = *std::move(whole);
  if (files::kind_of_input(encoded.whole.bytes) != files::InputKind::container) return Done{};
  auto file = pipeline::ContainerFile::open(encoded.whole.bytes, {}, pipeline::TornTail::leave_out);
  if (!file) return std::move(file).error();
  warn_of_torn(argument, *file);
  encoded.container = *std::move(file);
  return Done{};
}

/// The documents of a Watertight file, or the one document of a blob.
Result<std::vector<Document>> load_encoded(Encoded& encoded, std::size_t jobs) {
  if (encoded.container) {
    return pipeline::decode_container(*encoded.container, {}, static_cast<unsigned>(jobs));
  }
  auto input = files::load_input(encoded.whole.name, encoded.whole.bytes, {});
  if (!input) return std::move(input).error();
  if (input->kind == files::InputKind::document) {
    return Error{ErrorCode::malformed, "neither a Watertight file nor a blob"};
  }
  std::vector<Document> documents;
  documents.push_back(std::move(input->document));
  return documents;
}

Json json_of(const codec::BlobInfo& info) {
  Json json{{"formatVersion", info.version},
            {"models", info.models},
            {"mode", codec::to_string(info.mode)},
            {"srid", info.srid},
            {"vertices", info.vertices},
            {"steinerVertices", info.steiner_vertices},
            {"facets", info.facets},
            {"rings", info.rings},
            {"shells", info.shells},
            {"delaunayFaces", info.delaunay_faces},
            {"markedFaces", info.marked_faces},
            {"unrecoveredFaces", info.unrecovered_faces},
            {"hasOrder", info.has_order},
            {"ruleSet", info.acceptance.rule_set},
            {"proof", info.acceptance.proof == Proof::boundary ? "boundary" : "tetrahedralization"},
            {"planarityMetres", info.acceptance.tolerances.planarity_metres},
            {"planarityDegrees", info.acceptance.tolerances.planarity_degrees},
            {"checksum", info.checksum}};
  json["parts"] = Json::object();
  for (const codec::BlobInfo::Part& part : info.parts) json["parts"][part.name] = part.bytes;
  return json;
}

void print_info(const Json& json, const std::string& indent) {
  for (const auto& [name, value] : json.items()) {
    if (value.is_object()) {
      std::printf("%s%s\n", indent.c_str(), name.c_str());
      print_info(value, indent + "  ");
      continue;
    }
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    std::printf("%s%-20s %s\n", indent.c_str(), name.c_str(), printable(text).c_str());
  }
}

/// The name of each format once, in the order of `formats`.
std::string names_of(std::span<const Format> formats) {
  std::set<Format> named;
  std::string names;
  for (const Format format : formats) {
    if (!named.insert(format).second) continue;
    if (!names.empty()) names += ", ";
    names += formats::to_string(format);
  }
  return names;
}

Json place_json(const pipeline::NotedSolid& solid) {
  Json json{{"feature", solid.feature}, {"object", solid.object_id}};
  if (!solid.lod.empty()) json["lod"] = solid.lod;
  json["geometry"] = solid.geometry;
  json["solid"] = solid.ordinal;
  return json;
}

/// What of a file is not proven: numbers, and each solid with its place and the codes of its
/// errors.
Json unproven_json(const pipeline::ContainerInfo& info) {
  Json list = Json::array();
  for (const pipeline::NotedSolid& solid : info.unproven) {
    Json json = place_json(solid);
    const Json report = Json::parse(solid.note, nullptr, false);
    const bool has_codes = report.is_object() && report.contains("all_errors");
    json["errors"] = has_codes ? report["all_errors"] : Json::array();
    list.push_back(std::move(json));
  }
  return {{"features", info.unproven_features},
          {"count", info.unproven.size()},
          {"solids", std::move(list)}};
}

/// The solids of a file that were repaired: their number, and each with its place and repair.
Json repaired_json(const pipeline::ContainerInfo& info) {
  Json list = Json::array();
  for (const pipeline::NotedSolid& solid : info.repaired) {
    Json json = place_json(solid);
    json["repair"] = Json::parse(solid.note, nullptr, false);
    list.push_back(std::move(json));
  }
  return {{"count", info.repaired.size()}, {"solids", std::move(list)}};
}

/// The place of a solid as the start of a line.
std::string place_text(const Json& solid) {
  const char* const name = solid["object"] == "" ? "feature" : "object";
  std::string text = "  " + printable(solid[name].get<std::string>());
  if (solid.contains("lod")) text += " LoD " + printable(solid["lod"].get<std::string>());
  return text + " geometry " + solid["geometry"].dump() + " solid " + solid["solid"].dump() + ":";
}

/// Prints a line for each solid that was repaired, with what was done.
void print_repaired(const Json& repaired) {
  std::printf("%-20s %s\n", "repaired solids", repaired["count"].dump().c_str());
  for (const Json& solid : repaired["solids"]) {
    std::string line = place_text(solid);
    const Json& repair = solid["repair"];
    if (repair.is_object()) {
      for (const Json& remedy : repair.value("remedies", Json::array())) {
        line += ' ' + (remedy.is_string() ? printable(remedy.get<std::string>()) : remedy.dump());
      }
      line += ", " + repair.value("area_added", Json(0)).dump() + " m2 added, moved " +
              repair.value("largest_move", Json(0)).dump() + " m at most";
    }
    std::puts(line.c_str());
  }
}

/// Prints a line for each solid that is not proven, with the codes of its errors.
void print_unproven(const Json& unproven) {
  std::printf("%-20s %s\n", "unproven solids", unproven["count"].dump().c_str());
  for (const Json& solid : unproven["solids"]) {
    std::string line = place_text(solid);
    for (const Json& code : solid["errors"]) line += ' ' + code.dump();
    if (solid["errors"].empty()) line += " undecided";
    std::puts(line.c_str());
  }
}

/// The blocks of a file, each with its place, its features and its box.
Json blocks_json(const pipeline::ContainerInfo& info) {
  Json blocks = Json::array();
  for (const pipeline::BlockEntry& block : info.blocks) {
    Json json{{"offset", block.extent.offset},
              {"bytes", block.extent.size},
              {"features", block.features}};
    if (block.box) {
      json["box"] = {block.box->min[0], block.box->min[1], block.box->max[0], block.box->max[1]};
    }
    blocks.push_back(std::move(json));
  }
  return blocks;
}

Result<Json> info_of_container(pipeline::ContainerFile& file, bool lists_blocks) {
  const auto info = pipeline::describe_container(file);
  if (!info) return info.error();
  Json json{{"file", "Watertight file"}, {"bytes", file.size()}};
  if (file.torn()) json["tornBytes"] = file.size() - file.committed();
  json["documents"] = info->formats.size();
  json["format"] = names_of(info->formats);
  json["features"] = info->features;
  if (info->deleted > 0) json["deletedFeatures"] = info->deleted;
  json["solids"] = info->solids;
  for (const auto& [type, count] : info->other_geometries) json["otherGeometries"][type] = count;
  json["unproven"] = unproven_json(*info);
  if (!info->repaired.empty()) json["repaired"] = repaired_json(*info);
  json["blocks"] = info->blocks.size();
  json["index"] = file.has_index();
  json["pages"] = info->pages;
  json["solidBytes"] = info->solid_bytes;
  json["documentBytes"] = file.size() - info->solid_bytes;
  // Sums of hundredths are rounded again, because binary numbers do not hold hundredths exactly.
  for (const auto& [name, size] : info->parts) json["parts"][name] = std::round(size * 100) / 100;
  if (lists_blocks) json["blockList"] = blocks_json(*info);
  return json;
}

Result<Json> info_of(Encoded& encoded, bool lists_blocks) {
  if (encoded.container) return info_of_container(*encoded.container, lists_blocks);
  const Bytes& bytes = encoded.whole.bytes;
  if (files::kind_of_input(bytes) == files::InputKind::page_file) return files::page_file_error();
  const auto info = codec::describe(bytes);
  if (!info) return info.error();
  return json_of(*info);
}

void print_blocks(const Json& blocks) {
  std::printf("%6s %12s %10s %9s  %s\n", "block", "offset", "bytes", "features", "box");
  std::size_t number = 0;
  for (const Json& block : blocks) {
    std::printf("%6zu %12s %10s %9s  %s\n", number++, block["offset"].dump().c_str(),
                block["bytes"].dump().c_str(), block["features"].dump().c_str(),
                block.contains("box") ? block["box"].dump().c_str() : "");
  }
}

/// The bytes of all solids in one mode.
struct ModeTotal {
  std::uint64_t solids = 0;  // the number of solids that the mode can hold
  std::uint64_t bytes = 0;
  std::map<std::string, double> parts;
};

Status explain_features(const std::vector<pipeline::EncodedFeature>& features, std::FILE* out) {
  std::map<Mode, ModeTotal> totals;
  for (const pipeline::EncodedFeature& feature : features) {
    for (const StoredSolid& solid : feature.solids) {
      if (!solid.is_proven) continue;
      const auto sizes = codec::explain(solid.blob);
      if (!sizes) return sizes.error();
      for (const codec::ModeSize& size : *sizes) {
        ModeTotal& total = totals[size.mode];
        if (size.bytes == 0) continue;
        ++total.solids;
        total.bytes += size.bytes;
        for (const codec::BlobInfo::Part& part : size.parts) total.parts[part.name] += part.bytes;
      }
    }
  }
  std::fprintf(out, "%-14s %8s %10s  %s\n", "mode", "solids", "bytes", "bytes of parts");
  for (const auto& [mode, total] : totals) {
    std::fprintf(out, "%-14s %8llu %10llu ", std::string(codec::to_string(mode)).c_str(),
                 static_cast<unsigned long long>(total.solids),
                 static_cast<unsigned long long>(total.bytes));
    for (const auto& [part, bytes] : total.parts)
      std::fprintf(out, " %s %.1f", part.c_str(), bytes);
    std::fprintf(out, "\n");
  }
  return Done{};
}

/// Says what of a document is not proven, and what became of it.
void tell_unproven(const EncodeCommand& command, const pipeline::EncodeOutcome& encoded) {
  const std::string name = printable(command.input);
  if (command.invalid == "keep") {
    const std::uint64_t solids = encoded.outcome.unproven;
    if (solids == 0) {
      std::fprintf(
          stderr,
          "watertight: %s: all solids are proven, but there are defects between solids or "
          "parts that cannot be read: kept as they came; `watertight validate` lists them\n",
          name.c_str());
      return;
    }
    std::fprintf(stderr,
                 "watertight: %s: %s kept as %s came, unproven; `watertight validate` says why, "
                 "`watertight info` lists them\n",
                 name.c_str(), quantity(solids, "solid is", "solids are").c_str(),
                 solids == 1 ? "it" : "they");
    return;
  }
  std::uint64_t geometries = 0;
  std::uint64_t features = 0;
  for (const pipeline::FeatureOutcome& feature : encoded.outcome.features) {
    if (feature.verdict == Verdict::valid) continue;
    if (!feature.is_stored) ++features;
    if (feature.is_stored) geometries += feature.left_out.size();
  }
  std::fprintf(stderr, "watertight: %s: left out: %s of features that are kept, and %s\n",
               name.c_str(), quantity(geometries, "geometry", "geometries").c_str(),
               quantity(features, "whole feature").c_str());
}

/// Writes what was left out as a document, and the findings beside it. `header` is that of the
/// document. Errors: those of write_file().
Status write_rejected(const EncodeCommand& command, const std::string& header,
                      const pipeline::IngestOutcome& outcome) {
  std::string text;
  for (const pipeline::FeatureOutcome& feature : outcome.features) {
    if (feature.rejected.empty()) continue;
    if (text.empty() && !feature.id.empty()) text = header + '\n';
    text += feature.rejected + '\n';
  }
  if (text.empty()) {
    return Error{ErrorCode::unsupported,
                 "what is left out is written for city models (CityJSON, CityJSONSeq) only"};
  }
  const Status written = files::write_file(command.rejected, as_bytes(text));
  if (!written) return written;
  const std::string report = pipeline::outcome_json(outcome) + '\n';
  return files::write_file(command.rejected + ".report.json", as_bytes(report));
}

std::string rejected_report(const EncodeCommand& command) {
  return command.rejected + ".report.json";
}

/// Ok if the files of --rejected are wanted and replace no other file of the run. Errors:
/// invalid_argument.
Status check_rejected(const EncodeCommand& command, const std::string& input) {
  if (command.rejected.empty()) return Done{};
  const auto wrong = [](std::string text) {
    return Error{ErrorCode::invalid_argument, std::move(text)};
  };
  if (command.invalid != "skip") return wrong("needs --invalid skip");
  if (command.rejected == "-") return wrong("needs the name of a file");
  for (const std::string& file : {command.rejected, rejected_report(command)}) {
    if (replaces(file, input)) return wrong("'" + file + "' would replace the input");
    if (file == command.output || files::is_same_file(file, command.output)) {
      return wrong("'" + file + "' is the output");
    }
  }
  return Done{};
}

}  // namespace

EncodedInput encode_one(const EncodeCommand& command, const files::InputFile& source,
                        const std::string& position) {
  const auto contract = formats::contract_named(command.contract);
  if (!contract) return {fail("--contract", contract.error()), {}};
  formats::ReadOptions reading;
  // A CityJSON whose features are to be found has no text of its own.
  reading.split_features = command.purpose == "ranges";
  reading.keep_text = *contract == formats::Contract::exact;
  reading.surfaces = surface_rule(command.surfaces).reading;
  reading.curved = pipeline::curved_reading(command.chord);
  auto input = load(source, reading);
  if (!input) return {fail(command.input, input.error()), {}};
  delaunay::EngineWorkers workers(delaunay::EngineWorkers::Options{{}, {}, command.jobs});
  pipeline::IngestOptions options;
  options.threads = command.jobs;
  options.contract = *contract;
  options.policy = *pipeline::policy_named(command.invalid);
  apply(command.rules, options.certify, options.groups);
  options.surfaces = surface_rule(command.surfaces).reading;
  options.encode.mode = command.keeps_steiner ? Mode::bitmap : mode_named(command.mode);
  options.steiner = command.keeps_steiner ? pipeline::SteinerVertices::keep
                                          : pipeline::SteinerVertices::leave_out;
  options.certify.ladder.keeps_facets = command.keeps_steiner;
  auto encoded = [&] {
    ProgressBar bar(command.input, position);
    options.progress = [&bar](std::size_t done, std::size_t total) {
      bar.show(done, static_cast<double>(done) / static_cast<double>(total));
    };
    return pipeline::encode_document(std::move(input->document), &workers, options);
  }();
  if (!encoded) return {fail(command.input, encoded.error()), {}};
  const Exit exit = exit_of(encoded->outcome.verdict);
  if (exit != Exit::valid) {
    for (const pipeline::FeatureOutcome& feature : encoded->outcome.features) {
      print_findings(command.input, feature, command.output == "-" ? stderr : stdout);
    }
    if (options.policy == store::Policy::refuse) {
      std::fprintf(stderr, "watertight: %s: not all solids are valid; nothing was written\n",
                   printable(command.input).c_str());
      return {exit, {}};
    }
    tell_unproven(command, *encoded);
    if (!command.rejected.empty()) {
      const Status written =
          write_rejected(command, encoded->document.header.str(), encoded->outcome);
      if (!written) return {fail_to_write(command.rejected, written.error()), {}};
    }
  }
  tell_rounded(command.input, encoded->outcome);
  return {exit, std::move(encoded->document)};
}

Exit encode_input(const EncodeCommand& command, const files::InputFile& source,
                  const std::string& position) {
  if (replaces(command.output, source.file)) return refuse_to_replace(source.file, command.output);
  if (Status possible = check_rejected(command, source.file); !possible) {
    return fail("--rejected", possible.error());
  }
  const EncodedInput encoded = encode_one(command, source, position);
  if (!encoded.document) return encoded.exit;
  const auto packed = pack(command, *encoded.document);
  if (!packed) return fail(command.input, packed.error());
  const Status status = files::write_file(command.output, *packed);
  if (!status) return fail_to_write(command.output, status.error());
  if (!command.explains) return encoded.exit;
  const Status explained =
      explain_features(encoded.document->features, command.output == "-" ? stderr : stdout);
  return explained ? encoded.exit : fail(command.input, explained.error());
}

Exit run(const DecodeCommand& command) {
  Encoded encoded;
  if (Status opened = open_encoded(command.input, encoded); !opened) {
    return fail(command.input, opened.error());
  }
  const auto documents = load_encoded(encoded, command.jobs);
  if (!documents) return fail(command.input, documents.error());
  if (documents->empty()) return fail(command.input, {ErrorCode::malformed, "no document in it"});
  if (documents->size() > 1 && command.output == "-") {
    return fail(command.input, {ErrorCode::unsupported, "several documents need names: -o FILE"});
  }
  const Exit saved = save_documents(*documents, command.input, command.output);
  const bool is_torn = encoded.container && encoded.container->torn();
  return is_torn ? worse(saved, Exit::invalid) : saved;
}

/// Whether a GML document is to become a city model, which keeps more of it than its solids.
bool makes_city_of_gml(const ConvertCommand& command, const files::WholeInput& input) {
  if (command.output == "-" || files::kind_of_input(input.bytes) != files::InputKind::document)
    return false;
  const auto from = formats::detect_format(input.name, input.bytes);
  const auto to = files::format_of_name(command.output);
  return from && *from == Format::gml && to &&
         (*to == Format::city_json || *to == Format::city_json_seq || *to == Format::gml);
}

void tell_notes(const std::string& file, const Document& document) {
  for (const std::string& note : document.notes) {
    std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(), printable(note).c_str());
  }
}

/// Makes geometries of type Solid of the surfaces that were read as solids.
Status make_solids(const std::string& file, Document& document) {
  const auto turned = formats::turn_surfaces_into_solids(document);
  if (!turned) return turned.error();
  std::fprintf(
      stderr, "watertight: %s: %s\n", printable(file).c_str(),
      quantity(*turned, "closed surface is a solid", "closed surfaces are solids").c_str());
  return Done{};
}

Exit save_converted(const ConvertCommand& command, Document document) {
  if (command.surfaces == "as-solids") {
    const Status made = make_solids(command.input, document);
    if (!made) return fail(command.input, made.error());
  }
  return save_documents({&document, 1}, command.input, command.output);
}

Exit run(const ConvertCommand& command) {
  if (replaces(command.output, command.input))
    return refuse_to_replace(command.input, command.output);
  formats::ReadOptions options;
  options.split_features = false;
  const auto whole = read_argument(command.input);
  if (!whole) return fail(command.input, whole.error());
  if (makes_city_of_gml(command, *whole)) {
    options.surfaces = surface_rule(command.surfaces).reading;
    options.curved = pipeline::curved_reading(command.chord);
    auto city = pipeline::read_to_convert(whole->bytes, Format::gml, Format::city_json, options);
    if (!city) return fail(command.input, city.error());
    tell_notes(command.input, *city);
    return save_converted(command, *std::move(city));
  }
  options.surfaces = surface_rule(command.surfaces).reading;
  options.curved = pipeline::curved_reading(command.chord);
  auto input = files::load_input(whole->name, whole->bytes, options);
  if (!input) return fail(command.input, input.error());
  return save_converted(command, std::move(input->document));
}

Exit run(const InfoCommand& command) {
  Encoded encoded;
  if (Status opened = open_encoded(command.input, encoded); !opened) {
    return fail(command.input, opened.error());
  }
  auto json = info_of(encoded, command.lists_blocks);
  if (!json) return fail(command.input, json.error());
  if (command.is_json) {
    std::printf("%s\n", json->dump().c_str());
    return Exit::valid;
  }
  Json unproven = std::move((*json)["unproven"]);
  Json repaired = json->contains("repaired") ? std::move((*json)["repaired"]) : Json();
  Json blocks = json->contains("blockList") ? std::move((*json)["blockList"]) : Json::array();
  json->erase("unproven");
  json->erase("repaired");
  json->erase("blockList");
  print_info(*json, "");
  if (!unproven.is_null()) print_unproven(unproven);
  if (!repaired.is_null()) print_repaired(repaired);
  if (!blocks.empty()) print_blocks(blocks);
  return Exit::valid;
}

}  // namespace watertight::cli
