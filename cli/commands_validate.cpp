// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/findings/baseline.h"
#include "cli/findings/explain.h"
#include "cli/findings/finding_list.h"
#include "cli/sources/input_list.h"
#include "cli/terminal/printable.h"
#include "cli/terminal/progress.h"
#include "files/files.h"
#include "files/inputs.h"
#include "formats/mesh/interior_shells.h"
#include "pipeline/validate_stream.h"
#include "report/feature_report.h"

namespace watertight::cli {
namespace {

constexpr const char* kNumbering =
    "places: solids, shells, facets, rings and vertices count from 0, lines from 1\n";

delaunay::Engine engine_of(const std::string& name) {
  if (name == "cgal") return delaunay::Engine::cgal;
  return name == "tetgen" ? delaunay::Engine::tetgen : delaunay::Engine::automatic;
}

pipeline::StreamOptions options_of(const ValidateCommand& command) {
  pipeline::StreamOptions options;
  options.threads = command.jobs;
  apply(command.rules, options.certify, options.groups);
  options.certify.severity_of_surfaces = surface_rule(command.surfaces).severity;
  options.certify.also_tolerant = command.tolerant_metres.has_value();
  if (command.tolerant_metres) options.certify.tolerant_snap_metres = *command.tolerant_metres;
  options.certify.ladder.engine = engine_of(command.engine);
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
  head.is_strict = command.rules.is_strict;
  head.overlap_metres = command.rules.overlap_metres.value_or(0);
  head.also_tolerant = options.certify.also_tolerant;
  head.tolerant_snap_metres = options.certify.tolerant_snap_metres;
  if (command.surfaces != ValidateCommand().surfaces) head.surfaces = command.surfaces;
  return head;
}

void print(const std::string& text, std::FILE* out = stdout) {
  std::fwrite(text.data(), 1, text.size(), out);
}

void note(const std::string& file, const std::string& text) {
  std::fprintf(stderr, "watertight: %s: %s\n", printable(file).c_str(), text.c_str());
}

std::string output_name(const std::string& path) { return path == "-" ? "standard output" : path; }

/// One of the reports that a run writes to files.
struct OpenReport {
  std::unique_ptr<files::FileWriter> file;
  std::unique_ptr<report::FeatureReport> report;
  std::string path;
};

using ReportMaker = std::unique_ptr<report::FeatureReport> (*)(report::TextSink,
                                                               const report::ReportHead&);

template <auto make>
std::unique_ptr<report::FeatureReport> made(report::TextSink sink, const report::ReportHead& head) {
  return make(std::move(sink), head);
}

std::unique_ptr<report::FeatureReport> page_report(report::TextSink sink,
                                                   const report::ReportHead& head) {
  return report::html_report(std::move(sink), head, {});
}

std::unique_ptr<report::FeatureReport> table_report(report::TextSink sink,
                                                    const report::ReportHead& /*head*/) {
  return report::csv_report(std::move(sink));
}

/// A run of `watertight validate`: all files, one after the other.
class Validation {
 public:
  explicit Validation(const ValidateCommand& command)
      : command_(command),
        inputs_(list_inputs(command.files)),
        options_(options_of(command)),
        workers_(delaunay::EngineWorkers::Options{{}, {}, command.jobs}),
        is_output_taken_(has_output("-")),
        is_quiet_(command.is_quiet || is_output_taken_) {}

  Exit run();

 private:
  /// The options that name a file for a report, with the report's maker.
  std::array<std::pair<const std::string*, ReportMaker>, 5> outputs() const {
    return {{{&command_.report, made<report::json_report>},
             {&command_.geojson, made<report::geojson_report>},
             {&command_.html, page_report},
             {&command_.csv, table_report},
             {&command_.sarif, made<report::sarif_report>}}};
  }
  bool has_output(std::string_view path) const {
    const auto all = outputs();
    return std::any_of(all.begin(), all.end(),
                       [&](const auto& output) { return *output.first == path; });
  }
  bool open_reports();
  bool open_baseline();
  void take_feature(const std::string& file, const pipeline::InspectedFeature& feature);
  void end_file(const std::string& file, bool has_solids, bool has_surfaces);
  std::string note_without_solids(std::uint64_t surfaces) const;
  bool is_in_use(const std::string& path) const;
  void validate_file(const files::InputFile& source);
  Result<files::OpenedInput> open_source(const files::InputFile& source);
  Result<formats::FeatureReader> with_cavities(const files::InputFile& source);
  Result<pipeline::StreamOutcome> stream(const std::string& file, files::OpenedInput& input);
  template <class Call>
  Status tell_reports(const Call& call);
  void fail(const std::string& file, const Error& error) {
    complain(file, error);
    exit_ = Exit::error;
  }

