// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "packing/feature_text.h"

namespace watertight::packing {
namespace {

TEST_CASE("the city model of a text stands behind the lines about its solids") {
  CHECK(model_line("{\"a\":1}\n\x01layout") == "{\"a\":1}");
  CHECK(model_line("measures 0 x\nreport 0 y\nfindings z\nunproven 0 u\nmerged 1 m\n{}") == "{}");
  CHECK(model_line("").empty());
  CHECK(model_line("measures 0 x").empty());
  CHECK(model_line("measures 0 x\nv 1 2 3\n{}").empty());
}

TEST_CASE("a text says how a solid was repaired") {
  const std::string_view text = "report 0 y\nunproven 0 u\nmerged 1 m\nrepaired 1 {\"a\":1}\n{}";
  CHECK(repair_of(text, 1) == "{\"a\":1}");
  CHECK(repair_of(text, 0).empty());
  CHECK(repair_of(text, 11).empty());
  CHECK(repair_of("{}\nrepaired 0 {}\n", 0).empty());
  CHECK(repair_of("repaired 0 {}", 0).empty());
  CHECK(model_line(text) == "{}");
}

TEST_CASE("a text comes back from its marks") {
  for (const std::string text :
       {"", "{}", "id12 and id12", "\x02 of its own id12", "\x01 of its own id12", "id1"}) {
    for (const std::string id : {"", "i", "id12"}) {
      const auto back = without_marks(with_marks(text, id), id, 1000);
      REQUIRE(back);
      CHECK(*back == text);
    }
  }
  CHECK(with_marks("id12id12", "id12").size() == 3);
}

TEST_CASE("marks that stand for more bytes than allowed are refused") {
  const std::string marked = with_marks(std::string(1, ' ') + "abcdefgh", "abcdefgh");
  CHECK(without_marks(marked, "abcdefgh", 9));
  CHECK(!without_marks(marked, "abcdefgh", 8));
}

}  // namespace
}  // namespace watertight::packing
