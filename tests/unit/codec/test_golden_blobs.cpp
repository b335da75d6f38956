// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the golden files. A change of a golden file is a change of the format: see CONTRIBUTING.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <fstream>
#include <sstream>
#include <string>

#include "codec/page_file.h"
#include "geometry/canonical_form.h"
#include "tests/files.h"
#include "tests/generated/golden_blobs.h"
#include "tests/generated/golden_pages.h"

using namespace watertight;

namespace {

std::string folder_of_goldens() { return test::source_path("tests/golden/blobs/version-1/"); }

std::string path_of(const std::string& name) { return folder_of_goldens() + name + ".blob"; }

void check_decoded(const generated::Golden& golden, const Bytes& bytes) {
  const auto decoded = decode(bytes);
  REQUIRE(decoded);
  const Solid& source = golden.boundary.solid();
  CHECK(decoded->solid ==
        (golden.keep_order ? source : geometry::canonical_form(golden.boundary).boundary.solid()));
  CHECK(decoded->info.acceptance == golden.acceptance);
  CHECK((decoded->info.steiner_vertices > 0) == golden.with_steiner);
}

/// The solids of a page or page file, in the order of their numbers.
Result<std::vector<Solid>> solids_of(ByteView bytes, bool is_file) {
  std::vector<Solid> solids;
  if (!is_file) {
    const auto page = codec::decode_page(bytes);
    if (!page) return page.error();
    for (const Decoded& decoded : *page) solids.push_back(decoded.solid);
    return solids;
  }
  const auto reader = codec::PageFileReader::open(bytes);
  if (!reader) return reader.error();
  for (std::uint64_t number = 0; number < reader->size(); ++number) {
    const auto decoded = reader->solid(number);
    if (!decoded) return decoded.error();
    solids.push_back(decoded->solid);
  }
  return solids;
}

void write_file(const std::string& path, ByteView bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

/// The bytes of the document's worked example: the pairs of hexadecimal digits before two spaces in
/// its fenced lines.
Bytes example_of(const std::string& document) {
  const std::string text = test::read_text(test::source_path("docs/") + document);
  const std::size_t example = text.find("\n## Example");
  if (example == std::string::npos) return {};
  std::istringstream lines(text.substr(std::min(text.find("```\n", example), text.size())));
  std::string line;
  std::getline(lines, line);  // skips the fence
  Bytes bytes;
  while (std::getline(lines, line) && line != "```") {
    const std::size_t first = line.find_first_not_of(' ');
    std::istringstream pairs(line.substr(first, line.find("  ", first) - first));
    for (std::string pair; pairs >> pair;) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(pair, nullptr, 16)));
    }
  }
  return bytes;
}

}  // namespace

TEST_CASE("the worked example of docs/format.md is a golden box") {
  CHECK(example_of("format.md") == test::read_bytes(path_of("box-neutral")));
}

TEST_CASE("golden blobs decode to their solids") {
  for (const auto& golden : generated::goldens()) {
    INFO(golden.name);
    check_decoded(golden, test::read_bytes(path_of(golden.name)));
  }
}

TEST_CASE("encoding a golden solid again gives the golden bytes") {
  for (const auto& golden : generated::goldens()) {
    INFO(golden.name);
    const auto blob = generated::encode_golden(golden);
    REQUIRE(blob);
    CHECK(*blob == test::read_bytes(path_of(golden.name)));
  }
}

TEST_CASE("golden pages and page files decode to their solids") {
  for (const auto& golden : generated::golden_pages()) {
    INFO(golden.file);
    const bool is_file = golden.file.ends_with(".wtpf");
    const auto solids = solids_of(test::read_bytes(folder_of_goldens() + golden.file), is_file);
    REQUIRE(solids);
    REQUIRE(solids->size() == golden.solids.size());
    for (std::size_t i = 0; i < solids->size(); ++i) {
      CHECK((*solids)[i] == golden.solids[i].solid());
    }
  }
}

TEST_CASE("encoding golden pages again gives the golden bytes") {
  for (const auto& golden : generated::golden_pages()) {
    INFO(golden.file);
    const auto page = generated::encode_golden_page(golden);
    REQUIRE(page);
    CHECK(*page == test::read_bytes(folder_of_goldens() + golden.file));
  }
}

TEST_CASE("bytes that no encoder writes are refused with the error that the specification states") {
  for (const auto& refused : generated::refused()) {
    INFO(refused.name);
    if (refused.kind == "blob") {
      const auto decoded = decode(refused.bytes);
      REQUIRE_FALSE(decoded);
      CHECK(decoded.error().code == refused.error);
    } else {
      const auto solids = solids_of(refused.bytes, refused.kind == "wtpf");
      REQUIRE_FALSE(solids);
      CHECK(solids.error().code == refused.error);
    }
  }
}

TEST_CASE("the table of refused bytes in the golden file is up to date") {
  const Bytes table = test::read_bytes(folder_of_goldens() + "refused.csv");
  CHECK(as_text(table) == generated::refused_csv());
}

TEST_CASE("write golden blobs", "[.][write]") {
  for (const auto& golden : generated::goldens()) {
    const auto blob = generated::encode_golden(golden);
    REQUIRE(blob);
    write_file(path_of(golden.name), *blob);
    WARN(golden.name << ": " << blob->size());
  }
  for (const auto& golden : generated::golden_pages()) {
    const auto page = generated::encode_golden_page(golden);
    REQUIRE(page);
    write_file(folder_of_goldens() + golden.file, *page);
    WARN(golden.file << ": " << page->size());
  }
  write_file(folder_of_goldens() + "refused.csv", as_bytes(generated::refused_csv()));
}
