// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/findings/baseline.h"
#include "cli/findings/explain.h"
#include "cli/findings/finding_list.h"
#include "cli/outputs/documents.h"
#include "cli/outputs/report_files.h"
#include "cli/outputs/strip_file.h"
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
  /// The options that name a file for a report, with the report's form.
  std::array<std::pair<const std::string*, ReportForm>, 5> outputs() const {
    return {{{&command_.report, ReportForm::json},
             {&command_.geojson, ReportForm::geojson},
             {&command_.html, ReportForm::html},
             {&command_.csv, ReportForm::csv},
             {&command_.sarif, ReportForm::sarif}}};
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
  Result<files::OpenedInput> read_and_save(const files::InputFile& source,
                                           formats::ReadOptions reading);
  Result<formats::FeatureReader> with_cavities(const files::InputFile& source);
  Result<pipeline::StreamOutcome> stream(const std::string& file, files::OpenedInput& input);
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
  ReportFiles reports_;
  std::optional<Baseline> baseline_;
  std::size_t file_number_ = 0;  // of the file in work, from 1
  std::uint64_t omitted_ = 0;    // findings of that file that are only counted
  FindingList findings_;
  Summary summary_;
  Exit exit_ = Exit::valid;
};

/// Whether a path is that of a file that the run reads.
bool Validation::is_in_use(const std::string& path) const {
  const auto is_it = [&](const std::string& other) { return files::is_same_file(path, other); };
  if (path == "-") return false;
  const auto& cavities = command_.interior_shells;
  if (!command_.baseline.empty() && is_it(command_.baseline)) return true;
  const auto is_input = [&](const files::InputFile& input) { return is_it(input.file); };
  return std::any_of(inputs_.begin(), inputs_.end(), is_input) ||
         std::any_of(cavities.begin(), cavities.end(), is_it);
}

bool Validation::open_reports() {
  for (const auto& [path, form] : outputs()) {
    if (path->empty()) continue;
    const Status opened =
        is_in_use(*path)
            ? Error{ErrorCode::invalid_argument, "a report would replace an input of this run"}
            : reports_.open(*path, form, head_of(command_, options_));
    if (!opened) {
      fail(output_name(*path), opened.error());
      return false;
    }
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

Result<files::OpenedInput> Validation::read_and_save(const files::InputFile& source,
                                                     formats::ReadOptions reading) {
  reading.split_features = false;
  for (const std::string& output : {command_.output, command_.strips}) {
    if (output.empty() || !is_in_use(output)) continue;
    return Error{ErrorCode::invalid_argument,
                 "the output '" + output + "' would replace the input"};
  }
  const auto whole = files::read_whole(source, options_.certify.limits);
  if (!whole) return whole.error();
  auto input = files::load_input(whole->name, whole->bytes, reading);
  if (!input) return std::move(input).error();
  if (Status saved = save_document(input->document, command_.output); !saved) {
    Error error = std::move(saved).error();
    error.message.insert(0, command_.output + ": ");
    return error;
  }
  if (!command_.strips.empty()) {
    if (Status saved = save_strips(input->document, command_.strips); !saved) {
      Error error = std::move(saved).error();
      error.message.insert(0, command_.strips + ": ");
      return error;
    }
  }
  return files::OpenedInput{formats::FeatureReader::of(std::move(input->document)), std::nullopt};
}

Result<files::OpenedInput> Validation::open_source(const files::InputFile& source) {
  formats::ReadOptions reading;
  reading.surfaces = surface_rule(command_.surfaces).reading;
  reading.curved = pipeline::curved_reading(command_.chord);
  reading.curved.lattice_exponent = command_.lattice_exponent;
  reading.curved.keeps_strips = !command_.strips.empty();
  if (!command_.output.empty()) return read_and_save(source, reading);
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
        return reports_.tell([&](report::FeatureReport& report) { return report.add(feature); });
      },
      [&](const Error& error) -> Status {
        summary_.add_unreadable();
        fail(file, error);
        return reports_.tell(
            [&](report::FeatureReport& report) { return report.add_error(error); });
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
      reports_.tell([&](report::FeatureReport& report) { return report.begin_document(head); });
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
    status = reports_.tell(
        [&](report::FeatureReport& report) { return report.add_error(input.error()); });
  }
  end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (status) {
    status = reports_.tell([&](report::FeatureReport& report) { return report.end_document(end); });
  }
  if (!status) {
    fail(file, status.error());
    reports_.give_up();
  }
}

Exit Validation::run() {
  const auto start = std::chrono::steady_clock::now();
  if (!open_baseline() || !open_reports()) return exit_;
  for (const files::InputFile& input : inputs_) {
    ++file_number_;
    validate_file(input);
  }
  reports_.finish([&](const std::string& file, const Error& error) { fail(file, error); });
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
