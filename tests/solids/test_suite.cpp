// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the suite of solids whose truth is known by construction, through the library and as files:
// the files of tests/golden/solids must equal the builders' solids, and expected.csv their
// statements. With WATERTIGHT_UPDATE_GOLDEN set in the environment the files are written, not
// compared.
#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "formats/document.h"
#include "tests/files.h"
#include "tests/solids/builders.h"
#include "tests/solids/defects.h"
#include "tests/solids/suite.h"
#include "validate/certify.h"

using namespace watertight;
using namespace watertight::solids;

namespace {

const std::filesystem::path kGolden = test::source_path("tests/golden/solids");

delaunay::EngineWorkers& engines() {
  static delaunay::EngineWorkers workers;
  return workers;
}

Report report_of(const Solid& solid, Ask ask) {
  CertifyOptions options;
  if (ask == Ask::boundary) options.proof = Proof::boundary;
  return certify(solid, ask == Ask::engines ? &engines() : nullptr, options).report;
}

std::string text_of(const std::set<int>& codes) {
  std::string text;
  for (const int code : codes) {
    if (!text.empty()) text += ' ';
    text += std::to_string(code);
  }
  return text;
}

Solid read_solid(const std::string& text, Format format) {
  const auto document = formats::read_document(as_bytes(text), format);
  REQUIRE(document);
  REQUIRE(document->features.size() == 1);
  REQUIRE(document->features[0].solids.size() == 1);
  return document->features[0].solids[0].solid;
}

void check(const SuiteCase& truth, const Report& report) {
  CHECK(codes_of(report, Severity::error) == truth.errors);
  CHECK(codes_of(report, Severity::warning) == truth.warnings);
  CHECK(report.verdict == truth.verdict());
}

/// True for a solid that has a golden file: one that CityJSON can hold, except a large one.
bool has_file(const SuiteCase& truth) {
  return truth.solid.lattice().kind == LatticeKind::decimal && truth.name != "chazelle-20";
}

std::string_view proof_of(Ask ask) {
  return ask == Ask::boundary ? "boundary" : "tetrahedralization";
}

void compare_golden(const std::filesystem::path& path, const std::string& text) {
  if (std::getenv("WATERTIGHT_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(path, std::ios::binary) << text;
  }
  CHECK(test::read_text(path) == text);
}

}  // namespace

TEST_CASE("every solid of the suite gets the verdict and the codes it was built for") {
  for (const SuiteCase& truth : suite()) {
    INFO(truth.name);
    check(truth, report_of(truth.solid, truth.ask));
  }
}

TEST_CASE("the suite's files are what the builders make, and give the same verdicts when read") {
  std::string table = "file,verdict,errors,warnings,proof\n";
  std::set<std::string> names;
  for (const SuiteCase& truth : suite()) {
    INFO(truth.name);
    CHECK(names.insert(truth.name).second);
    if (!has_file(truth)) continue;
    const std::string text = city_json_text(truth.solid);
    const std::string file = truth.name + ".city.json";
    compare_golden(kGolden / file, text);
    table += file + "," + std::string(validate::to_string(truth.verdict())) + "," +
             text_of(truth.errors) + "," + text_of(truth.warnings) + "," +
             std::string(proof_of(truth.ask)) + "\n";
    const Solid solid = read_solid(text, Format::city_json);
    // The test above checks the engines' verdicts; here the exact tests alone check the solid of
    // the file.
    const bool is_decided = truth.ask == Ask::engines;
    if (!is_decided || solid.shell_count() == 1) {
      check(truth, report_of(solid, is_decided ? Ask::boundary : truth.ask));
    }
  }
  compare_golden(kGolden / "expected.csv", table);
}

TEST_CASE("every injected defect gives exactly its codes, whatever the order and the sizes") {
  Random random(11);
  for (const DefectMaker& make : defect_makers()) {
    for (int round = 0; round < 4; ++round) {
      const Defect defect = make(random);
      INFO(defect.name);
      const Solid solid = rewritten(solid_of(defect.shape, millimetres()), random).solid;
      const Report report =
          report_of(solid, defect.needs_tetrahedra ? Ask::engines : Ask::rung_zero);
      CHECK(codes_of(report, Severity::error) == defect.codes);
      CHECK(report.first_level == std::vector<int>{defect.first_level});
    }
  }
}

TEST_CASE("a dent whose tip lies on the opposite sloped facet is found in 200 of 200 files") {
  // With this transform, computing the coordinates in doubles would lose the contact.
  Lattice lattice = millimetres();
  lattice.origin = {GridNumber{84616468, -3}, GridNumber{447422301, -3}, GridNumber{-2517, -3}};
  Random random(21);
  int found = 0;
  int valid = 0;
  for (int instance = 0; instance < 200; ++instance) {
    for (const Tip tip : {Tip::on_floor, Tip::above_floor}) {
      const std::string text = city_json_text(solid_of(dented_block(random, tip), lattice));
      const Report report = report_of(read_solid(text, Format::city_json), Ask::boundary);
      const std::set<int> codes = codes_of(report, Severity::error);
      if (tip == Tip::on_floor && codes == std::set<int>{306}) ++found;
      if (tip == Tip::above_floor && report.verdict == Verdict::valid) ++valid;
    }
  }
  CHECK(found == 200);
  CHECK(valid == 200);
}

TEST_CASE("a facet with 10,000 holes is valid, and one hole too many is found") {
  Shell shell = box({0, 0, 0}, {401, 401, 10});
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      const double x = 4.0 * i + 1, y = 4.0 * j + 1;
      const Ring rim{{x, y, 10}, {x + 2, y, 10}, {x, y + 2, 10}};
      const Point bottom{x, y, 5};
      shell[1].push_back(reversed(rim));
      for (std::size_t k = 0; k < 3; ++k) shell.push_back({{rim[k], rim[(k + 1) % 3], bottom}});
    }
  }
  CHECK(report_of(solid_of({shell}), Ask::boundary).verdict == Verdict::valid);
  shell[1].push_back({{1, 1, 10}, {1, 3, 10}, {3, 1, 10}});
  const std::set<int> codes =
      codes_of(report_of(solid_of({shell}), Ask::boundary), Severity::error);
  CHECK(codes == std::set<int>{202, 303});
}

TEST_CASE("Chazelle's polyhedron with 20 notches is undecided in too little time, never invalid") {
  const Solid solid = solid_of({chazelle(20)});
  CertifyOptions options;
  options.ladder.seconds_per_rung = 0.05;
  const Report report = certify(solid, &engines(), options).report;
  CHECK(report.verdict != Verdict::invalid);
  CHECK((report.verdict == Verdict::undecided) == !report.undecided_reason.empty());
}

TEST_CASE("polyhedra of Chazelle are proven without an engine") {
  for (const int notches : {1, 2, 3, 5}) {
    INFO(notches);
    const Report report = certify(solid_of({chazelle(notches)}), nullptr, {}).report;
    CHECK(report.verdict == Verdict::valid);
    REQUIRE_FALSE(report.attempts.empty());
    CHECK(report.attempts.back().rung == delaunay::Rung::recovered);
  }
}

TEST_CASE("facets that could follow the same Delaunay face are proven without an engine") {
  const Solid solid = read_solid(test::read_text(test::source_path(
                                     "tests/data/solids/facets_that_share_a_triangle.city.json")),
                                 Format::city_json);
  const Report report = certify(solid, nullptr, {}).report;
  CHECK(report.verdict == Verdict::valid);
  REQUIRE_FALSE(report.attempts.empty());
  CHECK(report.attempts.back().rung == delaunay::Rung::recovered);
}
