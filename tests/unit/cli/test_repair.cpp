// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/files.h"
#include "tests/unit/cli/fixture.h"

namespace watertight::test {
namespace {

using Json = nlohmann::ordered_json;

const std::string kInvalid = test::source_path("examples/invalid.city.jsonl");

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST_CASE_METHOD(Fixture, "repair mends six of the eleven samples, and says how") {
  const Ran ran =
      run("repair " + kInvalid + " -o mended.city.jsonl --remedies all --report r.json");
  CHECK(ran.status == 1);
  for (const char* part : {"open-box LoD 1.2: repaired: fill (1 facet of 80.000 m2 added)",
                           "flipped-facet LoD 1.2: repaired: orientation (1 facet turned)",
                           "warped-roof LoD 1.2: repaired: facets",
                           "shared-edge LoD 1.2: not repaired: 303 NON_MANIFOLD_CASE",
                           "  repaired                                           6"}) {
    CHECK(ran.output.find(part) != std::string::npos);
  }
  const Json report = Json::parse(read("r.json"));
  CHECK(report["repairs"] == Json({{"repaired", 6}, {"left", 5}}));
  CHECK(report["parameters"]["remedies"] == "rings,orientation,junctions,weld,facets,fill");
  const Json& box = report["features"][0]["primitives"][0];
  CHECK(box["verdict"] == "valid");
  CHECK(box["repair"]["area_added"] == 80.0);
  CHECK(box["repair"]["codes_before"] == Json({302}));
  CHECK(run("validate -q mended.city.jsonl").output.find("5 features of 11 are invalid") !=
        std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a hole in a mesh gets a smooth patch, and its surface a file") {
  // A cube of 6 x 6 squares a side without four of them in the middle of its upper side.
  std::string text;
  std::map<std::array<int, 3>, int> number_of;
  std::vector<std::array<int, 3>> places;
  std::string facets;
  const auto number = [&](const std::array<int, 3>& place) {
    const auto [found, is_new] = number_of.emplace(place, static_cast<int>(places.size()) + 1);
    if (is_new) places.push_back(place);
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int level : {0, 6}) {
      for (int a = 0; a < 6; ++a) {
        for (int b = 0; b < 6; ++b) {
          if (axis == 2 && level == 6 && a / 2 == 1 && b / 2 == 1) continue;
          std::array<int, 4> corners{};
          for (std::size_t i = 0; i < 4; ++i) {
            std::array<int, 3> place{};
            place[static_cast<std::size_t>(axis)] = level;
            place[static_cast<std::size_t>((axis + 1) % 3)] = a + (i == 1 || i == 2 ? 1 : 0);
            place[static_cast<std::size_t>((axis + 2) % 3)] = b + (i >= 2 ? 1 : 0);
            corners[i] = number(place);
          }
          if (level == 0) std::ranges::reverse(corners);
          facets += "f";
          for (const int corner : corners) facets.append(" ").append(std::to_string(corner));
          facets += "\n";
        }
      }
    }
  }
  for (const auto& [x, y, z] : places) {
    text.append("v ").append(std::to_string(x)).append(" ").append(std::to_string(y));
    text.append(" ").append(std::to_string(z)).append("\n");
  }
  write("open.obj", text + facets);
  const Ran ran =
      run("repair open.obj -o closed.obj --remedies smooth --density 0.7 --spline s.json");
  INFO(ran.output);
  CHECK(ran.status == 0);
  CHECK(ran.output.find("solid 0: repaired: smooth (1 hole of 8 edges: ") != std::string::npos);
  CHECK(ran.output.find("largest turn across the border 0.0 degrees") != std::string::npos);
  CHECK(run("validate -q closed.obj").status == 0);
  const Json spline = Json::parse(read("s.json"));
  CHECK(spline["type"] == "watertight_spline");
  CHECK(spline["coefficients"].size() == spline["triangles"].size());
  for (const char* option : {"--density 0", "--density 1e9", "--regularity 0", "--collar 0",
                             "--collar 11", "--crease 181", "--chord 0"}) {
    INFO(option);
    CHECK(run(std::string("repair open.obj -o c.obj --remedies smooth ") + option).status == 2);
  }
}

TEST_CASE_METHOD(Fixture, "lists of remedies that are wrong are refused") {
  for (const char* list : {"glue", "rings,,fill", "\"\""}) {
    const Ran ran = run("repair " + kInvalid + " -o m.city.jsonl --remedies " + list);
    CHECK(ran.status == 2);
    CHECK(ran.output.find("the remedies are rings, orientation") != std::string::npos);
  }
  CHECK(run("repair " + kInvalid + " -o m.city.jsonl --islands 6").status == 2);
}

/// The line of docs/findings.md on the repair of a finding.
std::string repair_line(const std::string& page, const std::string& code) {
  const std::size_t section = page.find("\n## " + code + ' ');
  const std::size_t begin = page.find("- Repair: ", section);
  const std::size_t end = page.find("- Sample: ", section);
  return begin < end ? page.substr(begin, end - begin) : std::string();
}

/// The first repair of a report.
Json first_repair(const Json& report) {
  for (const Json& feature : report["features"]) {
    for (const Json& primitive : feature["primitives"]) {
      if (primitive.contains("repair")) return primitive["repair"];
    }
  }
  return {};
}

TEST_CASE_METHOD(Fixture, "docs/findings.md names the remedies that mend each sample") {
  const std::string page = test::read_text(test::source_path("docs/findings.md"));
  std::size_t mended = 0;
  for (const char* code :
       {"101", "102", "104", "201", "202", "203", "204", "205", "206", "207", "208", "300",
        "301", "302", "303", "305", "306", "307", "401", "402", "403", "404", "405"}) {
    INFO(code);
    const std::string sample = std::string("tests/golden/findings/") + code + ".city.json";
    run("repair " + test::source_path(sample) +
        " -o m.city.json --remedies all --weld 0.01 --report r.json -q");
    const Json report = Json::parse(read("r.json"));
    const Json repair = first_repair(report);
    const std::string line = repair_line(page, code);
    REQUIRE(!line.empty());
    if (line == "- Repair: none.\n") {
      CHECK(repair["outcome"] == "not-repaired");
      continue;
    }
    for (const std::string remedy : repair["remedies"]) {
      CHECK(line.find('`' + remedy + '`') != std::string::npos);
    }
    mended += repair["outcome"] == "repaired" ? 1 : 0;
  }
  CHECK(mended == 10);
}

TEST_CASE_METHOD(Fixture, "a repaired file does not change again") {
  CHECK(run("repair " + kInvalid + " -o a.city.jsonl --remedies all -q").status == 1);
  const Ran again = run("repair a.city.jsonl -o b.city.jsonl --remedies all -q");
  CHECK(again.status == 1);
  CHECK(again.output.find("  repaired                                           0") !=
        std::string::npos);
  CHECK(read("a.city.jsonl") == read("b.city.jsonl"));
}

TEST_CASE_METHOD(Fixture, "features without a change come back byte for byte") {
  CHECK(run("repair " + kInvalid + " -o a.city.jsonl -q").status == 1);
  const auto before = lines_of(test::read_text(kInvalid));
  const auto after = lines_of(read("a.city.jsonl"));
  REQUIRE(before.size() == after.size());
  std::size_t changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) changed += before[i] == after[i] ? 0 : 1;
  CHECK(changed == 3);  // as many solids as remedies that guess nothing mend
}

TEST_CASE_METHOD(Fixture,
                 "a sequence that is read line by line is repaired as one that is read whole") {
  const std::string text = test::read_text(kInvalid);
  write("whole.json", text);  // by its name no sequence
  const std::string options = " -o out.city.jsonl --remedies all --no-times -q";
  CHECK(run("repair whole.json --report a.json --html a.html" + options).status == 1);
  const std::string mended = read("out.city.jsonl");
  CHECK(run("repair " + kInvalid + " --report b.json --html b.html" + options).status == 1);
  CHECK(mended == read("out.city.jsonl"));
  CHECK(read("a.json") == read("b.json"));
  CHECK(read("a.html") == read("b.html"));
  CHECK(read("a.html").find("6 of 11 invalid solids could be repaired") != std::string::npos);
  CHECK(run("repair whole.json -o a.city.jsonl --remedies all -q").status == 1);
  CHECK(mended == read("a.city.jsonl"));
  CHECK(run("repair " + kInvalid + " -o - --remedies all").output == read("a.city.jsonl"));
  std::string spaced;
  for (const std::string& line : lines_of(text)) spaced += line + "\r\n\r\n";
  write("spaced.city.jsonl", spaced);
  CHECK(run("repair spaced.city.jsonl -o c.city.jsonl --remedies all -q").status == 1);
  std::string unspaced = read("c.city.jsonl");
  std::erase(unspaced, '\r');
  CHECK(unspaced == read("a.city.jsonl"));
}

TEST_CASE_METHOD(Fixture, "GML comes back as GML, with the changed polygons in its text") {
  std::string text = test::read_text(test::source_path("tests/data/gml/citygml_2_xlinks.gml"));
  write("valid.gml", text);
  CHECK(run("repair valid.gml -o same.gml").status == 0);
  CHECK(read("same.gml") == text);
  const std::string south = "0,0,0 10,0,0 5,5,10 0,0,0";
  text.replace(text.find(south), south.size(), "0,0,0 5,5,10 10,0,0 0,0,0");
  const std::string ground = "<g:surfaceMember x:href=\"#ground\"/>";
  text.erase(text.find(ground), ground.size());
  write("broken.gml", text);
  CHECK(run("validate -q broken.gml").status == 1);
  const Ran ran = run("repair broken.gml -o mended.gml --remedies all --report r.json");
  INFO(ran.output);
  CHECK(ran.status == 0);
  CHECK(run("validate -q mended.gml").status == 0);
  CHECK(run("repair broken.gml -o - --remedies all").output == read("mended.gml"));
  const Json report = Json::parse(read("r.json"));
  CHECK(report["input_file_type"] == "GML");
  CHECK(report["repairs"] == Json({{"repaired", 3}, {"left", 0}}));
  const std::string mended = read("mended.gml");
  CHECK(mended.find("<g:Polygon g:id=\"watertight-1\">") != std::string::npos);
  CHECK(mended.find("<g:Polygon g:id=\"south\">") != std::string::npos);
  write("utf16.gml", std::string("\xFF\xFE<\0g\0/\0>\0", 10));
  CHECK(run("repair utf16.gml -o out.gml").status == 2);
}

TEST_CASE_METHOD(Fixture, "a line that cannot be read ends a repair, and what was written goes") {
  const std::string text = test::read_text(kInvalid);
  write("cut.city.jsonl", text.substr(0, text.size() - 100));
  write("out.city.jsonl", "old");
  const Ran ran = run("repair cut.city.jsonl -o out.city.jsonl");
  CHECK(ran.status == 2);
  CHECK(ran.output.find("line 12") != std::string::npos);
  CHECK(read("out.city.jsonl") == "old");
  const Ran unwritten = run("repair " + kInvalid + " -o no/such/folder.city.jsonl");
  CHECK(unwritten.status == 2);
  CHECK(unwritten.output.find("no/such/folder.city.jsonl") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "semantics follow their facets, and new facets are closure surfaces") {
  const std::string header =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
      R"("CityObjects":{},"vertices":[]})";
  const std::string feature =
      R"({"type":"CityJSONFeature","id":"b","CityObjects":{"b":{"type":"Building","geometry":[{)"
      R"("type":"Solid","lod":"2","boundaries":[[[[0,3,2,1]],[[0,1,5,4]],[[6,5,1,2]],)"
      R"([[2,3,7,6]],[[3,0,4,7]]]],"semantics":{"surfaces":[{"type":"GroundSurface"},)"
      R"({"type":"WallSurface","name":"east"}],"values":[[0,null,1,null,1]]}}]}},)"
      R"("vertices":[[0,0,0],[9,0,0],[9,9,0],[0,9,0],[0,0,9],[9,0,9],[9,9,9],[0,9,9]]})";
  write("open.city.jsonl", header + "\n" + feature + "\n");
  CHECK(run("repair open.city.jsonl -o closed.city.jsonl --remedies all").status == 0);
  const Json closed = Json::parse(lines_of(read("closed.city.jsonl")).at(1));
  const Json& geometry = closed["CityObjects"]["b"]["geometry"][0];
  CHECK(geometry["boundaries"][0].size() == 6);
  CHECK(geometry["semantics"]["surfaces"].size() == 3);
  CHECK(geometry["semantics"]["surfaces"][2] == Json{{"type", "ClosureSurface"}});
  CHECK(geometry["semantics"]["values"] == Json::parse("[[0,null,1,null,1,2]]"));
  CHECK(closed["vertices"].size() == 8);
}

TEST_CASE_METHOD(Fixture, "other formats are repaired too") {
  write("open.off",
        "OFF\n8 5 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 0 3 2 1\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  CHECK(run("repair open.off -o closed.obj --remedies fill").status == 0);
  CHECK(run("validate closed.obj").status == 0);
}

TEST_CASE_METHOD(Fixture, "repair refuses what makes no sense") {
  write("bad.city.json", "{");
  CHECK(run("repair bad.city.json -o out.city.json").status == 2);
  CHECK(run("repair " + kInvalid).status == 2);
  CHECK(run("repair " + kInvalid + " -o out.city.jsonl --remedies wish").status == 2);
  CHECK(run("repair " + kInvalid + " -o out.city.jsonl --weld nan").status == 2);
  CHECK(run("repair " + kInvalid + " -o out.city.jsonl --weld -1").status == 2);
  CHECK(run("repair " + kInvalid + " -o no/such/folder.city.jsonl").status == 2);
  write("same.city.jsonl", test::read_text(kInvalid));
  CHECK(run("repair same.city.jsonl -o same.city.jsonl").status == 2);
  CHECK(read("same.city.jsonl") == test::read_text(kInvalid));
}

}  // namespace
}  // namespace watertight::test
