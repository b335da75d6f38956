// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inputs of the command line that are not one plain file: compressed files, archives, folders, and
// a CityJSONFeature alone.
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/unit/archives/pack.h"
#include "tests/unit/cli/fixture.h"

namespace watertight {
namespace {

using Json = nlohmann::json;
using test::Fixture;
using test::Ran;
using test::ZipMaker;

// A tetrahedron, and the same without one facet.
const std::string kValid =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const std::string kOpen = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";

const std::string kHeader =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],)"
    R"("translate":[0,0,0]},"CityObjects":{},"vertices":[]})";
const std::string kFeature = R"({
  "type": "CityJSONFeature",
  "id": "a",
  "CityObjects": {"a": {"type": "Building", "geometry": [
    {"type": "Solid", "lod": "1", "boundaries": [[[[0, 2, 1]], [[0, 1, 3]], [[1, 2, 3]], [[2, 0, 3]]]]}
  ]}},
  "vertices": [[0, 0, 0], [1000, 0, 0], [0, 1000, 0], [0, 0, 1000]]
}
)";

bool has(const Ran& ran, const std::string& text) {
  INFO(ran.output);
  const bool does = ran.output.find(text) != std::string::npos;
  CHECK(does);
  return does;
}

TEST_CASE("compressed files are read, whatever their names") {
  const Fixture fixture;
  fixture.write("a.obj.gz", test::gzip(kValid));
  fixture.write("b.obj.zst", test::zstd(kValid));
  fixture.write("c", test::gzip(kValid));
  for (const std::string name : {"a.obj.gz", "b.obj.zst", "c"}) {
    const Ran ran = fixture.run("validate " + name);
    CHECK(ran.status == 0);
    has(ran, "The feature with solids is valid.");
  }
  CHECK(fixture.run("validate - < a.obj.gz").status == 0);
  CHECK(fixture.run("advise a.obj.gz").status == 0);
  CHECK(fixture.run("convert b.obj.zst -o b.off").status == 0);
  CHECK(fixture.run("encode a.obj.gz -o a.wt").status == 0);
  CHECK(fixture.run("decode a.wt -o a.obj").status == 0);
  CHECK(fixture.read("a.obj") == kValid);
}

TEST_CASE("a compressed sequence is the same document") {
  const Fixture fixture;
  std::string text = kHeader + "\n";
  for (int i = 0; i < 50; ++i) {
    Json feature = Json::parse(kFeature);
    feature["id"] = "b" + std::to_string(i);
    feature["CityObjects"] = {{feature["id"], feature["CityObjects"]["a"]}};
    text += feature.dump() + "\n";
  }
  fixture.write("s.city.jsonl", text);
  fixture.write("s.city.jsonl.gz", test::gzip(text));
  const Ran ran = fixture.run("validate s.city.jsonl.gz");
  CHECK(ran.status == 0);
  has(ran, "All 50 features with solids are valid.");
  CHECK(fixture.run("encode s.city.jsonl.gz -o s.wt && cmp s.wt s.wt").status == 0);
  CHECK(fixture.run("decode s.wt -o back.city.jsonl").status == 0);
  CHECK(fixture.read("back.city.jsonl") == text);
}

TEST_CASE("broken compressed files are errors that name the place") {
  const Fixture fixture;
  const std::string packed = test::gzip(kValid);
  fixture.write("short.obj.gz", packed.substr(0, packed.size() - 5));
  const Ran ran = fixture.run("validate short.obj.gz");
  CHECK(ran.status == 2);
  has(ran, "short.obj.gz: malformed: gzip: the data end too early (at byte ");
  fixture.write("twice.obj.gz", test::gzip(packed));
  CHECK(fixture.run("validate twice.obj.gz").status == 2);
  has(fixture.run("validate twice.obj.gz"), "compressed twice");
  fixture.write("a.tar.gz", packed);
  has(fixture.run("validate a.tar.gz"), "tar archives are not read");
  fixture.write("empty.obj.gz", test::gzip(""));
  fixture.write("empty.obj", "");
  CHECK(fixture.run("validate empty.obj.gz").status == fixture.run("validate empty.obj").status);
}

