// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command repair: documents whose invalid solids are made valid where a remedy does it.
#include <array>
#include <chrono>
#include <cstdio>
#include <map>
#include <set>

#include "cli/commands.h"
#include "cli/outputs/documents.h"
#include "cli/outputs/report_files.h"
#include "cli/sources/input_list.h"
#include "cli/terminal/printable.h"
#include "files/files.h"
#include "files/inputs.h"
#include "files/names.h"
#include "pipeline/repaired/repair_notes.h"
#include "pipeline/repaired/repair_stream.h"
#include "pipeline/repaired/validate_repaired.h"
#include "validate/finding_kinds.h"

namespace watertight::cli {
namespace {

using pipeline::DocumentRepair;
using pipeline::SolidRepair;
using repair::Remedy;

void print(const SolidRepair& repair) {
  const std::string& object =
      repair.source.object_id.empty() ? repair.feature : repair.source.object_id;
  std::string place =
      object.empty() ? "solid " + std::to_string(repair.source.ordinal) : printable(object);
  if (!repair.source.lod.empty()) place += " LoD " + printable(repair.source.lod);
  std::printf("%s: %s\n", place.c_str(), pipeline::account_of(repair.summary).c_str());
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
    if (repair.is_repaired() || repair.summary.is_undecided) continue;
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

repair::RepairOptions options_of(const RepairCommand& command) {
  repair::RepairOptions options;
  options.remedies = *repair::remedies_of(command.remedies);
  options.most_islands = command.most_islands;
  options.weld_metres = command.weld_metres;
  options.smooth = command.smooth;
  options.smooth.keeps_surface = !command.spline.empty();
  validate::GroupOptions groups;  // solids are repaired one by one
  apply(command.rules, options.certify, groups);
  return options;
}

/// A run of `watertight repair`.
class RepairRun {
 public:
  explicit RepairRun(const RepairCommand& command)
      : command_(command),
        options_(options_of(command)),
        workers_(delaunay::EngineWorkers::Options{{}, {}, command.jobs}) {
    validation_.threads = command.jobs;
    apply(command.rules, validation_.certify, validation_.groups);
  }

  Exit run();

 private:
  Status open_reports();
  report::ReportHead head() const;
  Result<std::optional<DocumentRepair>> repair_lines();
  Result<std::optional<DocumentRepair>> repair_whole();
  Result<pipeline::RepairedText> repair_document();
  Status report_on(const Document& document, const DocumentRepair& outcome);
  Status begin_reports(std::optional<Format> format);
  Status end_reports(const std::vector<std::string>& notes);
  Status save_splines(const DocumentRepair& outcome);
  void print_notes(const Document& document) const;
  void print_outcome(const DocumentRepair& outcome) const;
  /// The error, which is about another file than the input.
  Error about(const std::string& file, Error error) {
    at_ = file;
    return error;
  }

  const RepairCommand& command_;
  const repair::RepairOptions options_;
  pipeline::StreamOptions validation_;  // of the repaired document, for reports
  delaunay::EngineWorkers workers_;
  ReportFiles reports_;
  std::string at_ = command_.input;  // the file that an error is about
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

report::ReportHead RepairRun::head() const {
  report::ReportHead head;
  head.program_version = command_.program_version;
  if (!command_.leaves_times_out) head.time = time_now();
  const CertifyOptions& certify = validation_.certify;
  head.acceptance = {certify.tolerances, certify.proof, geometry::kRuleSet};
  head.is_strict = certify.ladder.strict;
  head.overlap_metres = validation_.groups.overlap_metres;
  head.surfaces = command_.surfaces;
  head.repair = options_;
  return head;
}

Status RepairRun::open_reports() {
  const std::array<std::pair<const std::string*, ReportForm>, 2> outputs{
      {{&command_.report, ReportForm::json}, {&command_.html, ReportForm::html}}};
  for (const auto& [path, form] : outputs) {
    if (path->empty()) continue;
    const bool is_taken = files::is_same_file(*path, command_.output) ||
                          (*path != "-" && files::is_same_file(*path, command_.input));
    Status opened = is_taken ? Error{ErrorCode::invalid_argument,
                                     "a report would replace the input or the output"}
                             : reports_.open(*path, form, head());
    if (!opened) return about(output_name(*path), std::move(opened).error());
  }
  return Done{};
}

Status RepairRun::begin_reports(std::optional<Format> format) {
  return reports_.tell([&](report::FeatureReport& report) {
    return report.begin_document({output_name(command_.output), format});
  });
}

Status RepairRun::end_reports(const std::vector<std::string>& notes) {
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start_;
  return reports_.tell([&](report::FeatureReport& report) {
    return report.end_document({notes, time.count()});
  });
}

void RepairRun::print_notes(const Document& document) const {
  for (const std::string& note : document.notes) {
    std::fprintf(stderr, "watertight: %s: %s\n", printable(command_.input).c_str(),
                 printable(note).c_str());
  }
}

/// Whether the input, by its name, is a sequence that is written as one: it is read line by line.
bool is_stream(const RepairCommand& command) {
  const auto from = files::format_of_name(files::name_without_compression(command.input));
  const auto to = files::format_of_name(command.output);
  const bool is_sequence = from && *from == Format::city_json_seq;
  const bool stays = command.output == "-" || (to && *to == Format::city_json_seq);
  return is_sequence && stays && command.surfaces != "as-solids";
}

/// Repairs a file line by line. Nothing: the file is no sequence.
Result<std::optional<DocumentRepair>> RepairRun::repair_lines() {
  const auto argument = single_input(command_.input);
  if (!argument) return argument.error();
  formats::ReadOptions reading;
  reading.keep_text = true;
  reading.surfaces = surface_rule(command_.surfaces).reading;
  reading.curved = pipeline::curved_reading(command_.chord);
  auto input = files::open_input(*argument, reading);
  if (!input) return std::move(input).error();
  formats::FeatureReader& reader = input->reader;
  if (reader.feature_count()) return std::optional<DocumentRepair>();
  print_notes(reader.document());
  auto writer = files::FileWriter::open(command_.output);
  if (!writer) return about(command_.output, std::move(writer).error());
  const auto write = [&](std::string_view text) -> Status {
    Status written = writer->write(text);
    return written ? std::move(written) : about(command_.output, std::move(written).error());
  };
  if (Status begun = begin_reports(reader.document().format); !begun) return begun.error();
  auto outcome = reports_.is_empty()
                     ? pipeline::repair_stream(reader, &workers_, options_, command_.jobs, write)
                     : pipeline::repair_and_validate(
                           reader, &workers_, options_, validation_, write,
                           [&](pipeline::ValidatedFeature&& feature) {
                             return reports_.tell([&](report::FeatureReport& report) {
                               return report.add(feature);
                             });
                           });
  if (!outcome) return std::move(outcome).error();
  if (Status ended = end_reports(reader.document().notes); !ended) return ended.error();
  Status saved = writer->commit();
  if (!saved) return about(command_.output, std::move(saved).error());
  return std::optional(*std::move(outcome));
}

/// Reads and repairs the document.
Result<pipeline::RepairedText> RepairRun::repair_document() {
  const auto argument = single_input(command_.input);
  if (!argument) return argument.error();
  const auto whole = files::read_whole(*argument, {});
  if (!whole) return whole.error();
  formats::ReadOptions reading;
  reading.split_features = false;
  reading.surfaces = surface_rule(command_.surfaces).reading;
  reading.curved = pipeline::curved_reading(command_.chord);
  const auto threads = static_cast<unsigned>(command_.jobs);
  if (const auto from = formats::detect_format(whole->name, whole->bytes)) {
    const auto named = files::format_of_name(command_.output);
    const Format to = named && command_.output != "-" ? *named : *from;
    return pipeline::repair_text(whole->bytes, *from, to, reading, &workers_, options_, threads);
  }
  auto input = files::load_input(whole->name, whole->bytes, reading);
  if (!input) return std::move(input).error();
  pipeline::RepairedText repaired{std::move(input->document), {}};
  auto outcome = pipeline::repair_document(repaired.document, &workers_, options_, threads);
  if (!outcome) return std::move(outcome).error();
  repaired.outcome = *std::move(outcome);
  return repaired;
}

/// Validates the document as it is written, for the reports.
Status RepairRun::report_on(const Document& document, const DocumentRepair& outcome) {
  if (reports_.is_empty()) return Done{};
  const auto format = command_.output == "-" ? Result<Format>(document.format)
                                             : files::format_of_name(command_.output);
  if (!format) return format.error();
  if (Status begun = begin_reports(*format); !begun) return begun;
  formats::ReadOptions reading;
  reading.surfaces = surface_rule(command_.surfaces).reading;
  reading.curved = pipeline::curved_reading(command_.chord);
  const Status validated = pipeline::validate_repaired(
      document, *format, reading, outcome, &workers_, validation_,
      [&](pipeline::ValidatedFeature&& feature) {
        return reports_.tell([&](report::FeatureReport& report) { return report.add(feature); });
      });
  return validated ? end_reports(document.notes) : validated;
}

/// Repairs a document that is read whole. Nothing: it could not be saved, and the user knows.
Result<std::optional<DocumentRepair>> RepairRun::repair_whole() {
  auto repaired = repair_document();
  if (!repaired) return std::move(repaired).error();
  auto& [document, outcome] = *repaired;
  print_notes(document);
  if (command_.surfaces == "as-solids") {
    const auto turned = formats::turn_surfaces_into_solids(document);
    if (!turned) return turned.error();
  }
  const Exit saved = save_documents({&document, 1}, command_.input, command_.output);
  if (saved != Exit::valid) return std::optional<DocumentRepair>();
  if (Status reported = report_on(document, outcome); !reported) return reported.error();
  return std::optional(std::move(outcome));
}

/// Writes the surfaces of smooth patches, if they are asked for.
Status RepairRun::save_splines(const DocumentRepair& outcome) {
  if (command_.spline.empty()) return Done{};
  auto writer = files::FileWriter::open(command_.spline);
  if (!writer) return std::move(writer).error();
  for (const SolidRepair& repair : outcome.repairs) {
    for (const repair::HoleFill& hole : repair.summary.holes) {
      if (hole.spline.empty()) continue;
      if (Status written = writer->write(hole.spline + '\n'); !written) return written;
    }
  }
  return writer->commit();
}

void RepairRun::print_outcome(const DocumentRepair& outcome) const {
  const bool is_output_taken =
      command_.output == "-" || command_.report == "-" || command_.html == "-";
  if (is_output_taken) return;
  if (!command_.is_quiet) {
    for (const SolidRepair& repair : outcome.repairs) print(repair);
  }
  print_table(outcome);
}

Exit RepairRun::run() {
  if (const Status opened = open_reports(); !opened) return fail(at_, opened.error());
  std::optional<DocumentRepair> outcome;
  if (is_stream(command_)) {
    auto lines = repair_lines();
    if (!lines) return fail(at_, lines.error());
    outcome = *std::move(lines);
  }
  if (!outcome) {
    auto whole = repair_whole();
    if (!whole) return fail(at_, whole.error());
    if (!*whole) return Exit::error;
    outcome = *std::move(whole);
  }
  if (const Status saved = save_splines(*outcome); !saved)
    return fail(command_.spline, saved.error());
  Exit exit = exit_of_repair(*outcome);
  reports_.finish([&](const std::string& file, const Error& error) { exit = fail(file, error); });
  print_outcome(*outcome);
  return exit;
}

}  // namespace

Exit run(const RepairCommand& command) {
  if (command.output != "-" && files::is_same_file(command.output, command.input)) {
    return fail(command.input, {ErrorCode::invalid_argument,
                                "the output '" + command.output + "' would replace the input"});
  }
  return RepairRun(command).run();
}

}  // namespace watertight::cli
