// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <cstdio>

#include "cli/commands.h"
#include "cli/files.h"
#include "cli/progress.h"
#include "pipeline/outcome_json.h"
#include "validate/report_json.h"

namespace watertight {
namespace {

Engine engine_of(const std::string& name) {
  if (name == "cgal") return Engine::cgal;
  return name == "tetgen" ? Engine::tetgen : Engine::automatic;
}

IngestOptions options_of(const ValidateCommand& command) {
  IngestOptions options;
  options.threads = command.jobs;
  options.certify.tolerances.planarity_metres = command.planarity_metres;
  options.certify.tolerances.planarity_degrees = command.planarity_degrees;
  options.certify.proof = command.proof == "boundary" ? Proof::boundary : Proof::tetrahedralization;
  options.certify.ladder.engine = engine_of(command.engine);
  options.certify.ladder.strict = command.is_strict;
  return options;
}

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

std::string place_of(const SolidSource& source) {
  if (!source.pointer.empty()) return source.pointer;
  return source.object_id.empty() ? "solid " + std::to_string(source.ordinal) : source.object_id;
}

/// Appends {"file": file, member: value} to the elements of an array; `value` is JSON.
void append_file(std::string& elements, const std::string& file, std::string_view member,
                 std::string_view value) {
  if (!elements.empty()) elements += ',';
  elements += "{\"file\":";
  elements += json_string(file);
  elements += ',';
  elements += json_string(member);
  elements += ':';
  elements += value;
  elements += '}';
}

}  // namespace

void complain(const std::string& file, const Error& error) {
  const std::string text = to_string(error);
  std::fprintf(stderr, "watertight: %s: %s\n", file == "-" ? "standard input" : file.c_str(),
               text.c_str());
}

void print_findings(const std::string& file, const IngestOutcome& outcome) {
  for (const FeatureOutcome& feature : outcome.features) {
    for (const SolidOutcome& solid : feature.solids) {
      if (solid.report.verdict == Verdict::valid && solid.report.findings.empty()) continue;
      print(file + ": " + place_of(solid.source) + "\n");
      for (const std::string& line : report_text(solid.report)) print("  " + line + "\n");
    }
  }
}

Exit run(const ValidateCommand& command) {
  const auto start = std::chrono::steady_clock::now();
  EngineWorkers workers(EngineWorkers::Options{{}, {}, command.jobs});
  Summary summary;
  Exit exit = Exit::valid;
  std::string json;
  for (const std::string& file : command.files) {
    IngestOptions options = options_of(command);
    ProgressBar bar(file);
    options.progress = [&bar](std::size_t done, std::size_t total) { bar.show(done, total); };
    const auto bytes = read_file(file, options.certify.limits);
    auto input = bytes ? load_input(file, *bytes, {}) : Result<Input>(bytes.error());
    auto outcome = input ? validate_document(std::move(input->document), &workers, options)
                         : Result<IngestOutcome>(input.error());
    if (!outcome) {
      complain(file, outcome.error());
      exit = Exit::error;
      append_file(json, file, "error", json_string(to_string(outcome.error())));
      continue;
    }
    if (!command.is_quiet) print_findings(file, *outcome);
    summary.add(*outcome, bytes->size());
    exit = worse(exit, exit_of(outcome->verdict));
    if (command.report.empty()) continue;
    append_file(json, file, "outcome", outcome_json(*outcome));
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (command.report != "-") print(summary.table(seconds));
  if (command.report.empty()) return exit;
  std::string report = "{\"summary\":";
  report += summary.json(seconds);
  report += ",\"files\":[";
  report += json;
  report += "]}\n";
  const Status status = write_file(command.report, as_bytes(report));
  if (status) return exit;
  complain(command.report, status.error());
  return Exit::error;
}

}  // namespace watertight
