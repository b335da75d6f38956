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
                     {"-0.4970000088214874", {Kind::float_decimal, 3}, -497},
                     {"28155563e-2", {Kind::scaled, 2}, 28'155'563},
                     {"605e-1", {Kind::scaled, 2}, 6'050},
                     {"-5e-3", {Kind::scaled, 3}, -5},
                     {"59e1", {Kind::scaled, 0}, 590},
                     {"0", {Kind::scaled, 2}, 0},
                     {"56811981201171875e-16", {Kind::scaled_float32, 0}, 1'085'656'160},
                     {"59279998779296875e-15", {Kind::scaled_float_decimal, 2}, 5'928}};
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
  CHECK_FALSE(columns::number_in({Kind::scaled, 2}, "281555.63"));
  CHECK_FALSE(columns::number_in({Kind::scaled, 2}, "590"));
  for (const char* text : {"",
                           "-",
                           "-0",
                           "00",
                           "1.",
                           ".5",
                           "1e05",
                           "10e1",
                           "1e+5",
                           "1e",
                           "1e-41",
                           "-0e1",
                           "1.5e1",
                           "1e5x",
                           "+1",
                           "0x1",
                           "nan",
                           "inf",
                           "1234567890123456789",
                           "1.2.3",
                           " 1"}) {
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
  const auto scaled = choose_form("624237721e-2", std::nullopt);
  REQUIRE(scaled);
  for (const char* text : {"595e-1", "594", "-3e1"}) {
    CAPTURE(text);
    const auto next = choose_form(text, scaled->form);
    REQUIRE(next);
    CHECK(next->form == scaled->form);
  }
  const auto longer = choose_form("3.12345", chosen->form);
  REQUIRE(longer);
  CHECK(longer->form == NumberForm{Kind::trimmed, 5});
}

TEST_CASE("numbers at the edge of their forms are refused, not misprinted") {
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  for (const auto kind :
       {Kind::trimmed, Kind::short_trimmed, Kind::fixed, Kind::float32, Kind::float_decimal,
        Kind::scaled, Kind::scaled_float32, Kind::scaled_float_decimal}) {
    for (const std::int64_t number : {kLeast, kLeast + 1, kMost, columns::kDecimalLimit,
                                      -columns::kDecimalLimit, std::int64_t{0x7F80'0000}}) {
      const bool has_decimals = kind != Kind::float32 && kind != Kind::scaled_float32;
      const NumberForm form{kind, has_decimals ? 2 : 0};
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
