// SPDX-License-Identifier: GPL-3.0-or-later
//
// decide_all [--engine-only] [--attempts] FILE_OR_FOLDER...: runs certify() on every solid of the
// files. Prints how many solids were decided, by rung and class of outcome; the cost of the CDT
// step beside the engine's own CPU time; and every undecided solid with the reason. --engine-only
// leaves rung 0 out, so that the engine's CPU time is that of the whole set. --attempts prints
// every attempt that was not accepted, and every one that took longer than 0.1 s. Exit status 1 if
// a solid is undecided.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "bench/input.h"
#include "counted_memory.h"
#include "delaunay/cdt_statistics.h"
#include "validate/certify.h"

using namespace watertight;

namespace {

/// The CPU time in seconds above which an attempt is printed.
constexpr double kSlow = 0.1;

struct Settings {
  bool is_engine_only = false;
  bool prints_attempts = false;
  std::vector<std::string> files;
};

struct Totals {
  std::size_t files = 0, unreadable = 0, solids = 0, valid = 0, invalid = 0;
  double seconds = 0;  // the elapsed time of certify()
  /// The counts of the solids for which an engine was asked.
  delaunay::CdtStatistics with_engine;
  delaunay::CdtStatistics cdt;
  std::vector<double> bytes_a_vertex;  // the most that certify() held, for each solid
  std::vector<double> recovered_ms;  // CPU time of rung 1, with its certificate, where it was tried
  std::size_t steiner_points = 0;    // of the accepted tetrahedralizations
  std::vector<std::string> undecided;
};

void add_path(const std::string& path, std::vector<std::string>& files) {
  std::error_code failed;
  if (!std::filesystem::is_directory(path, failed)) {
    files.push_back(path);
    return;
  }
  for (std::filesystem::recursive_directory_iterator at(path, failed), end; at != end;
       at.increment(failed)) {
    if (at->is_regular_file(failed)) files.push_back(at->path().string());
  }
}

void print_attempts(const std::string& name, const Report& report) {
  for (const delaunay::RungAttempt& attempt : report.attempts) {
    const bool is_usual = attempt.result == delaunay::RungOutcome::accepted ||
                          attempt.result == delaunay::RungOutcome::not_delaunay;
    if (is_usual && attempt.cpu_seconds + attempt.worker_seconds < kSlow) continue;
    std::printf("attempt %s: %s: %s: %.2f s CPU, worker %.2f s, engine %.2f s\n", name.c_str(),
                std::string(delaunay::to_string(attempt.rung)).c_str(), attempt.outcome.c_str(),
                attempt.cpu_seconds, attempt.worker_seconds, attempt.engine_seconds);
  }
}

void decide(const std::string& name, const SubmittedSolid& submitted,
            delaunay::EngineWorkers& workers, const Settings& settings, Totals& totals) {
  CertifyOptions options;
  options.unclosed_rings = submitted.unclosed_rings;
  if (settings.is_engine_only) options.ladder.first_rung = delaunay::Rung::patch;
  bench::count_bytes_from_here();
  const Inspection inspection = certify(submitted.solid, &workers, options);
  totals.bytes_a_vertex.push_back(static_cast<double>(bench::most_bytes_held()) /
                                  std::max(1U, submitted.solid.vertex_count()));
  const Report& report = inspection.report;
  ++totals.solids;
  totals.seconds += report.seconds;
  totals.cdt.add(report.attempts);
  const bool has_engine =
      std::any_of(report.attempts.begin(), report.attempts.end(),
                  [](const delaunay::RungAttempt& attempt) { return attempt.worker_seconds > 0; });
  if (has_engine) totals.with_engine.add(report.attempts);
  for (const delaunay::RungAttempt& attempt : report.attempts) {
    if (attempt.rung == delaunay::Rung::recovered) {
      totals.recovered_ms.push_back(1e3 * attempt.cpu_seconds);
    }
  }
  if (inspection.certified && inspection.certified->certificate) {
    const auto& made = inspection.certified->certificate->tetrahedralization;
    totals.steiner_points += made.points.size() - made.input_count;
  }
  if (settings.prints_attempts) print_attempts(name, report);
  if (report.verdict == Verdict::valid) ++totals.valid;
  if (report.verdict == Verdict::invalid) ++totals.invalid;
  if (report.verdict == Verdict::undecided) {
    totals.undecided.push_back(name + ": " + report.undecided_reason);
  }
}

void decide_file(const std::string& file, delaunay::EngineWorkers& workers,
                 const Settings& settings, Totals& totals) {
  ++totals.files;
  const auto document = bench::read_file(file);
  if (!document) {
    ++totals.unreadable;
    std::printf("unreadable %s: %s\n", file.c_str(), to_string(document.error()).c_str());
    return;
  }
  std::size_t number = 0;
  for (const Feature& feature : document->features) {
    for (const SubmittedSolid& submitted : feature.solids) {
      const std::string name =
          file + "#" + std::to_string(number++) + " " + submitted.source.object_id;
      decide(name, submitted, workers, settings, totals);
    }
  }
}

void print_cost(const char* what, const delaunay::CdtStatistics& cdt) {
  const double step = cdt.cpu_seconds + cdt.worker_seconds;
  std::printf(
      "CPU of the CDT step, %s: %.3f s (own %.3f s, workers %.3f s), engine's own calls "
      "%.3f s: ratio %.3f\n",
      what, step, cdt.cpu_seconds, cdt.worker_seconds, cdt.engine_seconds,
      step / std::max(cdt.engine_seconds, 1e-9));
}

void print_distribution(const char* what, std::vector<double> values) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const std::size_t n = values.size();
  std::printf("%s: mean %.3f, median %.3f, 99 %% below %.2f, most %.2f\n", what,
              sum / static_cast<double>(n), values[n / 2], values[n - 1 - n / 100], values[n - 1]);
}

