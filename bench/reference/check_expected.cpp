// SPDX-License-Identifier: GPL-3.0-or-later
//
// check_expected FOLDER [LIST] [--all]: compares the verdicts with the codes that the authors of
// test files state, as rows "file,expected,remark" of LIST (FOLDER/expected.csv). The first levels
// of the tolerant verdict are compared, as sets of codes, where some codes stand for others: 202
// and 206 for 201, 402 for 401, 105 for 104, 308 for 405, 304 for 303 or 302; tolerance(N) is N or
// valid. Files with the remark "given as interior shell of F" are read as a cavity of F. Prints
// every difference (--all: every row) and exits with 1 if there is one.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bench/input.h"
#include "formats/mesh/interior_shells.h"
#include "pipeline/indoor/cells.h"
#include "pipeline/pipeline.h"

using namespace watertight;

namespace {

using Codes = std::set<int>;

struct Row {
  std::string file, expected, remark;
};

std::vector<Row> read_rows(const std::filesystem::path& path) {
  std::vector<Row> rows;
  std::ifstream stream(path);
  std::string line;
  std::getline(stream, line);  // skips the header
  while (std::getline(stream, line)) {
    const std::size_t first = line.find(',');
    const std::size_t second = line.find(',', first + 1);
    if (second == std::string::npos) continue;
    rows.push_back({line.substr(0, first), line.substr(first + 1, second - first - 1),
                    line.substr(second + 1)});
  }
  return rows;
}

/// The code that stands for all codes that count as one.
int representative(int code) {
  switch (code) {
    case 202:
    case 206:
      return 201;
    case 402:
      return 401;
    case 105:
      return 104;
    case 308:
      return 405;
    default:
      return code;
  }
}

/// The codes of a text like "203+601" or "valid".
Codes codes_of(const std::string& text) {
  Codes codes;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('+', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (word != "valid") codes.insert(representative(std::stoi(word)));
    at = end + 1;
  }
  return codes;
}

/// The sets of codes that agree with the expected text.
std::vector<Codes> accepted(const std::string& expected) {
  constexpr std::string_view kTolerance = "tolerance(";
  if (expected.starts_with(kTolerance)) {
    return {{}, codes_of(expected.substr(kTolerance.size(), 3))};
  }
  if (expected == "304") return {{303}, {302}};
  std::vector<Codes> sets;
  for (std::size_t at = 0; at < expected.size();) {
    const std::size_t end = std::min(expected.find(" or ", at), expected.size());
    sets.push_back(codes_of(expected.substr(at, end - at)));
    at = end + 4;
  }
  return sets;
}

std::string text_of(const Codes& codes) {
  std::string text;
  for (const int code : codes) {
    if (!text.empty()) text += '+';
    text += std::to_string(code);
  }
  return text.empty() ? "valid" : text;
}

/// True for files that val3dity's suite gives together with a second cavity. The data set lacks the
/// file of that cavity, but 402_in_1.poly is equal to it (code 402: duplicated shells).
bool needs_twin(const std::string& name) {
  return name == "401_2.poly" || name == "401_3.poly" || name == "402_in_1.poly";
}

/// The document of a file; with `exterior`, its solids become cavities of the solid in that file.
Result<Document> read_row(const std::filesystem::path& file,
                          const std::filesystem::path& exterior) {
  auto document = bench::read_file(file);
  if (!document || exterior.empty()) return document;
  auto outside = bench::read_file(exterior);
  if (!outside) return outside;
  std::vector<SubmittedSolid> interior = document->features.at(0).solids;
  if (needs_twin(file.filename().string())) {
    const auto twin = bench::read_file(file.parent_path() / "402_in_1.poly");
    if (!twin) return twin.error();
    interior.push_back(twin->features.at(0).solids.at(0));
  }
  auto solid = formats::with_interior_shells(outside->features.at(0).solids.at(0), interior);
  if (!solid) return solid.error();
  outside->features[0].solids[0] = std::move(*solid);
  return outside;
}

struct Outcome {
  Codes tolerant, exact;
  std::string error;  // the reason why the file could not be read
};

Outcome outcome_of(const std::filesystem::path& file, const std::filesystem::path& exterior,
                   delaunay::EngineWorkers* workers) {
  Outcome outcome;
  auto document = read_row(file, exterior);
  if (!document) {
    const int code = document.error().code == ErrorCode::unsupported ? 904 : 901;
    outcome.error = to_string(document.error());
    outcome.tolerant = outcome.exact = {code};
    return outcome;
  }
  CertifyOptions options;
  options.also_tolerant = true;
  const auto add = [&](const Report& report) {
    outcome.exact.insert(report.first_level.begin(), report.first_level.end());
    const auto& codes = report.tolerant ? report.tolerant->first_level : report.first_level;
    outcome.tolerant.insert(codes.begin(), codes.end());
  };
  if (!document->templates.empty()) {
    Feature feature;
    feature.solids = document->templates;
    const pipeline::InspectedFeature inspected =
        pipeline::inspect(std::move(feature), workers, options);
    for (const pipeline::InspectedSolid& solid : inspected.solids) add(solid.inspection.report);
  }
  pipeline::CellInspector cells(*document, workers, options, {}, 1);
  for (Feature& feature : document->features) {
    const pipeline::InspectedFeature inspected =
        pipeline::inspect(std::move(feature), workers, options, {}, nullptr, &cells);
    for (const pipeline::InspectedSolid& solid : inspected.solids) add(solid.inspection.report);
    for (const pipeline::InspectedGroup& group : inspected.groups) {
      for (const Finding& finding : group.report.findings) {
        outcome.exact.insert(finding.code);
        outcome.tolerant.insert(finding.code);
      }
    }
  }
  return outcome;
}

/// The file that a remark names as exterior shell, as a path; "" without such a remark.
std::filesystem::path exterior_of(const std::filesystem::path& folder, const Row& row) {
  constexpr std::string_view kRemark = "given as interior shell of ";
  const std::size_t at = row.remark.find(kRemark);
  if (at == std::string::npos) return {};
  // The name in the remark is relative to the folder that holds the folder of the row's file.
  const auto base = (folder / row.file).parent_path().parent_path();
  std::filesystem::path file = base / row.remark.substr(at + kRemark.size());
  if (!std::filesystem::exists(file)) file.replace_extension(".off");
  return file;
}

bool agrees(const Row& row, const Codes& tolerant) {
  Codes codes;
  for (const int code : tolerant) codes.insert(representative(code));
  const std::vector<Codes> sets = accepted(row.expected);
  return std::find(sets.begin(), sets.end(), codes) != sets.end();
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  if (words.empty()) {
    std::fprintf(stderr, "check_expected FOLDER [LIST] [--all]\n");
    return 2;
  }
  const std::filesystem::path folder = words[0];
  const bool shows_all = words.back() == "--all";
  const bool has_list = words.size() > 1 && words[1] != "--all";
  const std::vector<Row> rows =
      read_rows(has_list ? std::filesystem::path(words[1]) : folder / "expected.csv");
  delaunay::EngineWorkers workers;
  std::size_t compared = 0, different = 0;
  for (const Row& row : rows) {
    ++compared;
    const Outcome outcome = outcome_of(folder / row.file, exterior_of(folder, row), &workers);
    const bool is_same = agrees(row, outcome.tolerant);
    different += is_same ? 0 : 1;
    if (is_same && !shows_all) continue;
    std::printf("%-9s %-60s expected %-12s tolerant %-12s exact %-12s %s\n",
                is_same ? "same" : "DIFFERENT", row.file.c_str(), row.expected.c_str(),
                text_of(outcome.tolerant).c_str(), text_of(outcome.exact).c_str(),
                outcome.error.c_str());
    std::fflush(stdout);
  }
  std::printf("%zu rows compared, %zu different\n", compared, different);
  return different == 0 ? 0 : 1;
}
