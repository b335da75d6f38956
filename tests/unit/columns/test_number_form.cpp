// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <limits>
#include <string>

#include "columns/models/number_form.h"

namespace watertight {
namespace {

using columns::choose_form;
using columns::NumberForm;
using Kind = NumberForm::Kind;

TEST_CASE("a number in its form prints as its text") {
  struct Case {
    const char* text;
    NumberForm form;
    std::int64_t number;
  };
  const Case cases[]{{"0", {Kind::short_trimmed, 0}, 0},
                     {"-17", {Kind::short_trimmed, 0}, -17},
                     {"11.0", {Kind::trimmed, 3}, 11'000},
                     {"11", {Kind::short_trimmed, 3}, 11'000},
                     {"-0.05", {Kind::trimmed, 2}, -5},
                     {"12.500", {Kind::fixed, 3}, 12'500},
                     {"5.6811981201171875", {Kind::float32, 0}, 1'085'656'160},
                     {"-0.4970000088214874", {Kind::float_decimal, 3}, -497}};
  for (const Case& c : cases) {
    CAPTURE(c.text);
    CHECK(columns::number_in(c.form, c.text) == c.number);
    CHECK(columns::print(c.form, c.number) == c.text);
  }
}

TEST_CASE("a text that a form does not give back has no number in it") {
  CHECK_FALSE(columns::number_in({Kind::trimmed, 3}, "11"));
  CHECK_FALSE(columns::number_in({Kind::short_trimmed, 3}, "11.0"));
  CHECK_FALSE(columns::number_in({Kind::short_trimmed, 1}, "0.05"));
  CHECK_FALSE(columns::number_in({Kind::fixed, 2}, "1.500"));
  CHECK_FALSE(columns::number_in({Kind::float32, 0}, "0.1"));
  for (const char* text : {"", "-", "-0", "00", "1.", ".5", "1e5", "+1", "0x1", "nan", "inf",
                           "1234567890123456789", "1.2.3", " 1"}) {
    CAPTURE(text);
    CHECK_FALSE(choose_form(text, std::nullopt));
  }
}

TEST_CASE("the form of a column is kept while its texts allow it") {
  auto chosen = choose_form("7.717", std::nullopt);
  REQUIRE(chosen);
  for (const char* text : {"10.0", "3.5", "-0.001"}) {
    CAPTURE(text);
    const auto next = choose_form(text, chosen->form);
    REQUIRE(next);
    CHECK(next->form == chosen->form);
  }
  const auto longer = choose_form("3.12345", chosen->form);
  REQUIRE(longer);
  CHECK(longer->form == NumberForm{Kind::trimmed, 5});
}

TEST_CASE("numbers at the edge of their forms are refused, not misprinted") {
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  for (const auto kind :
       {Kind::trimmed, Kind::short_trimmed, Kind::fixed, Kind::float32, Kind::float_decimal}) {
    for (const std::int64_t number : {kLeast, kLeast + 1, kMost, columns::kDecimalLimit,
                                      -columns::kDecimalLimit, std::int64_t{0x7F80'0000}}) {
      const NumberForm form{kind, kind == Kind::float32 ? 0 : 2};
      const std::string text = columns::print(form, number);
      if (text.empty()) continue;
      const auto read = columns::number_in(form, text);
      if (read) CHECK(columns::print(form, *read) == text);
      if (kind == Kind::fixed) CHECK(read == number);
    }
  }
  CHECK(columns::with_decimals(columns::kDecimalLimit - 1, 0, 3) == 0);
  CHECK(columns::with_decimals(-1999, 3, 0) == -1);
}

}  // namespace
}  // namespace watertight
