// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests that run the executable on small files.
#include <catch2/catch_test_macros.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/terminal/progress.h"
#include "pipeline/container.h"
#include "tests/unit/cli/fixture.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight {
namespace {

namespace fs = std::filesystem;
using test::Fixture;
using test::Ran;

const std::string kValid = samples::sequence({samples::feature("a"), samples::feature("b")});
const std::string kInvalid =
    samples::sequence({samples::feature("open", samples::kOpenFacets), samples::feature("b")});
const std::string kCubeObj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST_CASE("a progress line shows the rate, and the time left where the whole is known") {
  CHECK(cli::progress_line("a", 100, 0.5, 10) ==
        "a [###############...............] 100 features  10/s  0:10 left");
  CHECK(cli::progress_line("a", 100, 0.01, 100) ==
        "a [..............................] 100 features  1/s  2:45:00 left");
  CHECK(cli::progress_line("a", 7, std::nullopt, 2) == "a 7 features  4/s");
  CHECK(cli::progress_line("a", 0, 0.0, 0) == "a [..............................] 0 features  0/s");
}

TEST_CASE_METHOD(Fixture, "the exit status separates valid, invalid and broken input") {
  write("good.city.jsonl", kValid);
  write("bad.city.jsonl", kInvalid);
  write("broken.city.json", "{\"type\":\"CityJSON\",");
  CHECK(run("validate good.city.jsonl").status == 0);
  const Ran bad = run("validate bad.city.jsonl");
  CHECK(bad.status == 1);
  CHECK(bad.output.find("302") != std::string::npos);
  CHECK(bad.output.find("bad.city.jsonl") != std::string::npos);
  const Ran broken = run("validate broken.city.json");
  CHECK(broken.status == 2);
  CHECK(broken.output.find("broken.city.json: malformed") != std::string::npos);
  CHECK(broken.output.find("at byte") != std::string::npos);
  CHECK(run("validate missing.obj").status == 2);
  CHECK(run("validate good.city.jsonl bad.city.jsonl missing.obj").status == 2);
}

TEST_CASE_METHOD(Fixture, "options come from a file, which the program can print") {
  const std::string options =
      "serve --data-dir d --listen 10.0.0.5:80 --keys k --public-read --cors https://a.example ";
  const Ran printed = run(options + "--print-config");
  CHECK(printed.status == 0);
  CHECK(printed.output.starts_with("[serve]\n"));
  CHECK(printed.output.find("\nlisten=\"10.0.0.5:80\"\n") != std::string::npos);
  CHECK(printed.output.find("\n# open=false\n") != std::string::npos);
  write("serve.toml", printed.output);
  CHECK(run("serve --config serve.toml --print-config").output == printed.output);
  // The command line counts before the file.
  const std::string other = run("serve --config serve.toml --listen :81 --print-config").output;
  CHECK(other.find("\nlisten=\":81\"\n") != std::string::npos);
  write("open.toml", "[serve]\nlisten=\"0.0.0.0:80\"\ndata-dir=\"d\"\n");
  CHECK(run("serve --config open.toml").output.find("--open") != std::string::npos);
  write("wrong.toml", "[serve]\nlitsen=\"0.0.0.0:80\"\n");
  const Ran wrong = run("serve --data-dir d --config wrong.toml");
  CHECK(wrong.status == 2);
  CHECK(wrong.output.find("litsen") != std::string::npos);
  CHECK(run("serve --data-dir d --config missing.toml").status == 2);
}

TEST_CASE_METHOD(Fixture, "wrong usage is status 2 with a message") {
  CHECK(run("").status == 2);
  CHECK(run("fly").status == 2);
  CHECK(run("validate").status == 2);
  CHECK(run("validate --proof faith x").status == 2);
  CHECK(run("validate --planarity nan x").output.find("number from 1e-9") != std::string::npos);
  CHECK(run("encode x").status == 2);
  CHECK(run("ingest x --collection a").status == 2);
  CHECK(run("ingest x --collection a/b --data-dir d").status == 2);
  CHECK(run("serve --data-dir d --listen nowhere").status == 2);
  CHECK(run("export town -o x.wt").status == 2);
  CHECK(run("export -o x.wt --data-dir d").status == 2);
  CHECK(run("export town -o x.obj --data-dir d").output.find(".wt") != std::string::npos);
  CHECK(run("--help").status == 0);
  CHECK(run("--version").status == 0);
}

TEST_CASE_METHOD(Fixture, "output that cannot be written is status 2") {
  write("good.city.jsonl", kValid);
  CHECK(run("validate good.city.jsonl > /dev/full").status == 2);
  const Ran ran = run("encode good.city.jsonl -o - > /dev/full");
  CHECK(ran.status == 2);
}

TEST_CASE_METHOD(Fixture, "a report is written as JSON") {
  write("bad.city.jsonl", kInvalid);
  CHECK(run("validate bad.city.jsonl --report r.json").status == 1);
  const auto json = nlohmann::json::parse(read("r.json"), nullptr, false);
  REQUIRE(json.is_object());
  CHECK(json["input_file"] == "bad.city.jsonl");
  CHECK(json["verdict"] == "invalid");
  CHECK(json["all_errors"] == nlohmann::json::array({302}));
  REQUIRE(json["features"].size() == 2);
  CHECK(json["features"][0]["verdict"] == "invalid");
  CHECK(json["features"][1]["verdict"] == "valid");
}

TEST_CASE_METHOD(Fixture, "a run over several files writes a line of JSON for each file") {
  write("good.city.jsonl", kValid);
  write("bad.city.jsonl", kInvalid);
  CHECK(run("validate -q good.city.jsonl missing.obj bad.city.jsonl --report r.json").status == 2);
  std::istringstream lines(read("r.json"));
  std::vector<std::string> verdicts;
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    REQUIRE(json.is_object());
    verdicts.push_back(json["input_file"].get<std::string>() + ' ' +
                       json["verdict"].get<std::string>());
  }
  CHECK(verdicts == std::vector<std::string>{"good.city.jsonl valid", "missing.obj undecided",
                                             "bad.city.jsonl invalid"});
}

