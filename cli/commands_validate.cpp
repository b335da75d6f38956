// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include "cli/commands.h"
#include "cli/files.h"
#include "cli/inputs.h"
#include "cli/printable.h"
#include "cli/progress.h"
#include "formats/mesh/interior_shells.h"
#include "pipeline/validate_stream.h"
#include "report/feature_report.h"
#include "validate/report_json.h"

namespace watertight::cli {
namespace {

delaunay::Engine engine_of(const std::string& name) {
  if (name == "cgal") return delaunay::Engine::cgal;
  return name == "tetgen" ? delaunay::Engine::tetgen : delaunay::Engine::automatic;
}

pipeline::StreamOptions options_of(const ValidateCommand& command) {
  pipeline::StreamOptions options;
  options.threads = command.jobs;
  options.groups.overlap_metres = command.overlap_metres;
  options.certify.tolerances.planarity_metres = command.planarity_metres;
  options.certify.tolerances.planarity_degrees = command.planarity_degrees;
  options.certify.proof = command.proof == "boundary" ? Proof::boundary : Proof::tetrahedralization;
  options.certify.also_tolerant = command.also_tolerant;
  options.certify.ladder.engine = engine_of(command.engine);
  options.certify.ladder.strict = command.is_strict;
  options.certify.ladder.seconds_in_all = command.seconds_per_solid;
  return options;
}

std::string time_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return std::string(text.data(), size);
}

report::ReportHead head_of(const ValidateCommand& command, const pipeline::StreamOptions& options) {
  report::ReportHead head;
  head.program_version = command.program_version;
  if (!command.leaves_times_out) head.time = time_now();
  head.acceptance = {options.certify.tolerances, options.certify.proof, geometry::kRuleSet};
  head.is_strict = command.is_strict;
  head.overlap_metres = command.overlap_metres;
  head.also_tolerant = command.also_tolerant;
  return head;
}

void print(const std::string& text, std::FILE* out = stdout) {
  std::fwrite(text.data(), 1, text.size(), out);
}

std::string place_of(const SolidSource& source) {
  if (!source.pointer.empty()) return source.pointer;
  return source.object_id.empty() ? "solid " + std::to_string(source.ordinal) : source.object_id;
}

void print_solid(const std::string& file, const SolidSource& source, const Report& report,
                 std::FILE* out) {
  if (report.verdict == Verdict::valid && report.findings.empty()) return;
  print(printable(file + ": " + place_of(source)) + "\n", out);
  for (const std::string& line : validate::report_text(report))
    print("  " + printable(line) + "\n", out);
}

/// Prints the findings of groups. `source_of(i)` is the source of the feature's solid i.
template <class SourceOf>
void print_groups(const std::string& file, const std::vector<pipeline::InspectedGroup>& groups,
                  const SourceOf& source_of, std::FILE* out) {
  for (const pipeline::InspectedGroup& group : groups) {
    for (const Finding& finding : group.report.findings) {
      std::string line = file + ": " + group.object_id;
      if (!group.lod.empty()) line += " (LoD " + group.lod + ")";
      line = printable(line) + "\n  " + printable(validate::finding_text(finding));
      for (const auto& place : {std::optional(finding.place), finding.other}) {
        if (!place || place->solid >= group.members.size()) continue;
        line += "\n    " + printable(place_of(source_of(group.members[place->solid])));
      }
      print(line + "\n", out);
    }
  }
}

std::string output_name(const std::string& path) { return path == "-" ? "standard output" : path; }

/// One of the reports that a run writes to files.
struct OpenReport {
  std::unique_ptr<FileWriter> file;
  std::unique_ptr<report::FeatureReport> report;
  std::string path;
};

using ReportMaker = std::unique_ptr<report::FeatureReport> (*)(report::TextSink,
                                                               report::ReportHead);

std::unique_ptr<report::FeatureReport> page_report(report::TextSink sink, report::ReportHead head) {
  return report::html_report(std::move(sink), std::move(head), {});
}

/// A run of `watertight validate`: all files, one after the other.
class Validation {
 public:
  explicit Validation(const ValidateCommand& command)
      : command_(command),
        options_(options_of(command)),
        workers_(delaunay::EngineWorkers::Options{{}, {}, command.jobs}),
        is_output_taken_(command.report == "-" || command.geojson == "-" || command.html == "-"),
        is_quiet_(command.is_quiet || is_output_taken_) {}

