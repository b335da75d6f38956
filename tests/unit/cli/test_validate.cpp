// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests of `watertight validate` on small files: its text, its exit status and its baseline.
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/findings/baseline.h"
#include "cli/findings/explain.h"
#include "cli/findings/finding_list.h"
#include "cli/terminal/progress.h"
#include "tests/unit/cli/fixture.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight {
namespace {

using test::Fixture;
using test::Ran;

const std::string kSurface =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
    R"("CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2",)"
    R"("boundaries":[[[0,1,2]]]}]}},"vertices":[[0,0,0],[1,0,0],[0,1,0]]})";
/// The box with a facet that has a point twice in a row: two errors.
constexpr std::string_view kDoubledFacets =
    "[[[0,3,2,1,1]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]";

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_CASE_METHOD(Fixture, "a file without solids is status 1 where solids are required") {
  write("none.city.json", kSurface);
  const Ran allowed = run("validate --surfaces ignore none.city.json");
  CHECK(allowed.status == 0);
  CHECK(allowed.output.find("Nothing was checked: there are no solids.") != std::string::npos);
  CHECK(count_of(allowed.output, "without solids: nothing was checked") == 2);
  const Ran required = run("validate --surfaces ignore --require-solids none.city.json");
  CHECK(required.status == 1);
  CHECK(required.output.find("none.city.json: nothing was checked") != std::string::npos);
  write("good.city.jsonl", samples::sequence({samples::feature("a")}));
  CHECK(run("validate --require-solids good.city.jsonl").status == 0);
  const Ran both =
      run("validate --surfaces ignore --require-solids good.city.jsonl none.city.json");
  CHECK(both.status == 1);
  CHECK(both.output.find("Nothing was checked in 1 file of 2, which has no solids.") !=
        std::string::npos);
}

TEST_CASE_METHOD(Fixture, "the summary tells of checked surfaces in a file without solids") {
  write("none.city.json", kSurface);
  const Ran ran = run("validate none.city.json");
  CHECK(ran.status == 0);
  CHECK(ran.output.find("There are no solids; rings and facets of 1 surface were checked.") !=
        std::string::npos);
  CHECK(count_of(ran.output, "without solids: surfaces were checked") == 2);
  CHECK(count_of(ran.output, "nothing was checked") == 0);
  const Ran required = run("validate --require-solids none.city.json");
  CHECK(required.status == 1);
  CHECK(required.output.find("none.city.json: only surfaces were checked") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "the option --surfaces decides what a bad ring of a surface is") {
  std::string bad = kSurface;
  bad.replace(bad.find("[[[0,1,2]]]"), 11, "[[[0,1,1,2]]]");
  write("bad.city.json", bad);
  const std::string finding = " 102 CONSECUTIVE_POINTS_SAME in a (LoD 2), MultiSurface, facet 0";
  const Ran checked = run("validate bad.city.json");
  CHECK(checked.status == 0);
  CHECK(checked.output.find("warning" + finding) != std::string::npos);
  const Ran judged = run("validate --surfaces judge bad.city.json");
  CHECK(judged.status == 1);
  CHECK(judged.output.find("error" + finding) != std::string::npos);
  CHECK(judged.output.find("1 feature invalid, 0 undecided.") != std::string::npos);
  CHECK(run("validate --surfaces ignore bad.city.json").output.find("102") == std::string::npos);
  CHECK(run("validate --surfaces solids bad.city.json").status == 2);
}

TEST_CASE_METHOD(Fixture, "closed surfaces are offered as solids, coded and converted as solids") {
  const std::string source =
      test::read_text(test::source_path("tests/data/cityjson/surfaces.city.json"));
  write("s.city.json", source);
  const Ran checked = run("validate s.city.json");
  CHECK(checked.status == 0);
  CHECK(checked.output.find("closed: would be a valid solid  ") != std::string::npos);
  CHECK(checked.output.find("solids                                                 1\n") !=
        std::string::npos);
  const Ran solids = run("validate --surfaces as-solids s.city.json");
  CHECK(solids.status == 1);
  CHECK(solids.output.find("307") != std::string::npos);
  CHECK(run("encode --surfaces as-solids s.city.json -o s.wt").status == 1);
  CHECK(run("decode s.wt -o back.city.json").status == 0);
  CHECK(read("back.city.json") == source);
  const Ran converted = run("convert --surfaces as-solids s.city.json -o c.city.json");
  CHECK(converted.status == 0);
  CHECK(converted.output.find("2 closed surfaces are solids") != std::string::npos);
  const Ran again = run("validate --surfaces ignore c.city.json");
  CHECK(again.output.find("solids                                                 3\n") !=
        std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a file that cannot be read is in the summary") {
  const Ran ran = run("validate missing.obj");
  CHECK(ran.status == 2);
  CHECK(ran.output.find("\nNothing was checked.\n1 file could not be read.\n") !=
        std::string::npos);
}

TEST_CASE_METHOD(Fixture, "the text begins with the summary and has the worst features first") {
  write("in.city.jsonl",
        samples::sequence({samples::feature("good"), samples::feature("one", samples::kOpenFacets),
                           samples::feature("two", kDoubledFacets)}));
  const Ran ran = run("validate -j 3 in.city.jsonl");
  CHECK(ran.status == 1);
  CHECK(ran.output.starts_with("2 features of 3 are invalid.\n"));
  CHECK(ran.output.find("\n  invalid                                              2\nsolids") !=
        std::string::npos);
  const auto table = ran.output.find("features  ");
  const auto worst = ran.output.find("in.city.jsonl: two: invalid, 2 errors\n");
  const auto other = ran.output.find("in.city.jsonl: one: invalid, 1 error\n");
  REQUIRE(worst != std::string::npos);
  REQUIRE(other != std::string::npos);
  CHECK(table < worst);
  CHECK(worst < other);
  CHECK(ran.output.find("\n  error 302 SHELL_NOT_CLOSED in one (LoD 2.2), facet ") !=
        std::string::npos);
  CHECK(ran.output.find(", at 10") != std::string::npos);
  CHECK(ran.output.find(" (4 edges, limit 0)\n") != std::string::npos);
  CHECK(run("validate -q in.city.jsonl").output.find("error 302") == std::string::npos);
}

TEST_CASE("features are listed by urgency, then by errors, then in their order") {
  cli::FindingList list(4);
  const auto add = [&](const std::string& head, cli::Urgency worst, std::size_t errors) {
    list.add({head, {"line of " + head}, worst, errors});
  };
  add("warning", cli::Urgency::warning, 0);
  add("known", cli::Urgency::known_error, 0);
  add("one", cli::Urgency::error, 1);
  add("two", cli::Urgency::error, 2);
  add("first", cli::Urgency::undecided, 0);
  list.add({"nothing", {}, cli::Urgency::rest, 0});
  CHECK(list.text() ==
        "two\n  line of two\none\n  line of one\nfirst\n  line of first\nwarning\n"
        "  line of warning\n1 more line is not shown; --report and --csv have all findings\n");
}

TEST_CASE("a progress line is cut to the width of the terminal") {
  const std::string rest = " [###] 7 features  4/s";
  CHECK(cli::fit_to_width("", "model.city.json", rest, 80) == "model.city.json" + rest);
  CHECK(cli::fit_to_width("file 3 of 41", "folder/model.city.json", rest, 80) ==
        "file 3 of 41  folder/model.city.json" + rest);
  CHECK(cli::fit_to_width("", "folder/model.city.json", rest, 36) ==
        "\xE2\x80\xA6"
        "del.city.json" +
            rest);
  // Below its last 12 characters a name is not cut; the end of the line is.
  CHECK(cli::fit_to_width("", "folder/model.city.json", rest, 20) ==
        "\xE2\x80\xA6"
        "l.city.json [###] 7");
  CHECK(cli::fit_to_width("", "高高高高", "", 3) == "高高高");
}

TEST_CASE_METHOD(Fixture, "known findings of a baseline do not fail a run, new ones do") {
  const std::string known = samples::feature("known", samples::kOpenFacets);
  write("in.city.jsonl", samples::sequence({known, samples::feature("b")}));
  CHECK(run("validate in.city.jsonl --report old.json").status == 1);
  const Ran same = run("validate ./in.city.jsonl --baseline old.json");
  CHECK(same.status == 0);
  CHECK(same.output.find("0 new findings, 1 known, 0 gone") != std::string::npos);
  CHECK(same.output.find("[known]") != std::string::npos);
  // Another order, and another feature that is wrong.
  write("in.city.jsonl", samples::sequence({samples::feature("new", samples::kOpenFacets), known}));
  const Ran more = run("validate in.city.jsonl --baseline old.json");
  CHECK(more.status == 1);
  CHECK(more.output.find("1 new finding, 1 known, 0 gone") != std::string::npos);
  CHECK(more.output.find("in.city.jsonl: new: invalid, 1 error\n") <
        more.output.find("in.city.jsonl: known: invalid, 1 known finding\n"));
  // The defect is mended.
  write("in.city.jsonl", samples::sequence({samples::feature("known"), samples::feature("b")}));
  const Ran mended = run("validate in.city.jsonl --baseline old.json");
  CHECK(mended.status == 0);
  CHECK(mended.output.find("0 new findings, 0 known, 1 gone") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a second finding like a known one is new") {
  const std::string object = samples::feature("a", samples::kOpenFacets);
  write("in.city.jsonl", samples::sequence({object}));
  CHECK(run("validate in.city.jsonl --report old.json").status == 1);
  write("in.city.jsonl", samples::sequence({object, object}));
  const Ran twice = run("validate in.city.jsonl --baseline old.json");
  CHECK(twice.status == 1);
  CHECK(twice.output.find("1 new finding, 1 known, 0 gone") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a baseline that is no report is an error, and is never replaced") {
  write("in.city.jsonl", samples::sequence({samples::feature("a")}));
  for (const std::string text :
       {"", "{", "[]", "{\"type\":\"other\"}",
        R"({"type":"val3dity_report","schema":1,"input_file":"a","features":[]})",
        R"({"type":"val3dity_report","schema":2,"features":[{"errors":[{"code":302}]}]})",
        R"({"type":"val3dity_report","schema":2,"features":[7]})"}) {
    INFO(text);
    write("old.json", text);
    const Ran ran = run("validate in.city.jsonl --baseline old.json");
    CHECK(ran.status == 2);
    CHECK(ran.output.find("old.json: ") != std::string::npos);
  }
  CHECK(run("validate in.city.jsonl --baseline missing.json").status == 2);
  CHECK(run("validate in.city.jsonl --report old.json").status == 0);
  const std::string old = read("old.json");
  CHECK(run("validate in.city.jsonl --baseline old.json --report old.json").status == 2);
  CHECK(read("old.json") == old);
}

TEST_CASE("a baseline nested deeply is refused") {
  const std::string open(1'000'000, '[');
  CHECK_FALSE(cli::Baseline::read(as_bytes(open)));
  const std::string whole = open + std::string(open.size(), ']');
  CHECK_FALSE(cli::Baseline::read(as_bytes(whole)));
  const std::string inside = R"({"type":"val3dity_report","schema":2,"features":)" + whole + "}";
  CHECK_FALSE(cli::Baseline::read(as_bytes(inside)));
}

TEST_CASE("the lines of a feature with a very long name are short") {
  pipeline::FeatureOutcome feature;
  feature.verdict = Verdict::invalid;
  feature.solids.resize(1);
  feature.solids[0].source.object_id.assign(1'000'000, 'x');
  feature.solids[0].report.findings.resize(1);
  feature.solids[0].report.findings[0].code = 302;
  const cli::FeatureLines lines = cli::lines_of("a", feature);
  REQUIRE(lines.lines.size() == 2);  // the finding, and that the solid is undecided
  for (const std::string& line : lines.lines) CHECK(line.size() < 1000);
}

TEST_CASE("findings that a solid has beyond the limit are new where the baseline has fewer") {
  const std::string report =
      R"({"type":"val3dity_report","schema":2,"input_file":"a","features":[],"findings_omitted":7})";
  const auto baseline = cli::Baseline::read(as_bytes(report));
  REQUIRE(baseline);
  CHECK(baseline->newly_omitted("a", 7) == 0);
  CHECK(baseline->newly_omitted("./a", 9) == 2);
  CHECK(baseline->newly_omitted("b", 9) == 9);
}

TEST_CASE_METHOD(Fixture, "the snap distance of the tolerant verdict is given in metres") {
  // A corner of the top is 5 mm off in one of its facets.
  write("in.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 1.005 1 1\n"
        "f 1 4 3 2\nf 5 6 9 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const std::string row = "  valid when snapped (--tolerant)" + std::string(22, ' ');
  const Ran small = run("validate in.obj --tolerant 0.001 --report r.json");
  CHECK(small.status == 1);
  CHECK(small.output.find(row + "0\n") != std::string::npos);
  CHECK(nlohmann::json::parse(read("r.json"))["parameters"]["tolerant_snap_tol"] == 0.001);
  const Ran large = run("validate in.obj --tolerant 0.01 --report r.json");
  CHECK(large.status == 1);
  CHECK(large.output.find(row + "1\n") != std::string::npos);
  CHECK(run("validate in.obj --tolerant").status == 2);
  CHECK(run("validate --tolerant in.obj").status == 2);
  CHECK(run("validate --tolerant 0 in.obj").status == 2);
}

TEST_CASE_METHOD(Fixture, "tables and logs are written beside the other reports") {
  write("bad.city.jsonl", samples::sequence({samples::feature("a", samples::kOpenFacets)}));
  CHECK(run("validate bad.city.jsonl --csv r.csv --sarif r.sarif").status == 1);
  CHECK(read("r.csv").starts_with("file,feature,object,"));
  CHECK(count_of(read("r.csv"), "\r\n") == 2);
  const auto sarif = nlohmann::json::parse(read("r.sarif"), nullptr, false);
  REQUIRE(sarif.is_object());
  const auto& place = sarif["runs"][0]["results"][0]["locations"][0]["physicalLocation"];
  CHECK(place["artifactLocation"]["uri"] == "bad.city.jsonl");
  CHECK(place["region"]["startLine"] == 2);
  const Ran alone = run("validate bad.city.jsonl --csv -");
  CHECK(alone.output.starts_with("file,feature,object,"));
  CHECK(alone.output.find("seconds") == std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a finding is explained by its code or its name") {
  const Ran ran = run("validate --explain 302");
  CHECK(ran.status == 0);
  CHECK(ran.output.starts_with("302 SHELL_NOT_CLOSED (error): a shell has open edges\n"));
  for (const std::string part : {"\nMeaning ", "\nCause ", "\nRemedy ", "docs/figures/302.svg"}) {
    CHECK(ran.output.find(part) != std::string::npos);
  }
  CHECK(run("validate --explain shell_not_closed").output == ran.output);
  const Ran unknown = run("validate --explain 999");
  CHECK(unknown.status == 2);
  CHECK(unknown.output.find("101 102") != std::string::npos);
  CHECK(run("validate --explain 302 in.obj").status == 2);
  std::istringstream lines(ran.output);
  for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 100);
}

}  // namespace
}  // namespace watertight