TEST_CASE("members of a zip are documents, and reports name them") {
  const Fixture fixture;
  const ZipMaker zip{{{"z.obj", kOpen},
                      {"in/a.obj", kValid},
                      {"in/", "", true},
                      {"readme.txt", "hello"},
                      {"__MACOSX/._z.obj", "x"}}};
  fixture.write("town.zip", zip.bytes());
  const Ran ran = fixture.run("validate town.zip --report r.json --no-times");
  CHECK(ran.status == 1);
  has(ran, "town.zip: skipped: 2 files with the ending of no known format");
  const std::string report = fixture.read("r.json");
  const std::size_t first = report.find("town.zip/in/a.obj");
  CHECK(first != std::string::npos);
  CHECK(report.find("town.zip/z.obj") > first);
  has(fixture.run("encode town.zip -o one.wt"), "2 documents need a folder");
  has(fixture.run("advise town.zip"), "this command reads one document, and there are 2");
  CHECK(fixture.run("validate - < town.zip").status == 2);

  fixture.write("one.zip", ZipMaker{{{"no-ending", kValid}}}.bytes());
  CHECK(fixture.run("validate one.zip").status == 0);
  CHECK(fixture.run("validate - < one.zip").status == 0);
  CHECK(fixture.run("encode one.zip -o one.wt").status == 0);
}

TEST_CASE("one bad member stops no other") {
  const Fixture fixture;
  const ZipMaker zip{{{"a.obj", kValid},
                      {"b.obj", kValid, true, 1},
                      {"c.obj", kValid, false, 0, -1, -1, 7},
                      {"d.obj.gz", test::gzip(kValid)},
                      {"../\x1B[31me.obj", kValid}}};
  fixture.write("t.zip", zip.bytes());
  const Ran ran = fixture.run("validate t.zip missing.obj");
  CHECK(ran.status == 2);
  has(ran, "t.zip/b.obj: unsupported: zip: the member is encrypted");
  has(ran, "t.zip/c.obj: malformed: zip: the checksum of the member is wrong");
  has(ran, "t.zip/d.obj.gz: unsupported: an archive in an archive");
  has(ran, "missing.obj: unavailable");
  has(ran, "All 2 features with solids are valid.");
  CHECK(ran.output.find('\x1B') == std::string::npos);
  // A name with ".." is no name below a folder, and nothing is written.
  has(fixture.run("encode t.zip -o out/"), "there is no file in a folder for the name");
  CHECK_FALSE(std::filesystem::exists(fixture.folder / "out"));
}

TEST_CASE("archives that are broken or empty are errors") {
  const Fixture fixture;
  const std::string zip = ZipMaker{{{"a.obj", kValid}}}.bytes();
  fixture.write("cut.zip", zip.substr(0, zip.size() - 10));
  has(fixture.run("validate cut.zip"), "is the archive cut off?");
  CHECK(fixture.run("validate cut.zip").status == 2);
  fixture.write("empty.zip", ZipMaker{}.bytes());
  has(fixture.run("validate empty.zip"), "the archive has no members");
  fixture.write("texts.zip", ZipMaker{{{"a.txt", "a"}, {"b.txt", "b"}}}.bytes());
  has(fixture.run("validate texts.zip"), "no document in the archive");
  fixture.write("inner.zip", ZipMaker{{{"town.zip", zip}}}.bytes());
  has(fixture.run("validate inner.zip"), "an archive in an archive");
}

TEST_CASE("what a small file expands to is limited") {
  const Fixture fixture;
  // More than 256 MiB of blanks, which are no document until they end.
  const std::string blanks(std::size_t{1} << 24U, ' ');
  const std::string member = test::gzip(blanks);
  std::string bomb;
  for (int i = 0; i < 17; ++i) bomb += member;
  fixture.write("bomb.city.jsonl.gz", bomb);
  const Ran ran = fixture.run("validate bomb.city.jsonl.gz");
  CHECK(ran.status == 2);
  has(ran, "gzip: expands to more than 268435456 bytes and more than 100 times its size");
}

