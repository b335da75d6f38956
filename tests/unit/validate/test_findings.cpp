// SPDX-License-Identifier: GPL-3.0-or-later
//
// tests/golden/findings holds one small file for each finding, with its expected report. The table
// of findings, docs/findings.md with its figures, and the samples must agree. With
// WATERTIGHT_UPDATE_GOLDEN set in the environment the expected reports are written, not compared.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "formats/document.h"
#include "tests/files.h"
#include "tests/unit/validate/solids.h"
#include "validate/finding_kinds.h"
#include "validate/groups.h"
#include "validate/indoor/indoor_model.h"
#include "validate/report_json.h"

using namespace watertight;
using namespace watertight::test;

namespace {

const std::filesystem::path kRoot = test::source_path("");
const std::filesystem::path kSamples = kRoot / "tests" / "golden" / "findings";

struct Sample {
  Solid solid;
  std::vector<Index> rounded;
  std::vector<Index> unclosed;
  geometry::UnusedVertices unused;
  std::string pointer;
};

/// True for findings about documents that fail (901, 904) or input that is no document (903).
bool is_about_input(int code) {
  return code == validate::kInvalidInputFile || code == validate::kWrongInputParameters ||
         code == validate::kFormatNotSupported;
}
bool is_about_groups(int code) {
  return validate::finding_level(code) == 5 || validate::finding_level(code) == 6;
}

bool is_about_indoor_models(int code) { return validate::finding_level(code) == 7; }

/// The solids of the only feature of a file, read as the program reads them.
std::vector<SubmittedSolid> read_solids(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  const auto format = formats::detect_format(path.filename().string(), as_bytes(text));
  REQUIRE(format);
  auto document = formats::read_document(as_bytes(text), *format);
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  return std::move(document->features[0].solids);
}

Sample read_sample(const std::filesystem::path& path) {
  const std::vector<SubmittedSolid> solids = read_solids(path);
  REQUIRE(solids.size() == 1);
  const SubmittedSolid& submitted = solids[0];
  return {submitted.solid, submitted.rounded, submitted.unclosed_rings, submitted.unused,
          submitted.source.pointer};
}

/// Compares a report with the expected one, or writes the latter.
void check_expected(int code, const char* suffix, const std::string& text) {
  const std::filesystem::path expected = kSamples / (std::to_string(code) + suffix);
  if (std::getenv("WATERTIGHT_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(expected, std::ios::binary) << text;
  }
  CHECK(text == read_text(expected));
}

std::filesystem::path sample_path(int code) {
  const std::string number = std::to_string(code);
  for (const char* suffix : {".city.json", ".off", ".gml", ".dxf", ".command.txt"}) {
    const std::filesystem::path path = kSamples / (number + suffix);
    if (std::filesystem::exists(path)) return path;
  }
  return {};
}

}  // namespace

TEST_CASE("every finding about a solid has a sample that shows it and an expected report") {
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    if (is_about_input(kind.code) || is_about_groups(kind.code)) continue;
    if (is_about_indoor_models(kind.code)) continue;
    INFO("finding " << kind.code);
    const std::filesystem::path path = sample_path(kind.code);
    REQUIRE_FALSE(path.empty());
    const Sample sample = read_sample(path);
    CertifyOptions options;
    options.rounded = sample.rounded;
    options.unclosed_rings = sample.unclosed;
    options.unused = sample.unused;
    options.also_tolerant = true;
    const Report report = certify(sample.solid, nullptr, options).report;
    const Finding* finding = first_finding(report, kind.code);
    REQUIRE(finding);
    CHECK(finding->severity == kind.severity);
    // A shell without volume (806) always has another finding, an error.
    const bool is_error = kind.severity == Severity::error || kind.code == validate::kZeroVolume;
    CHECK((report.verdict == Verdict::invalid) == is_error);

    validate::ReportJsonOptions json;
    json.pointer_prefix = sample.pointer;
    json.include_times = false;
    json.style = validate::JsonStyle::indented;
    check_expected(kind.code, ".report.json",
                   validate::report_json(report, sample.solid, json) + "\n");
  }
}

TEST_CASE("every finding about several solids has a sample that shows it and an expected report") {
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    if (!is_about_groups(kind.code)) continue;
    INFO("finding " << kind.code);
    REQUIRE_FALSE(sample_path(kind.code).empty());
    std::vector<Inspection> members;
    for (const SubmittedSolid& solid : read_solids(sample_path(kind.code))) {
      members.push_back(certify(solid.solid, nullptr));
      REQUIRE(members.back().certified);
    }
    std::vector<validate::GroupMember> solids;
    for (const Inspection& member : members) solids.push_back({&member.certified->solid});
    const validate::GroupReport report = validate::check_group(
        solids, validate::finding_level(kind.code) == 5 ? validate::GroupKind::composite_solid
                                                        : validate::GroupKind::building_parts);
    CHECK(report.verdict == Verdict::invalid);
    std::string text;
    for (const Finding& finding : report.findings) text += validate::finding_text(finding) + "\n";
    CHECK(std::any_of(report.findings.begin(), report.findings.end(),
                      [&](const Finding& finding) { return finding.code == kind.code; }));
    check_expected(kind.code, ".report.txt", text);
  }
}