void print_totals(const Totals& totals) {
  const delaunay::CdtStatistics& cdt = totals.cdt;
  std::printf("\n%zu files, %zu unreadable, %zu solids: %zu valid, %zu invalid, %zu undecided\n",
              totals.files, totals.unreadable, totals.solids, totals.valid, totals.invalid,
              totals.undecided.size());
  std::printf(
      "%llu solids passed the exact tests: %llu accepted, %llu refuted, %llu undecided\n",
      static_cast<unsigned long long>(cdt.solids), static_cast<unsigned long long>(cdt.accepted),
      static_cast<unsigned long long>(cdt.refuted), static_cast<unsigned long long>(cdt.undecided));
  for (std::size_t rung = 0; rung < delaunay::kRungs; ++rung) {
    for (std::size_t outcome = 0; outcome < delaunay::kRungOutcomes; ++outcome) {
      if (cdt.attempts[rung][outcome] == 0) continue;
      std::printf(
          "  %-16s %-22s %8llu\n",
          std::string(delaunay::to_string(static_cast<delaunay::Rung>(rung))).c_str(),
          std::string(delaunay::to_string(static_cast<delaunay::RungOutcome>(outcome))).c_str(),
          static_cast<unsigned long long>(cdt.attempts[rung][outcome]));
    }
  }
  std::printf("Steiner points: %zu\n", totals.steiner_points);
  std::printf("certify: %.2f s wall; CDT step: %.2f s wall\n", totals.seconds, cdt.seconds);
  print_cost("all solids", cdt);
  print_distribution("ms of CPU of rung recovered, with its certificate", totals.recovered_ms);
  print_distribution("bytes that certify() holds at most, for each vertex", totals.bytes_a_vertex);
  print_cost("those that reached an engine", totals.with_engine);
  for (const std::string& text : totals.undecided) std::printf("undecided %s\n", text.c_str());
}

}  // namespace

int main(int argument_count, char** arguments) {
  Settings settings;
  for (int i = 1; i < argument_count; ++i) {
    if (std::strcmp(arguments[i], "--engine-only") == 0) {
      settings.is_engine_only = true;
    } else if (std::strcmp(arguments[i], "--attempts") == 0) {
      settings.prints_attempts = true;
    } else {
      add_path(arguments[i], settings.files);
    }
  }
  if (settings.files.empty()) {
    std::fprintf(stderr, "usage: decide_all [--engine-only] [--attempts] FILE_OR_FOLDER...\n");
    return 2;
  }
  std::sort(settings.files.begin(), settings.files.end());
  std::setvbuf(stdout, nullptr, _IOLBF, 1 << 16);
  delaunay::EngineWorkers workers;
  Totals totals;
  for (const std::string& file : settings.files) decide_file(file, workers, settings, totals);
  print_totals(totals);
  return totals.undecided.empty() ? 0 : 1;
}
