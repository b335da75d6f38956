// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command repair: documents whose invalid solids are made valid where a remedy does it.
#include <array>
#include <cstdio>
#include <map>
#include <set>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/outputs/documents.h"
#include "cli/sources/input_list.h"
#include "cli/terminal/printable.h"
#include "files/files.h"
#include "files/inputs.h"
#include "files/names.h"
#include "pipeline/repaired/repair_stream.h"
#include "validate/finding_kinds.h"

namespace watertight::cli {
namespace {

using pipeline::DocumentRepair;
using pipeline::SolidRepair;
using repair::Remedy;

std::string fixed_text(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

/// The facets that came, went and were turned, and the vertices that moved: "1 facet of 80.000 m2
/// added, 2 removed". Empty without any.
std::string changes_of(const SolidRepair& repair) {
  const repair::RepairSummary& changes = repair.summary;
  std::vector<std::string> parts;
  if (changes.facets_added > 0) {
    std::string text = quantity(changes.facets_added, "facet");
    if (changes.area_added > 0) text += " of " + fixed_text(changes.area_added, 3) + " m2";
    parts.push_back(text + " added");
  }
  if (changes.facets_removed > 0) {
    parts.push_back(quantity(changes.facets_removed, "facet") + " removed");
  }
  if (changes.facets_turned > 0) {
    parts.push_back(quantity(changes.facets_turned, "facet") + " turned");
  }
  if (changes.moves.vertices > 0) {
    parts.push_back(quantity(changes.moves.vertices, "vertex", "vertices") + " moved by at most " +
                    fixed_text(changes.moves.largest_metres, 4) + " m");
  }
  std::string text;
  for (const std::string& part : parts) text.append(text.empty() ? "" : ", ").append(part);
  return text;
}

/// What was done to a solid, or what is wrong with it.
std::string account_of(const SolidRepair& repair) {
  std::string text;
  const auto add = [&](const std::string& part, const char* between) {
    text.append(text.empty() ? "" : between).append(part);
  };
  if (!repair.is_repaired()) {
    for (const int code : repair.summary.codes_before) {
      add(std::to_string(code) + ' ' + std::string(validate::finding_name(code)), ", ");
    }
    return (repair.summary.is_undecided ? "undecided" : "not repaired: ") + text;
  }
  for (const Remedy remedy : repair.summary.remedies) add(std::string(to_string(remedy)), ", ");
  text = "repaired: " + text;
  const std::string changes = changes_of(repair);
  return changes.empty() ? text : text + " (" + changes + ')';
}

void print(const SolidRepair& repair) {
  const std::string& object =
      repair.source.object_id.empty() ? repair.feature : repair.source.object_id;
  std::string place = printable(object);
  if (!repair.source.lod.empty()) place += " LoD " + printable(repair.source.lod);
  std::printf("%s: %s\n", place.c_str(), account_of(repair).c_str());
}

void print_row(const char* name, std::uint64_t count, int indent = 0) {
  std::printf("%*s%-*s %9llu\n", indent, "", 44 - indent, name,
              static_cast<unsigned long long>(count));
}

void print_table(const DocumentRepair& outcome) {
  std::map<Remedy, std::uint64_t> by_remedy;
  std::map<int, std::uint64_t> by_code;
  std::uint64_t repaired = 0;
  std::uint64_t undecided = 0;
  std::uint64_t added = 0;
  std::uint64_t removed = 0;
  std::uint64_t moved = 0;
  for (const SolidRepair& repair : outcome.repairs) {
    added += repair.summary.facets_added;
    removed += repair.summary.facets_removed;
    moved += repair.summary.moves.vertices;
    repaired += repair.is_repaired() ? 1 : 0;
    undecided += !repair.is_repaired() && repair.summary.is_undecided ? 1 : 0;
    for (const Remedy remedy : repair.summary.remedies) ++by_remedy[remedy];
    if (repair.is_repaired()) continue;
    for (const int code : repair.summary.codes_before) ++by_code[code];
  }
  print_row("features", outcome.features);
  print_row("solids", outcome.solids);
  print_row("valid as read", outcome.valid_as_read, 2);
  print_row("repaired", repaired, 2);
  for (const auto& [remedy, count] : by_remedy) {
    print_row(std::string(to_string(remedy)).c_str(), count, 4);
  }
  print_row("left as they were", outcome.repairs.size() - repaired - undecided, 2);
  for (const auto& [code, count] : by_code) {
    const std::string name = std::to_string(code) + ' ' + std::string(validate::finding_name(code));
    print_row(name.c_str(), count, 4);
  }
  print_row("undecided", undecided, 2);
  print_row("facets added", added);
  print_row("facets removed", removed);
  print_row("vertices moved", moved);
}

Exit exit_of_repair(const DocumentRepair& outcome) {
  Exit exit = Exit::valid;
  for (const SolidRepair& repair : outcome.repairs) {
    if (repair.is_repaired()) continue;
    exit = worse(exit, repair.summary.is_undecided ? Exit::undecided : Exit::invalid);
  }
  return exit;
}

/// The document of an argument. A GML document becomes a city model.
Result<Document> read_to_repair(const RepairCommand& command) {
  const auto argument = single_input(command.input);
  if (!argument) return argument.error();
  const auto whole = files::read_whole(*argument, {});
  if (!whole) return whole.error();
  formats::ReadOptions options;
  options.split_features = false;
  options.keep_text = true;
  options.surfaces = surface_rule(command.surfaces).reading;
  const auto from = formats::detect_format(whole->name, whole->bytes);
  const auto to = files::format_of_name(command.output);
  const bool is_city = to && (*to == Format::city_json || *to == Format::city_json_seq);
  if (from && *from == Format::gml && is_city) {
    return pipeline::read_to_convert(whole->bytes, Format::gml, *to, options);
  }
  options.keep_text = from && (*from == Format::city_json || *from == Format::city_json_seq);
  auto input = files::load_input(whole->name, whole->bytes, options);
  if (!input) return std::move(input).error();
  return std::move(input->document);
}

void print_notes(const RepairCommand& command, const Document& document) {
  for (const std::string& note : document.notes) {
    std::fprintf(stderr, "watertight: %s: %s\n", printable(command.input).c_str(),
                 printable(note).c_str());
  }
}

repair::RepairOptions options_of(const RepairCommand& command) {
  repair::RepairOptions options;
  options.remedies = *repair::remedies_of(command.remedies);
  options.most_islands = command.most_islands;
  options.weld_metres = command.weld_metres;
  validate::GroupOptions groups;  // solids are repaired one by one
  apply(command.rules, options.certify, groups);
  return options;
}

/// Whether the input, by its name, is a sequence that is written as one: it is read line by line.
bool is_stream(const RepairCommand& command) {
  const auto from = files::format_of_name(files::name_without_compression(command.input));
  const auto to = files::format_of_name(command.output);
  const bool is_sequence = from && *from == Format::city_json_seq;
  const bool stays = command.output == "-" || (to && *to == Format::city_json_seq);
  return is_sequence && stays && command.surfaces != "as-solids";
}

/// Repairs a file line by line. Nothing: the file is no sequence. `at` becomes the file that an
/// error is about.
Result<std::optional<DocumentRepair>> repaired_lines(const RepairCommand& command,
                                                     delaunay::EngineWorkers& workers,
                                                     std::string& at) {
  const auto argument = single_input(command.input);
  if (!argument) return argument.error();
  formats::ReadOptions reading;
  reading.keep_text = true;
  reading.surfaces = surface_rule(command.surfaces).reading;
  auto input = files::open_input(*argument, reading);
  if (!input) return std::move(input).error();
  if (input->reader.feature_count()) return std::optional<DocumentRepair>();
  print_notes(command, input->reader.document());
  auto writer = files::FileWriter::open(command.output);
  if (!writer) {
    at = command.output;
    return std::move(writer).error();
  }
  const auto write = [&](std::string_view text) {
    Status written = writer->write(text);
    if (!written) at = command.output;
    return written;
  };
  auto outcome =
      pipeline::repair_stream(input->reader, &workers, options_of(command), command.jobs, write);
  if (!outcome) return std::move(outcome).error();
  at = command.output;
  if (const Status saved = writer->commit(); !saved) return saved.error();
  return std::optional(*std::move(outcome));
}

/// Repairs a document that is read whole.
Result<DocumentRepair> repaired_whole(const RepairCommand& command,
                                      delaunay::EngineWorkers& workers, Exit& saved) {
  auto document = read_to_repair(command);
  if (!document) return std::move(document).error();
  print_notes(command, *document);
  auto outcome = pipeline::repair_document(*document, &workers, options_of(command),
                                           static_cast<unsigned>(command.jobs));
  if (!outcome) return outcome;
  if (command.surfaces == "as-solids") {
    const auto turned = formats::turn_surfaces_into_solids(*document);
    if (!turned) return turned.error();
  }
  saved = save_documents({&*document, 1}, command.input, command.output);
  return outcome;
}

}  // namespace

Exit run(const RepairCommand& command) {
  if (command.output != "-" && files::is_same_file(command.output, command.input)) {
    return fail(command.input, {ErrorCode::invalid_argument,
                                "the output '" + command.output + "' would replace the input"});
  }
  delaunay::EngineWorkers workers(delaunay::EngineWorkers::Options{{}, {}, command.jobs});
  std::optional<DocumentRepair> outcome;
  if (is_stream(command)) {
    std::string at = command.input;
    auto lines = repaired_lines(command, workers, at);
    if (!lines) return fail(at, lines.error());
    outcome = *std::move(lines);
  }
  if (!outcome) {
    Exit saved = Exit::valid;
    auto whole = repaired_whole(command, workers, saved);
    if (!whole) return fail(command.input, whole.error());
    if (saved != Exit::valid) return saved;
    outcome = *std::move(whole);
  }
  if (!command.report.empty()) {
    const std::string report = pipeline::repair_report_json(*outcome) + '\n';
    const Status written = files::write_file(command.report, as_bytes(report));
    if (!written) return fail(command.report, written.error());
  }
  if (command.output == "-") return exit_of_repair(*outcome);
  if (!command.is_quiet) {
    for (const SolidRepair& repair : outcome->repairs) print(repair);
  }
  print_table(*outcome);
  return exit_of_repair(*outcome);
}

}  // namespace watertight::cli