  Exit run();

 private:
  bool open_reports();
  bool is_in_use(const std::string& path) const;
  void validate_file(const std::string& file);
  Result<OpenedInput> open_file(const std::string& file);
  Result<formats::FeatureReader> with_cavities(const std::string& file);
  Result<pipeline::StreamOutcome> stream(const std::string& file, OpenedInput& input);
  template <class Call>
  Status tell_reports(const Call& call);
  void fail(const std::string& file, const Error& error) {
    complain(file, error);
    exit_ = Exit::error;
  }

  const ValidateCommand& command_;
  pipeline::StreamOptions options_;
  delaunay::EngineWorkers workers_;
  bool is_output_taken_ = false;  // a report goes to the standard output
  bool is_quiet_ = false;
  std::vector<OpenReport> reports_;
  Summary summary_;
  Exit exit_ = Exit::valid;
};

/// Whether a path is that of an input, or of a report that is open already.
bool Validation::is_in_use(const std::string& path) const {
  const auto is_it = [&](const std::string& other) { return is_same_file(path, other); };
  const auto is_report = [&](const OpenReport& open) { return is_it(open.path); };
  if (std::any_of(reports_.begin(), reports_.end(), is_report)) return true;
  if (path == "-") return false;
  const auto& cavities = command_.interior_shells;
  return std::any_of(command_.files.begin(), command_.files.end(), is_it) ||
         std::any_of(cavities.begin(), cavities.end(), is_it);
}

bool Validation::open_reports() {
  const std::array<std::pair<const std::string*, ReportMaker>, 3> wanted{
      {{&command_.report, report::json_report},
       {&command_.geojson, report::geojson_report},
       {&command_.html, page_report}}};
  for (const auto& [path, make] : wanted) {
    if (path->empty()) continue;
    if (is_in_use(*path)) {
      fail(output_name(*path), {ErrorCode::invalid_argument,
                                "a report would replace an input or another report of this run"});
      return false;
    }
    auto file = FileWriter::open(*path);
    if (!file) {
      fail(output_name(*path), file.error());
      return false;
    }
    auto writer = std::make_unique<FileWriter>(*std::move(file));
    auto sink = [to = writer.get()](std::string_view text) { return to->write(text); };
    auto report = make(std::move(sink), head_of(command_, options_));
    reports_.push_back({std::move(writer), std::move(report), *path});
  }
  return true;
}

/// Passes a call to all reports. Errors: the first report's error, naming its file.
template <class Call>
Status Validation::tell_reports(const Call& call) {
  for (OpenReport& open : reports_) {
    Status status = call(*open.report);
    if (status) continue;
    Error error = std::move(status).error();
    error.message.insert(0, output_name(open.path) + ": ");
    return error;
  }
  return Done{};
}

Result<formats::FeatureReader> Validation::with_cavities(const std::string& file) {
  const auto one_solid = [&](const std::string& path) -> Result<Document> {
    auto bytes = read_file(path, options_.certify.limits);
    auto input = bytes ? load_input(path, *bytes, {}) : Result<Input>(bytes.error());
    if (!input) return std::move(input).error();
    std::vector<Feature>& features = input->document.features;
    if (features.size() == 1 && features[0].solids.size() == 1) {
      const std::string& reason = features[0].solids[0].unreadable;
      if (!reason.empty()) return Error{ErrorCode::malformed, reason};
      return std::move(input->document);
    }
    return Error{ErrorCode::invalid_argument, "--interior-shell needs files with one solid each"};
  };
  auto document = one_solid(file);
  if (!document) return std::move(document).error();
  std::vector<SubmittedSolid> cavities;
  for (const std::string& path : command_.interior_shells) {
    auto cavity = one_solid(path);
    if (!cavity) {
      Error error = std::move(cavity).error();
      error.message.insert(0, "--interior-shell " + path + ": ");
      return error;
    }
    cavities.push_back(std::move(cavity->features[0].solids[0]));
  }
  SubmittedSolid& exterior = document->features[0].solids[0];
  auto solid = formats::with_interior_shells(exterior, cavities, options_.certify.limits);
  if (!solid) return std::move(solid).error();
  exterior = *std::move(solid);
  return formats::FeatureReader::of(*std::move(document));
}

Result<OpenedInput> Validation::open_file(const std::string& file) {
  if (command_.interior_shells.empty()) return open_input(file, {});
  auto reader = with_cavities(file);
  if (!reader) return std::move(reader).error();
  return OpenedInput{*std::move(reader), std::nullopt};
}

Result<pipeline::StreamOutcome> Validation::stream(const std::string& file, OpenedInput& input) {
  ProgressBar bar(file);
  const auto count = input.reader.feature_count();
  options_.progress = [&](std::uint64_t features, std::uint64_t bytes) {
    bar.show(features, share_done(features, count, bytes, input.bytes));
  };
  return pipeline::validate_stream(
      input.reader, &workers_, options_,
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        if (!is_quiet_) print_findings(file, feature.inspected);
        summary_.add(feature.inspected);
        return tell_reports([&](report::FeatureReport& report) { return report.add(feature); });
      },
      [&](const Error& error) -> Status {
        summary_.add_unreadable();
        fail(file, error);
        return tell_reports([&](report::FeatureReport& report) { return report.add_error(error); });
      });
}