  const ValidateCommand& command_;
  const std::vector<files::InputFile> inputs_;
  pipeline::StreamOptions options_;
  delaunay::EngineWorkers workers_;
  bool is_output_taken_ = false;  // a report goes to the standard output
  bool is_quiet_ = false;
  std::vector<OpenReport> reports_;
  std::optional<Baseline> baseline_;
  std::size_t file_number_ = 0;  // of the file in work, from 1
  std::uint64_t omitted_ = 0;    // findings of that file that are only counted
  FindingList findings_;
  Summary summary_;
  Exit exit_ = Exit::valid;
};

/// Whether a path is that of an input, or of a report that is open already.
bool Validation::is_in_use(const std::string& path) const {
  const auto is_it = [&](const std::string& other) { return files::is_same_file(path, other); };
  const auto is_report = [&](const OpenReport& open) { return is_it(open.path); };
  if (std::any_of(reports_.begin(), reports_.end(), is_report)) return true;
  if (path == "-") return false;
  const auto& cavities = command_.interior_shells;
  if (!command_.baseline.empty() && is_it(command_.baseline)) return true;
  const auto is_input = [&](const files::InputFile& input) { return is_it(input.file); };
  return std::any_of(inputs_.begin(), inputs_.end(), is_input) ||
         std::any_of(cavities.begin(), cavities.end(), is_it);
}

bool Validation::open_reports() {
  for (const auto& [path, make] : outputs()) {
    if (path->empty()) continue;
    if (is_in_use(*path)) {
      fail(output_name(*path), {ErrorCode::invalid_argument,
                                "a report would replace an input or another report of this run"});
      return false;
    }
    auto file = files::FileWriter::open(*path);
    if (!file) {
      fail(output_name(*path), file.error());
      return false;
    }
    auto writer = std::make_unique<files::FileWriter>(*std::move(file));
    auto sink = [to = writer.get()](std::string_view text) { return to->write(text); };
    auto report = make(std::move(sink), head_of(command_, options_));
    reports_.push_back({std::move(writer), std::move(report), *path});
  }
  return true;
}

bool Validation::open_baseline() {
  if (command_.baseline.empty()) return true;
  const auto bytes = files::read_file(command_.baseline, options_.certify.limits);
  auto baseline = bytes ? Baseline::read(*bytes) : Result<Baseline>(bytes.error());
  if (!baseline) {
    fail(command_.baseline, baseline.error());
    return false;
  }
  baseline_ = *std::move(baseline);
  return true;
}

/// The status that a feature gives. With a baseline an invalid feature counts if it has an error
/// that the baseline does not have.
Exit exit_of_feature(const pipeline::InspectedFeature& feature, const FeatureLines& lines,
                     bool has_baseline) {
  if (!has_baseline) return exit_of(feature.verdict());
  if (lines.errors > 0) return Exit::invalid;
  const auto& solids = feature.solids;
  const bool is_undecided = std::any_of(solids.begin(), solids.end(), [](const auto& solid) {
    return solid.inspection.report.verdict == Verdict::undecided;
  });
  return is_undecided ? Exit::undecided : Exit::valid;
}

void Validation::take_feature(const std::string& file, const pipeline::InspectedFeature& feature) {
  std::vector<bool> is_known;
  if (baseline_) {
    is_known = baseline_->take(file, feature);
    const auto known =
        static_cast<std::uint64_t>(std::count(is_known.begin(), is_known.end(), true));
    summary_.add(BaselineCounts{is_known.size() - known, known, 0});
  }
  for (const auto& solid : feature.solids) omitted_ += solid.inspection.report.findings_omitted;
  for (const auto& group : feature.groups) omitted_ += group.report.findings_omitted;
  FeatureLines lines = lines_of(file, feature, is_known);
  exit_ = worse(exit_, exit_of_feature(feature, lines, baseline_.has_value()));
  if (!is_quiet_) findings_.add(std::move(lines));
  summary_.add(feature);
}

/// The part of a file's result that is known at its end.
void Validation::end_file(const std::string& file, bool has_solids, bool has_surfaces) {
  summary_.add_file(has_solids, has_surfaces);
  if (!has_solids && command_.requires_solids) {
    note(file, std::string(has_surfaces ? "only surfaces were" : "nothing was") +
                   " checked, and --require-solids asks for solids");
    exit_ = worse(exit_, Exit::invalid);
  }
  if (!baseline_) return;
  const std::uint64_t omitted = baseline_->newly_omitted(file, omitted_);
  if (omitted > 0) exit_ = worse(exit_, Exit::invalid);
  summary_.add(BaselineCounts{omitted, 0, baseline_->gone(file)});
}

std::string Validation::note_without_solids(std::uint64_t surfaces) const {
  if (command_.surfaces == "ignore") return "the document has no solids; surfaces are ignored";
  if (surfaces == 0) return "the document has no solids and no surfaces";
  return "the document has no solids; rings and facets of " + quantity(surfaces, "surface") +
         " were checked";
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

Result<formats::FeatureReader> Validation::with_cavities(const files::InputFile& source) {
  const auto one_solid = [&](const files::InputFile& from) -> Result<Document> {
    const auto whole = files::read_whole(from, options_.certify.limits);
    auto input = whole ? files::load_input(whole->name, whole->bytes, {})
                       : Result<files::Input>(whole.error());
    if (!input) return std::move(input).error();
    std::vector<Feature>& features = input->document.features;
    if (features.size() == 1 && features[0].solids.size() == 1) {
      const std::string& reason = features[0].solids[0].unreadable;
      if (!reason.empty()) return Error{ErrorCode::malformed, reason};
      return std::move(input->document);
    }
    return Error{ErrorCode::invalid_argument, "--interior-shell needs files with one solid each"};
  };
  auto document = one_solid(source);
  if (!document) return std::move(document).error();
  std::vector<SubmittedSolid> cavities;
  for (const std::string& path : command_.interior_shells) {
    const auto input = single_input(path);
    auto cavity = input ? one_solid(*input) : Result<Document>(input.error());
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

Result<files::OpenedInput> Validation::open_source(const files::InputFile& source) {
  formats::ReadOptions reading;
  reading.surfaces = surface_rule(command_.surfaces).reading;
  if (command_.interior_shells.empty()) return files::open_input(source, reading);
  auto reader = with_cavities(source);
  if (!reader) return std::move(reader).error();
  return files::OpenedInput{*std::move(reader), std::nullopt};
}

Result<pipeline::StreamOutcome> Validation::stream(const std::string& file,
                                                   files::OpenedInput& input) {
  ProgressBar bar(file, position_among(file_number_, inputs_.size()));
  const auto count = input.reader.feature_count();
  options_.progress = [&](std::uint64_t features, std::uint64_t bytes) {
    bar.show(features, share_done(features, count, bytes, input.bytes));
  };
  return pipeline::validate_stream(
      input.reader, &workers_, options_,
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        take_feature(file, feature.inspected);
        return tell_reports([&](report::FeatureReport& report) { return report.add(feature); });
      },
      [&](const Error& error) -> Status {
        summary_.add_unreadable();
        fail(file, error);
        return tell_reports([&](report::FeatureReport& report) { return report.add_error(error); });
      });
}

void Validation::validate_file(const files::InputFile& source) {
  const std::string& file = source.name;
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t solids_before = summary_.solids();
  const std::uint64_t surfaces_before = summary_.surfaces().checked;
  omitted_ = 0;
  auto input = open_source(source);
  report::DocumentHead head{file, {}};
  if (input) head.format = input->reader.document().format;
  Status status =
      tell_reports([&](report::FeatureReport& report) { return report.begin_document(head); });
  report::DocumentEnd end;
  if (status && input) {
    const auto outcome = stream(file, *input);
    if (!outcome) status = outcome.error();
    end.notes = input->reader.document().notes;
    const bool has_solids = summary_.solids() > solids_before;
    const std::uint64_t surfaces = summary_.surfaces().checked - surfaces_before;
    if (outcome && outcome->unreadable == 0 && !has_solids) {
      end.notes.push_back(note_without_solids(surfaces));
      note(file, end.notes.back());
    }
    if (outcome) end_file(file, has_solids, surfaces > 0);
    summary_.add_file_bytes(input->reader.bytes_read());
  } else if (status) {
    fail(file, input.error());
    summary_.add_unreadable_file();
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
  if (!open_baseline() || !open_reports()) return exit_;
  for (const files::InputFile& input : inputs_) {
    ++file_number_;
    validate_file(input);
  }
  for (OpenReport& open : reports_) {
    Status status = open.report->finish();
    if (status) status = open.file->commit();
    if (!status) fail(output_name(open.path), status.error());
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!is_output_taken_) {
    print(summary_.headline() + "\n" + summary_.table(seconds));
    const std::string findings = findings_.text();
    if (!findings.empty()) print("\n" + findings + kNumbering);
  }
  return exit_;
}

}  // namespace

void complain(const std::string& file, const Error& error) {
  const std::string name = file == "-" ? "standard input" : printable(file);
  const std::string text = printable(to_string(error));
  std::fprintf(stderr, "watertight: %s: %s\n", name.c_str(), text.c_str());
}

Exit fail(const std::string& file, const Error& error) {
  complain(file, error);
  return Exit::error;
}

Exit fail_to_write(const std::string& file, const Error& error) {
  return fail(file == "-" ? "standard output" : file, error);
}

void print_findings(const std::string& file, const pipeline::FeatureOutcome& feature,
                    std::FILE* out) {
  print(text_of(lines_of(file, feature)), out);
}

Exit run(const ValidateCommand& command) {
  if (command.explain.empty()) return Validation(command).run();
  const auto text = explained(command.explain);
  if (!text) {
    complain(command.explain, text.error());
    return Exit::error;
  }
  print(*text);
  return Exit::valid;
}

}  // namespace watertight::cli