TEST_CASE("every finding about an indoor model has a sample that shows it alone, and a report") {
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    if (!is_about_indoor_models(kind.code)) continue;
    INFO("finding " << kind.code);
    REQUIRE_FALSE(sample_path(kind.code).empty());
    const std::string text = read_text(sample_path(kind.code));
    const auto document = formats::read_document(as_bytes(text), formats::Format::gml);
    REQUIRE(document);
    std::vector<Inspection> cells;
    for (const Feature& feature : document->features) {
      REQUIRE(feature.cell == cells.size());
      cells.push_back(certify(feature.solids.at(0).solid, nullptr));
      REQUIRE(cells.back().certified);
    }
    std::vector<validate::CellSolids> solids;
    for (const Inspection& cell : cells) solids.push_back({&cell.certified->solid});
    std::string report;
    for (const auto& cell : validate::check_indoor_model(document->graph, solids)) {
      CHECK(cell.not_run.empty());
      for (const Finding& finding : cell.findings) {
        CHECK(finding.code == kind.code);
        report += validate::finding_text(finding) + "\n";
      }
    }
    CHECK_FALSE(report.empty());
    check_expected(kind.code, ".report.txt", report);
  }
}

TEST_CASE("the samples of findings about the input are refused") {
  for (const int code : {int{validate::kInvalidInputFile}, int{validate::kFormatNotSupported}}) {
    INFO("finding " << code);
    const std::filesystem::path path = sample_path(code);
    REQUIRE_FALSE(path.empty());
    const std::string text = read_text(path);
    const auto format = formats::detect_format(path.filename().string(), as_bytes(text));
    CHECK(format.has_value() == (code == validate::kInvalidInputFile));
    if (!format) continue;
    const auto document = formats::read_document(as_bytes(text), *format);
    CHECK_FALSE(document);
  }
  CHECK_FALSE(sample_path(validate::kWrongInputParameters).empty());
}

TEST_CASE("every finding says what to do about it, in one sentence") {
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    INFO("finding " << kind.code);
    CHECK_FALSE(kind.summary.empty());
    REQUIRE(kind.hint.size() > 10);
    CHECK(kind.hint.back() == '.');
    CHECK(std::count(kind.hint.begin(), kind.hint.end(), '.') == 1);
  }
}

TEST_CASE("every sample belongs to a finding") {
  for (const auto& entry : std::filesystem::directory_iterator(kSamples)) {
    INFO(entry.path());
    CHECK(validate::find_kind(std::atoi(entry.path().filename().string().c_str())) != nullptr);
  }
}

TEST_CASE("docs/findings.md describes every finding and no other") {
  const std::string text = read_text(kRoot / "docs" / "findings.md");
  std::istringstream lines(text);
  std::string line;
  std::vector<std::string> sections;
  while (std::getline(lines, line)) {
    if (line.rfind("## ", 0) == 0 && line.size() > 3 && std::isdigit(line[3]) != 0) {
      sections.push_back(line.substr(3));
    }
  }
  std::vector<std::string> expected;
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    expected.push_back(std::to_string(kind.code) + " " + std::string(kind.name));
    CHECK(text.find("tests/golden/findings/" + sample_path(kind.code).filename().string()) !=
          std::string::npos);
    const std::string figure = "figures/" + std::to_string(kind.code) + ".svg";
    CHECK(text.find("](" + figure + ")") != std::string::npos);
    CHECK(std::filesystem::exists(kRoot / "docs" / figure));
  }
  CHECK(sections == expected);
}

TEST_CASE("every figure belongs to a finding") {
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / "docs" / "figures")) {
    if (entry.path().extension() != ".svg") continue;
    INFO(entry.path());
    CHECK(validate::find_kind(std::atoi(entry.path().filename().string().c_str())) != nullptr);
  }
}

TEST_CASE("finding_name knows the table's codes only") {
  for (const validate::FindingKind& kind : validate::finding_kinds())
    CHECK(validate::finding_name(kind.code) == kind.name);
  CHECK(validate::finding_name(302) == "SHELL_NOT_CLOSED");
  CHECK(validate::finding_name(0).empty());
  CHECK(validate::finding_name(304).empty());
  CHECK(validate::finding_name(9999).empty());
}