void Validation::validate_file(const std::string& file) {
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t solids_before = summary_.solids();
  auto input = open_file(file);
  report::DocumentHead head{file, {}};
  if (input) head.format = input->reader.document().format;
  Status status =
      tell_reports([&](report::FeatureReport& report) { return report.begin_document(head); });
  report::DocumentEnd end;
  if (status && input) {
    const auto outcome = stream(file, *input);
    if (outcome) {
      exit_ = worse(exit_, exit_of(outcome->verdict));
    } else {
      status = outcome.error();
    }
    end.notes = input->reader.document().notes;
    if (outcome && outcome->unreadable == 0 && summary_.solids() == solids_before) {
      end.notes.emplace_back("the document has no solids; surfaces are not validated");
      std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(),
                   end.notes.back().c_str());
    }
    summary_.add_file_bytes(input->reader.bytes_read());
  } else if (status) {
    fail(file, input.error());
    status = tell_reports(
        [&](report::FeatureReport& report) { return report.add_error(input.error()); });
  }
  end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (status) {
    status = tell_reports([&](report::FeatureReport& report) { return report.end_document(end); });
  }
  if (!status) {
    fail(file, status.error());
    reports_.clear();
  }
}

Exit Validation::run() {
  const auto start = std::chrono::steady_clock::now();
  if (!open_reports()) return exit_;
  for (const std::string& file : command_.files) validate_file(file);
  for (OpenReport& open : reports_) {
    Status status = open.report->finish();
    if (status) status = open.file->commit();
    if (!status) fail(output_name(open.path), status.error());
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!is_quiet_ && summary_.has_findings()) {
    print("places: solids, shells, facets, rings and vertices count from 0, lines from 1\n");
  }
  if (!is_output_taken_) print(summary_.table(seconds));
  return exit_;
}

}  // namespace

void complain(const std::string& file, const Error& error) {
  const std::string name = file == "-" ? "standard input" : printable(file);
  const std::string text = printable(to_string(error));
  std::fprintf(stderr, "watertight: %s: %s\n", name.c_str(), text.c_str());
}

void print_findings(const std::string& file, const pipeline::InspectedFeature& feature) {
  for (const pipeline::InspectedSolid& solid : feature.solids) {
    print_solid(file, solid.source, solid.inspection.report, stdout);
  }
  const auto source_of = [&](std::size_t i) { return feature.solids[i].source; };
  print_groups(file, feature.groups, source_of, stdout);
}

void print_findings(const std::string& file, const pipeline::FeatureOutcome& feature,
                    std::FILE* out) {
  for (const pipeline::SolidOutcome& solid : feature.solids) {
    print_solid(file, solid.source, solid.report, out);
  }
  const auto source_of = [&](std::size_t i) { return feature.solids[i].source; };
  print_groups(file, feature.groups, source_of, out);
}

Exit run(const ValidateCommand& command) { return Validation(command).run(); }

}  // namespace watertight::cli