TEST_CASE_METHOD(Fixture, "equal input gives equal reports whatever the number of threads") {
  std::vector<std::string> features;
  for (int i = 0; i < 60; ++i) {
    std::string id(1, 'f');
    id += std::to_string(i);
    features.push_back(
        samples::feature(id, i % 7 == 3 ? samples::kOpenFacets : samples::kBoxFacets));
  }
  write("in.city.jsonl", samples::sequence(features));
  const std::string outputs = " --report r.json --geojson r.geojson --html r.html";
  CHECK(run("validate --no-times -j 1 in.city.jsonl" + outputs).status == 1);
  const std::string json = read("r.json");
  const std::string layer = read("r.geojson");
  const std::string page = read("r.html");
  CHECK(run("validate --no-times -j 4 in.city.jsonl" + outputs).status == 1);
  CHECK(read("r.json") == json);
  CHECK(read("r.geojson") == layer);
  CHECK(read("r.html") == page);
  CHECK(nlohmann::json::parse(layer)["features"].size() == 9);
  CHECK(page.find("302") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a line that cannot be read costs only itself") {
  write("in.city.jsonl",
        samples::sequence({samples::feature("a"), "{\"type\":", samples::feature("b")}));
  const Ran ran = run("validate in.city.jsonl --report r.json");
  CHECK(ran.status == 2);
  CHECK(ran.output.find("in.city.jsonl: malformed: line 3: ") != std::string::npos);
  const auto json = nlohmann::json::parse(read("r.json"), nullptr, false);
  REQUIRE(json.is_object());
  CHECK(json["features"].size() == 2);
  REQUIRE(json["dataset_errors"].size() == 1);
  CHECK(json["dataset_errors"][0]["code"] == 901);
}

TEST_CASE_METHOD(Fixture, "a document without solids is valid, and reported to have none") {
  write("none.city.json",
        R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
        R"("CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2",)"
        R"("boundaries":[[[0,1,2]]]}]}},"vertices":[[0,0,0],[1,0,0],[0,1,0]]})");
  const Ran ran = run("validate none.city.json --report r.json");
  CHECK(ran.status == 0);
  CHECK(ran.output.find("none.city.json: the document has no solids") != std::string::npos);
  CHECK(nlohmann::json::parse(read("r.json"))["notes"].dump().find("no solids") !=
        std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a report on standard output is alone there") {
  write("bad.city.jsonl", kInvalid);
  const Ran ran = run("validate bad.city.jsonl --report -");
  CHECK(ran.status == 1);
  CHECK(nlohmann::json::accept(ran.output));
}

TEST_CASE_METHOD(Fixture, "an interior shell of another file becomes a cavity") {
  write("cube.obj", kCubeObj);
  write("cavity.obj",
        "v .2 .2 .2\nv .8 .2 .2\nv .8 .8 .2\nv .2 .8 .2\nv .2 .2 .8\nv .8 .2 .8\nv .8 .8 .8\n"
        "v .2 .8 .8\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n");
  const std::string options = "validate cube.obj --interior-shell cavity.obj --report r.json";
  const Ran ran = run(options);
  CHECK((ran.status == 0 || ran.status == 3));  // 3: undecided in a build without engines
  CHECK(run(options + " --interior-shell cavity.obj").status == 1);
  CHECK(nlohmann::json::parse(read("r.json"))["all_errors"] == nlohmann::json::array({402}));
  write("two.city.jsonl", kValid);
  const Ran wrong = run("validate two.city.jsonl --interior-shell cavity.obj");
  CHECK(wrong.status == 2);
  CHECK(wrong.output.find("one solid each") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "an engine that is named makes every proof") {
  write("in.city.jsonl", kValid);
  CHECK(run("validate --engine guess in.city.jsonl").status == 2);
  for (const std::string engine : {"cgal", "tetgen"}) {
    const Ran ran = run("validate in.city.jsonl --report r.json --engine " + engine);
    const auto json = nlohmann::json::parse(read("r.json"), nullptr, false);
    const auto& report = json["features"][0]["primitives"][0];
    // Without the named engine the solid is undecided: no other rung may replace the engine.
    CHECK((ran.status == 0 || ran.status == 3));
    CHECK(report["rung"] == (ran.status == 3 ? "none" : engine == "cgal" ? "patch" : "tetgen"));
  }
}

TEST_CASE_METHOD(Fixture, "encode and decode return the document") {
  write("in.city.jsonl", kValid);
  REQUIRE(run("encode in.city.jsonl -o x.wt").status == 0);
  REQUIRE(run("decode x.wt -o out.city.jsonl").status == 0);
  CHECK(read("out.city.jsonl") == kValid);
  const Ran info = run("info --json x.wt");
  CHECK(info.status == 0);
  CHECK(nlohmann::json::parse(info.output)["solids"] == 2);
  CHECK(run("validate x.wt").status == 0);
  CHECK(run("encode - -o - < in.city.jsonl > y.wt").status == 0);
  CHECK(read("y.wt") == read("x.wt"));
}

/// A document that differs from kValid in its position.
std::string moved() {
  std::string text = kValid;
  return text.replace(text.find("100.0"), 5, "900.0");
}

/// A Watertight file of the documents kValid and moved().
std::string two_documents() {
  pipeline::ContainerWriter writer;
  for (const std::string& text : {kValid, moved()}) {
    auto document = formats::read_document(as_bytes(text), Format::city_json_seq);
    REQUIRE(document);
    const auto encoded = pipeline::encode_document(*std::move(document), nullptr, {});
    REQUIRE(encoded);
    for (const auto& feature : encoded->document.features) REQUIRE(writer.add(feature));
  }
  const auto file = std::move(writer).finish();
  REQUIRE(file);
  return std::string(as_text(*file));
}

TEST_CASE_METHOD(Fixture,
                 "decode writes a file for each document, and other commands refuse several") {
  write("two.wt", two_documents());
  REQUIRE(run("decode two.wt -o ./out.city.jsonl").status == 0);
  CHECK(read("out.city.jsonl") == kValid);
  CHECK(read("out-2.city.jsonl") == moved());
  CHECK(run("decode two.wt -o -").status == 2);
  const Ran refused = run("validate two.wt");
  CHECK(refused.status == 2);
  CHECK(refused.output.find("2 documents") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "encode --invalid refuse writes nothing when a solid is invalid") {
  write("in.city.jsonl", kInvalid);
  write("x.wt", "old");
  CHECK(run("encode in.city.jsonl -o x.wt --invalid refuse").status == 1);
  CHECK(read("x.wt") == "old");
  CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 2);
}

TEST_CASE_METHOD(Fixture, "encode keeps what is not proven as it came, and says so") {
  write("in.city.jsonl", kInvalid);
  const Ran kept = run("encode in.city.jsonl -o x.wt");
  CHECK(kept.status == 1);
  CHECK(kept.output.find("1 solid is kept as it came, unproven") != std::string::npos);
  const Ran info = run("info x.wt --json");
  CHECK(info.status == 0);
  CHECK(info.output.find(R"("unproven":{"features":1,"count":1,"solids":[{)") != std::string::npos);
  CHECK(info.output.find(R"("errors":[302])") != std::string::npos);
  REQUIRE(run("decode x.wt -o back.city.jsonl").status == 0);
  CHECK(read("back.city.jsonl") == kInvalid);
  CHECK(run("encode in.city.jsonl -o y.wt --bare").status == 2);
}

TEST_CASE_METHOD(Fixture, "the file of --rejected replaces no other file of the run") {
  write("in.city.jsonl", kInvalid);
  for (const std::string wrong :
       {"-o x.wt --invalid skip --rejected in.city.jsonl", "-o x.wt --invalid skip --rejected x.wt",
        "-o x.report.json --invalid skip --rejected x", "-o x.wt --rejected r.jsonl",
        "-o - --invalid skip --rejected -"}) {
    CHECK(run("encode in.city.jsonl " + wrong).status == 2);
    CHECK(read("in.city.jsonl") == kInvalid);
  }
  CHECK(run("encode in.city.jsonl -o x.wt --invalid skip --rejected r.city.jsonl").status == 1);
  CHECK(run("validate r.city.jsonl").status == 1);
  CHECK(read("r.city.jsonl.report.json").find("\"leftOut\":[{") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "advise prints a row for each number of decimals") {
  write("in.city.jsonl", kValid);
  const Ran advice = run("advise in.city.jsonl");
  CHECK(advice.status == 0);
  CHECK(advice.output.find("decimals are enough: every valid solid stays valid") !=
        std::string::npos);
  CHECK(advice.output.find("first to break") != std::string::npos);
  write("bad.city.jsonl", kInvalid);
  CHECK(run("advise bad.city.jsonl").status == 1);
  CHECK(run("advise none.city.jsonl").status == 2);
}

TEST_CASE_METHOD(Fixture, "rows are columns for COPY, whatever ids have in them") {
  // The id has a tab, a backslash and a line feed, as JSON writes them.
  const std::string text = samples::sequence({samples::feature(R"(a\tb\\c\nd)")});
  write("in.city.jsonl", text);
  const Ran rows = run("rows in.city.jsonl");
  INFO(rows.output);
  CHECK(rows.status == 0);
  CHECK(rows.output.starts_with("a\\tb\\\\c\\nd\ta\\tb\\\\c\\nd\t"));
  CHECK(rows.output.find("\t\\\\x010f0000") != std::string::npos);
  CHECK(std::ranges::count(rows.output, '\n') == 1);
  write("cut.city.jsonl", text + "{\n");
  CHECK(run("rows cut.city.jsonl").status == 1);
  CHECK(run("rows none.city.jsonl").status == 2);
}

TEST_CASE_METHOD(Fixture, "a bare blob is read as one solid") {
  write("cube.obj", kCubeObj);
  REQUIRE(run("encode cube.obj --bare -o cube.blob").status == 0);
  const Ran info = run("info cube.blob");
  CHECK(info.status == 0);
  CHECK(info.output.find("facets               6") != std::string::npos);
  CHECK(run("decode cube.blob -o cube.wkt").status == 0);
  CHECK(read("cube.wkt").find("POLYHEDRALSURFACE Z") != std::string::npos);
  CHECK(run("validate cube.wkt").status == 0);
  write("two.city.jsonl", kValid);
  CHECK(run("encode two.city.jsonl --bare -o two.blob").status == 2);
}

TEST_CASE_METHOD(Fixture, "encode can keep Steiner vertices and choose the mode") {
  write("cube.obj", kCubeObj);
  CHECK(run("encode cube.obj --mode raw -o a.wt").status == 0);
  CHECK(run("encode cube.obj --mode bitmap -o b.wt").status == 0);
  CHECK(run("encode cube.obj --steiner -o c.wt").status == 0);
  CHECK(run("encode cube.obj --mode fancy -o d.wt").status == 2);
}

TEST_CASE_METHOD(Fixture, "convert follows the ending of the output") {
  write("cube.obj", kCubeObj);
  CHECK(run("convert cube.obj -o cube.off").status == 0);
  CHECK(read("cube.off").starts_with("OFF"));
  CHECK(run("validate cube.off").status == 0);
  const Ran unknown = run("convert cube.obj -o cube.xyz");
  CHECK(unknown.status == 2);
  CHECK(unknown.output.find(".obj") != std::string::npos);
  CHECK(run("convert cube.obj -o no/such/folder.off").status == 2);
}

TEST_CASE_METHOD(Fixture, "an error in a blob is reported, whatever the file is called") {
  write("cube.obj", kCubeObj);
  REQUIRE(run("encode cube.obj --bare -o cube.blob").status == 0);
  const std::string whole = read("cube.blob");
  write("short.json", whole.substr(0, whole.size() - 1));
  std::string later = whole;
  later[2] = 2;
  write("later.wkt", later);
  for (const std::string command : {"decode ", "convert ", "encode "}) {
    const Ran refused = run(command + "short.json -o y.wkt");
    CHECK(refused.status == 2);
    CHECK(refused.output.find("checksum does not match") != std::string::npos);
  }
  CHECK(run("validate later.wkt").output.find("format version 2") != std::string::npos);
  write("pages", "WTPF\x01 and so on");
  CHECK(run("info pages").output.find("a page file") != std::string::npos);
  CHECK(run("decode pages -o y.wkt").output.find("a page file") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a run that is killed leaves nothing behind") {
  const std::string script = "cd " + folder.string() + " && mkfifo in.city.jsonl && { " +
                             test::program_path("watertight") +
                             " validate in.city.jsonl --report r.json & p=$!; sleep 0.3; "
                             "kill -9 $p; wait $p; } 2>/dev/null";
  CHECK(std::system(("bash -c '" + script + "'").c_str()) != 0);
  CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
}

TEST_CASE_METHOD(Fixture, "an output behind a link is written there") {
  write("cube.obj", kCubeObj);
  write("old.off", "old");
  fs::create_symlink("old.off", folder / "link.off");
  CHECK(run("convert cube.obj -o link.off").status == 0);
  CHECK(fs::is_symlink(folder / "link.off"));
  CHECK(read("old.off").starts_with("OFF"));
  // A link leads to a file that does not exist yet; two others lead to each other.
  fs::create_symlink("new.off", folder / "early.off");
  CHECK(run("convert cube.obj -o early.off").status == 0);
  CHECK(fs::is_symlink(folder / "early.off"));
  CHECK(read("new.off").starts_with("OFF"));
  fs::create_symlink("b.off", folder / "a.off");
  fs::create_symlink("a.off", folder / "b.off");
  CHECK(run("convert cube.obj -o a.off").status == 2);
  CHECK(fs::is_symlink(folder / "a.off"));
}

TEST_CASE_METHOD(Fixture, "an output does not replace its own input") {
  write("cube.obj", kCubeObj);
  fs::create_symlink("cube.obj", folder / "link.obj");
  REQUIRE(run("encode cube.obj -o packed.obj").status == 0);
  const std::string packed = read("packed.obj");
  for (const std::string arguments :
       {"encode cube.obj -o cube.obj --contract boundary", "convert cube.obj -o ./cube.obj",
        "convert link.obj -o cube.obj", "decode packed.obj -o packed.obj"}) {
    const Ran refused = run(arguments);
    CHECK(refused.status == 2);
    CHECK(refused.output.find("would replace the input") != std::string::npos);
  }
  CHECK(read("cube.obj") == kCubeObj);
  CHECK(read("packed.obj") == packed);
}

TEST_CASE_METHOD(Fixture, "decode writes each of several documents, or none") {
  const std::string file = two_documents();
  write("both.wt", file);
  CHECK(run("info both.wt").output.find("documents            2") != std::string::npos);
  CHECK(run("decode both.wt -o .jsonl").status == 0);
  CHECK(fs::exists(folder / "-2.jsonl"));
  // The second output would replace the input, a link to the input, or a folder.
  write("in-2.city.jsonl", file);
  fs::create_symlink("in-2.city.jsonl", folder / "link-2.city.jsonl");
  fs::create_directory(folder / "taken-2.city.jsonl");
  write("taken.city.jsonl", "old");
  for (const std::string name : {"in", "link", "taken"}) {
    CHECK(run("decode in-2.city.jsonl -o " + name + ".city.jsonl").status == 2);
  }
  CHECK(read("in-2.city.jsonl") == file);
  CHECK(read("taken.city.jsonl") == "old");
  CHECK_FALSE(fs::exists(folder / "in.city.jsonl"));
}

TEST_CASE_METHOD(Fixture, "a document without solids is not written where only solids are") {
  write("none.city.jsonl", samples::sequence({}));
  for (const std::string name : {"x.obj", "x.off", "x.wkt", "x.wkb"}) {
    const Ran refused = run("convert none.city.jsonl -o " + name);
    CHECK(refused.status == 2);
    CHECK(refused.output.find("there is no solid to write") != std::string::npos);
    CHECK_FALSE(fs::exists(folder / name));
  }
}

TEST_CASE_METHOD(Fixture, "findings do not mix with a file on standard output") {
  write("bad.city.jsonl", kInvalid);
  run("encode bad.city.jsonl --invalid refuse -o - 2>errors.txt | cat >out.wt");
  CHECK(read("out.wt").empty());
  CHECK(read("errors.txt").find("error 302") != std::string::npos);
  run("encode bad.city.jsonl -o - 2>errors.txt | cat >out.wt");
  CHECK(run("decode out.wt -o back.city.jsonl").status == 0);
  CHECK(read("errors.txt").find("error 302") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "encode reports coordinates that had to be rounded") {
  std::string fine = kCubeObj;
  for (const std::string corner : {"v 0 0 1", "v 1 0 1", "v 1 1 1", "v 0 1 1"}) {
    fine.replace(fine.find(corner), corner.size(), corner + ".12345678901234567890123456789");
  }
  write("fine.obj", fine);
  const Ran encoded = run("encode fine.obj -o fine.wt");
  CHECK(encoded.status == 0);
  CHECK(encoded.output.find("warning 805") != std::string::npos);
  write("cube.obj", kCubeObj);
  CHECK(run("encode cube.obj -o cube.wt").output.empty());
}

// The user `watertight`, which root becomes, must be able to enter the folder.
class StoreFixture : public Fixture {
 public:
  StoreFixture() { fs::permissions(folder, fs::perms::all); }
  Ran on_store(const std::string& arguments) const { return run(arguments + " --data-dir data"); }
};

TEST_CASE_METHOD(StoreFixture, "ingest takes more files than may be open, and exports come back") {
  constexpr int kFiles = 300;
  std::string names;
  for (int i = 0; i < kFiles; ++i) {
    const std::string id = std::string("f").append(std::to_string(i));
    std::string text = samples::sequence({samples::feature(id)});
    // Three documents: each has a header of its own.
    if (i % 3 != 0)
      text.replace(text.find("0.001,0.001"), 11, i % 3 == 1 ? "0.002,0.001" : "0.003,0.001");
    write(id + ".jsonl", text);
    names += " " + id + ".jsonl";
  }
  const Ran stored =
      run("--version >/dev/null; ulimit -n 280; " + test::program_path("watertight") +
          " ingest -q --collection town --data-dir data" + names);
  INFO(stored.output);
  REQUIRE(stored.status == 0);
  CHECK(stored.output.find("features stored                                      300") !=
        std::string::npos);
  fs::create_directory(folder / "out");
  fs::permissions(folder / "out", fs::perms::all);
  REQUIRE(on_store("export town -o out/town.wt").status == 0);
  const Ran back = on_store("ingest -q --collection copy out/town.wt");
  INFO(back.output);
  REQUIRE(back.status == 0);
  REQUIRE(on_store("export copy -o out/copy.wt").status == 0);
  CHECK(read("out/copy.wt") == read("out/town.wt"));

  CHECK(on_store("collections list").output.find("copy: 300 features, 300 solids, ") == 0);
  CHECK(on_store("collections rename copy town").status == 2);
  CHECK(on_store("collections rename copy other").status == 0);
  const Ran counted = on_store("collections recount other --json");
  CHECK(nlohmann::json::parse(counted.output)["features"] == kFiles);
  CHECK(on_store("collections delete other").status == 0);
  CHECK(on_store("collections delete other").status == 2);
  const Ran left = on_store("collections list");
  CHECK(left.output.find("other") == std::string::npos);
  CHECK(left.output.find("town: 300 features") == 0);
  CHECK(run("collections delete --data-dir data").status == 2);
  CHECK(run("collections list").status == 2);
}

TEST_CASE_METHOD(StoreFixture, "ingest writes what it leaves out as sequences, with a report") {
  const std::string bad = samples::feature("bad", samples::kOpenFacets);
  const std::string worse = samples::feature("worse", samples::kOpenFacets);
  write("a.jsonl", samples::sequence({samples::feature("good"), bad}));
  std::string other = samples::sequence({worse});
  other.replace(other.find("0.001,0.001"), 11, "0.002,0.001");
  write("b.jsonl", other);
  write("good.jsonl", samples::sequence({samples::feature("best")}));
  CHECK(on_store("ingest -q good.jsonl --collection town --invalid skip --rejected no.jsonl")
            .status == 0);
  CHECK_FALSE(fs::exists(folder / "no.jsonl"));
  CHECK_FALSE(fs::exists(folder / "no.jsonl.report.json"));
  const Ran stored =
      on_store("ingest -q a.jsonl b.jsonl --collection town --invalid skip --rejected left.jsonl");
  INFO(stored.output);
  CHECK(stored.status == 1);
  const std::string first = read("a.jsonl");
  // The header of the document, then a line for each feature that is left out.
  const auto check_left_out = [](const std::string& text, const std::string& document,
                                 const std::string& id) {
    const std::size_t line = text.find('\n') + 1;
    CHECK(text.substr(0, line) == document.substr(0, document.find('\n') + 1));
    CHECK(nlohmann::json::parse(text.substr(line))["id"] == id);
  };
  check_left_out(read("left.jsonl"), first, "bad");
  check_left_out(read("left-2.jsonl"), other, "worse");
  const auto report = nlohmann::json::parse(read("left.jsonl.report.json"));
  CHECK(report["stored"] == 1);
  CHECK(report["counts"]["features"] == 3);
  REQUIRE(report["features"].size() == 2);
  CHECK(report["features"][1]["id"] == "worse");
  CHECK(on_store("collections list").output.find("town: 2 features") == 0);
  CHECK(on_store("ingest a.jsonl --collection town --rejected left.jsonl").status == 2);
  CHECK(on_store("ingest a.jsonl --collection town --invalid skip --rejected a.jsonl").status == 2);
  CHECK(read("a.jsonl") == first);
}

TEST_CASE_METHOD(Fixture, "damaged Watertight files are refused") {
  write("in.city.jsonl", kValid);
  REQUIRE(run("encode in.city.jsonl -o x.wt").status == 0);
  const std::string whole = read("x.wt");
  write("short.wt", whole.substr(0, whole.size() / 2));
  CHECK(run("decode short.wt -o y.city.jsonl").status == 2);
  CHECK(run("info short.wt").status == 2);
  CHECK_FALSE(fs::exists(folder / "y.city.jsonl"));
}

}  // namespace
}  // namespace watertight
