// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "formats/text/json_events.h"
#include "tests/random.h"

namespace watertight::test_json_events {

namespace {

using Json = nlohmann::ordered_json;

/// Writes down the events.
struct Events {
  std::string log;

  bool add(const char* event, const std::string& value = {}) {
    log.append(event).append(value) += '\n';
    return true;
  }
  bool null() { return add("null"); }
  bool boolean(bool value) { return add(value ? "true" : "false"); }
  bool number_integer(std::int64_t value) { return add("integer ", std::to_string(value)); }
  bool number_unsigned(std::uint64_t value) { return add("unsigned ", std::to_string(value)); }
  bool number_float(double value, const std::string& text) {
    add("float ", std::to_string(std::bit_cast<std::uint64_t>(value)));
    return add("of text ", text);
  }
  bool string(std::string& value) { return add("string ", std::exchange(value, "moved")); }
  bool binary(Json::binary_t&) { return false; }
  bool start_object(std::size_t size) { return add("{", std::to_string(size)); }
  bool key(std::string& key) { return add("key ", std::exchange(key, "moved")); }
  bool end_object() { return add("}"); }
  bool start_array(std::size_t size) { return add("[", std::to_string(size)); }
  bool end_array() { return add("]"); }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) { return false; }
};

/// Compares with nlohmann's parser. Returns whether the text was read.
bool check_same(const std::string& text) {
  Events expected;
  const bool is_json = Json::sax_parse(text, &expected);
  Events events;
  const bool is_read = formats::JsonEvents(text, events).run();
  CAPTURE(text);
  if (is_read) {
    REQUIRE(is_json);
    REQUIRE(events.log == expected.log);
  }
  return is_read;
}

const std::string kSample =
    "\xEF\xBB\xBF {\"a\" : [1, -2, 0, -0, 3.25, 1e3, -4E-2, 0.1e+5],\t\"\" : {},\n"
    "\"b\\n\\u00e9\\uD83D\\ude00\\\"\\\\\\/\\b\\f\\r\\t\": \"\xC3\xA9 \xE2\x82\xAC "
    "\xF0\x9F\x98\x80 "
    "\x7F\",\r\n\"c\":[[],[{}],[null,true,false]],\"d\":18446744073709551615,"
    "\"e\":18446744073709551616,\"f\":-9223372036854775808,\"g\":-9223372036854775809,"
    "\"h\":0.30000000000000004,\"i\":123456789012345678901234567890.5e-10} ";

}  // namespace

TEST_CASE("events are those of nlohmann's parser") {
  CHECK(check_same(kSample));
  for (const char* text :
       {"1", "-1.5", "\"\"", "null", "true", "false", "[]", "{}", " [ ] ", "[1,[2,[3]]]",
        R"({"a":{"b":{"c":[]}},"d":0})", "1e-300", "4.9e-324", "1.7976931348623157e308", "-0.0"}) {
    CAPTURE(text);
    CHECK(check_same(text));
  }
}

TEST_CASE("texts that are no JSON are not read as events") {
  for (const char* text : {"",
                           " ",
                           "[",
                           "]",
                           "{",
                           "}",
                           "[1",
                           "[1,",
                           "[1,]",
                           "[,]",
                           "{\"a\"}",
                           "{\"a\":}",
                           "{\"a\":1,}",
                           "{1:2}",
                           "{\"a\" 1}",
                           "[1 2]",
                           "[1}",
                           "{\"a\":1]",
                           "01",
                           "-",
                           "-a",
                           "1.",
                           ".5",
                           "+1",
                           "1e",
                           "1e+",
                           "0x1",
                           "nul",
                           "truely",
                           "NaN",
                           "Infinity",
                           "1 2",
                           "[] []",
                           "'a'",
                           "\"a",
                           "\"\\",
                           "\"\\x\"",
                           "\"\\u12\"",
                           "\"\\u12g4\"",
                           "\"\\u+123\"",
                           "\"\\uDC00\"",
                           "\"\\uD800\"",
                           "\"\\uD800\\u0041\"",
                           "\"\x01\"",
                           "\"\n\"",
                           "\"\x80\"",
                           "\"\xC0\x80\"",
                           "\"\xC3\"",
                           "\"\xE0\x80\x80\"",
                           "\"\xED\xA0\x80\"",
                           "\"\xF4\x90\x80\x80\"",
                           "\"\xF5\x80\x80\x80\"",
                           "\"\xE2\x82\"",
                           "1e999",
                           "/**/1",
                           "[1]x"}) {
    CAPTURE(text);
    Events unused;
    CHECK_FALSE(Json::sax_parse(std::string(text), &unused));
    CHECK_FALSE(check_same(text));
  }
}

TEST_CASE("events of damaged texts are those of nlohmann's parser, or the text is not read") {
  test::Random random(11);
  int read = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string text = kSample;
    for (std::uint64_t change = random.below(3); change < 3; ++change) {
      const std::size_t at = random.below(text.size());
      if (random.below(2) == 0) {
        text[at] = static_cast<char>(random.below(255) + 1);
      } else {
        text.erase(at, 1 + random.below(4));
      }
    }
    read += check_same(text) ? 1 : 0;
  }
  CHECK(read > 1'000);
}

}  // namespace watertight::test_json_events