TEST_CASE("the documents in a folder are inputs, in byte order") {
  const Fixture fixture;
  std::filesystem::create_directories(fixture.folder / "city" / "b");
  fixture.write("city/c.obj", kValid);
  fixture.write("city/b/a.obj", kValid);
  fixture.write("city/B.obj.gz", test::gzip(kValid));
  fixture.write("city/note.txt", "x");
  fixture.write("city/z.zip", ZipMaker{{{"in.obj", kValid}}}.bytes());
  const Ran ran = fixture.run("validate city --csv - --report r.json");
  CHECK(ran.status == 0);
  has(ran, "city: skipped: 1 file with");
  const std::string report = fixture.read("r.json");
  std::size_t at = 0;
  for (const std::string name :
       {"city/B.obj.gz", "city/b/a.obj", "city/c.obj", "city/z.zip/in.obj"}) {
    const std::size_t found = report.find(name, at);
    INFO(name);
    REQUIRE(found != std::string::npos);
    at = found;
  }
  CHECK(fixture.run("encode city -o out/").status == 0);
  for (const std::string name : {"B.obj.gz", "b/a.obj", "c.obj", "z.zip/in.obj"}) {
    const Ran back = fixture.run("decode out/" + name + ".wt -o back.obj");
    CHECK(back.status == 0);
    CHECK(fixture.read("back.obj") == kValid);
  }
  // The Watertight files of a folder are documents too.
  CHECK(fixture.run("validate out").status == 0);
  has(fixture.run("encode city city -o out/"), "would both go to");
  std::filesystem::create_directories(fixture.folder / "nothing");
  has(fixture.run("validate nothing"), "no document in the folder");
  CHECK(fixture.run("validate nothing").status == 2);
}

TEST_CASE("a report never replaces an input in a folder") {
  const Fixture fixture;
  std::filesystem::create_directories(fixture.folder / "city");
  fixture.write("city/a.obj", kValid);
  fixture.write("city/r.json", "{}");
  const Ran ran = fixture.run("validate city --report city/r.json");
  CHECK(ran.status == 2);
  has(ran, "a report would replace an input");
  CHECK(fixture.read("city/r.json") == "{}");
}

TEST_CASE("a CityJSONFeature alone comes back byte for byte") {
  const Fixture fixture;
  const std::string minimal =
      "{\n  \"type\": \"CityJSONFeature\",\n  \"id\": \"myid\",\n"
      "  \"CityObjects\": {\"myid\": {\"type\": \"Building\"}},\n"
      "  \"vertices\": []\n}\n";
  // Its type comes late, as in JSON with sorted keys.
  const std::string sorted = Json::parse(kFeature).dump(2);
  const std::string padded = "{\"x\":\"" + std::string(9000, 'x') + "\",\n" + sorted.substr(1);
  for (const std::string name : {"f.city.jsonl", "f.city.json", "f"}) {
    for (const std::string& text : {kFeature, minimal, sorted, padded}) {
      fixture.write(name, text);
      const bool is_whole = text == minimal;
      const Ran encoded = fixture.run("encode " + name + " -o f.wt");
      INFO(name << "\n" << text.substr(0, 80) << "\n" << encoded.output);
      CHECK(encoded.status == (is_whole ? 0 : 1));
      if (!is_whole) has(encoded, "a CityJSONFeature alone has no transform");
      CHECK(fixture.run("decode f.wt -o - > back").status == 0);
      CHECK(fixture.read("back") == text);
      CHECK(fixture.run("validate " + name).status == (is_whole ? 0 : 1));
    }
  }
}

TEST_CASE("a CityJSONFeature alone with a transform of its own is judged") {
  const Fixture fixture;
  Json feature = Json::parse(kFeature);
  feature["transform"] = {{"scale", {0.001, 0.001, 0.001}}, {"translate", {0, 0, 0}}};
  const std::string text = feature.dump(1);
  fixture.write("f.city.json", text);
  CHECK(fixture.run("validate f.city.json").status == 0);
  CHECK(fixture.run("encode f.city.json -o f.wt --invalid refuse").status == 0);
  CHECK(fixture.run("decode f.wt -o - > back").status == 0);
  CHECK(fixture.read("back") == text);
}

TEST_CASE("lines of a sequence without header are no CityJSONFeature alone") {
  const Fixture fixture;
  const std::string line = Json::parse(kFeature).dump() + "\n";
  fixture.write("s.city.jsonl", line + line);
  const Ran ran = fixture.run("validate s.city.jsonl");
  CHECK(ran.status == 2);
  has(ran, "line 1: ");
}

}  // namespace
}  // namespace watertight
