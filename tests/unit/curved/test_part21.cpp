// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>

#include "curved_texts.h"
#include "formats/part21/part21.h"

namespace watertight {
namespace {

using formats::Part21;
using formats::StepValue;

std::string file(const std::string& data) {
  return "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n" + data +
         "ENDSEC;\nEND-ISO-10303-21;\n";
}

Error error_of(const std::string& text) {
  const auto read = Part21::read(text, {});
  REQUIRE_FALSE(read);
  CHECK_FALSE(read.error().message.empty());
  CHECK(read.error().byte_offset);
  return read.error();
}

}  // namespace

TEST_CASE("values of every kind are read") {
  const std::string text = file(
      "#7 = THING ( 'it''s; #1 /* no */' , -12.5E-1, .T., $, *, #12, (1, (2.)), MEASURE(.5), "
      "\"0F\", +3 ) ; /* #8=NOTHING(); */\n#12=(A(1) B('x'));\n");
  const auto read = Part21::read(text, {});
  REQUIRE(read);
  CHECK(read->schema() == "IFC4");
  CHECK(read->places().size() == 2);
  CHECK(read->type_of(7) == "THING");
  const auto thing = read->instance(7);
  REQUIRE(thing);
  const auto& values = thing->entities[0].values;
  REQUIRE(values.size() == 10);
  CHECK(formats::decoded_text(values[0].text) == "it's; #1 /* no */");
  CHECK(values[1].number == -1.25);
  CHECK(values[2].is_true());
  CHECK(values[3].kind == StepValue::Kind::omitted);
  CHECK(values[4].kind == StepValue::Kind::derived);
  CHECK(values[5].id == 12);
  CHECK(values[6].items[1].items[0].number == 2);
  CHECK(values[7].text == "MEASURE");
  CHECK(values[7].items[0].number == 0.5);
  CHECK(values[8].text == "0F");
  CHECK(values[9].number == 3);
  const auto complex = read->instance(12);
  REQUIRE(complex);
  CHECK(complex->entities.size() == 2);
  CHECK_FALSE(read->instance(13));
}

TEST_CASE("characters of strings become UTF-8") {
  CHECK(formats::decoded_text("h\\X2\\00F8\\X0\\jre") == "h\xC3\xB8jre");
  CHECK(formats::decoded_text("h\\X4\\000000F8\\X0\\jre") == "h\xC3\xB8jre");
  CHECK(formats::decoded_text("\\X\\F8 \\S\\x \\\\") == "\xC3\xB8 \xC3\xB8 \\");
  CHECK(formats::decoded_text("\\X2\\D83DDE00") == "\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST_CASE("texts that are truncated or hostile are errors with a place") {
  CHECK(error_of("").byte_offset == 0);
  error_of("ISO-10303-21;");
  error_of("ISO-10303-21;\nDATA;\n#1=A();\n");
  error_of(file("#1=A(\n"));
  error_of(file("#1=A('no end);\n"));
  error_of(file("#1=A(); /* no end\n"));
  error_of(file("#1=A();\n#1=B();\n"));
  error_of(file("#99999999999999999999999=A();\n"));
  error_of(file("#=A();\n"));
  const std::string whole = test::step_cylinder();
  for (std::size_t size = 0; size + 20 < whole.size(); size += 7) {
    CHECK_FALSE(Part21::read(whole.substr(0, size), {}));
  }
}

TEST_CASE("an instance that is no list of values is an error with a place") {
  for (const char* wrong : {"#1=A(1,);", "#1=A(1 2);", "#1=A(1e999);", "#1=A(x);", "#1=(A();",
                            "#1=A;", "#1=A(.T);", "#1=A(--1);", "#1=A(nan);", "#1=();"}) {
    CAPTURE(wrong);
    const std::string text = file(std::string(wrong) + "\n");
    const auto read = Part21::read(text, {});
    if (!read) continue;
    const auto instance = read->instance(1);
    REQUIRE_FALSE(instance);
    CHECK(instance.error().byte_offset);
  }
  const std::string deep = file("#1=A" + std::string(1'000'000, '(') + ";\n");
  const auto read = Part21::read(deep, {});
  REQUIRE(read);
  CHECK(read->instance(1).error().code == ErrorCode::limit_exceeded);
}

}  // namespace watertight
