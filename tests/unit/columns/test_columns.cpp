// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "columns/columns.h"
#include "tests/files.h"

namespace watertight {
namespace {

using columns::Text;
using columns::TextKind;

constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

std::vector<Text> lines_of(const std::string& text, TextKind kind) {
  std::vector<Text> lines;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    lines.push_back({kind, rest.substr(0, end)});
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return lines;
}

void check_round_trip(const std::vector<Text>& texts) {
  const Bytes packed = columns::pack_texts(texts);
  const auto unpacked = columns::unpack_texts(packed, kNoLimit);
  REQUIRE(unpacked);
  REQUIRE(unpacked->size() == texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) CHECK((*unpacked)[i] == texts[i].text);
}

/// Flips some bits: the result is an error, or texts within the limit.
void check_damaged(Bytes packed, int bits, std::mt19937& random) {
  constexpr std::uint64_t kMostBytes = 100'000;
  for (int i = 0; i < bits; ++i) {
    std::uint8_t& byte = packed[random() % packed.size()];
    byte = static_cast<std::uint8_t>(byte ^ (1U << (random() % 8)));
  }
  const auto unpacked = columns::unpack_texts(packed, kMostBytes);
  if (!unpacked) return;
  std::size_t size = 0;
  for (const std::string& text : *unpacked) size += text.size();
  CHECK(size <= kMostBytes);
}

std::size_t packed_size(const std::string& text, TextKind kind) {
  return columns::pack_texts(std::vector<Text>{{kind, text}}).size();
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Features as a sequence has them, with ids, attributes, a surface and vertices.
std::string features(int count) {
  std::mt19937 random(7);
  std::string text;
  for (int i = 0; i < count; ++i) {
    const std::string id = "NL.IMBAG.Pand.05031000000" + std::to_string(10'000 + 7 * i);
    const int x = static_cast<int>(random() % 1'000'000);
    const std::string p = std::to_string(x);
    const std::string q = std::to_string(x + 5'000);
    text +=
        R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{")" + id +
        R"(":{"type":"Building","attributes":{"year":)" + std::to_string(1900 + i % 120) +
        R"(,"height":)" + std::to_string(3 + i % 9) + R"(.5,"roof":"slanted"},"geometry":[{)" +
        R"("type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]}]}},"vertices":{"count":4,)" +
        R"("kind":"integers","solids":[],"others":[)" + p + "," + p + ",0," + q + "," + p + ",0," +
        q + "," + q + ",0," + p + "," + q + ",0]}}\n";
  }
  return text;
}

TEST_CASE("texts come back byte for byte") {
  check_round_trip({});
  check_round_trip({{TextKind::json, ""}, {TextKind::xml, ""}, {TextKind::bytes, ""}});
  for (
      const char* text :
      {"{}",
       "[]",
       "0",
       "\"",
       "\"\"",
       "{\"a\":",
       "{\"a\":1}",
       "[[[1,2],[3,-4.50]],null,true]",
       "  { \"a\" : [ ] }\n",
       R"({"CityObjects":{"a":{"geometry":[{"boundaries":[[0,1,"x",-1,]]}]}}})",
       R"({"vertices":{"count":99999999999999,"kind":0,"solids":[[5,-1,7]],"others":[1,"",2.5,[]]}})",
       R"({"a":"\"\\","b":"\u0000"})",
       "}}}]]]",
       "<a b='c' d=\"e\">1 2 3</a><!-- x --><b/>",
       "<a",
       "<a b=\"",
       "</a></a>text<",
       "1.5 2.5\n3.5",
       "name\n1\t\tab\n2\t\t\n",
       "name\n",
       "name\n\t"}) {
    CAPTURE(text);
    for (const TextKind kind : {TextKind::json, TextKind::xml, TextKind::bytes, TextKind::table}) {
      check_round_trip({{kind, text}, {kind, text}});
    }
  }
}

TEST_CASE("any bytes come back") {
  std::mt19937 random(1);
  constexpr std::string_view kLikely = "{}[],:\"\\<>/ =0123456789.-eabc\n\x01\x02";
  for (int i = 0; i < 300; ++i) {
    std::string text;
    const std::size_t size = random() % 60;
    for (std::size_t j = 0; j < size; ++j) {
      text += random() % 4 == 0 ? static_cast<char>(random() % 256)
                                : kLikely[random() % kLikely.size()];
    }
    const auto kind = static_cast<TextKind>(random() % 4);
    check_round_trip({{kind, text}});
  }
}

TEST_CASE("numbers of every kind come back as they were written") {
  std::string text = "[";
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    const auto mantissa = static_cast<std::int64_t>(random() >> (random() % 60));
    std::string number = std::to_string(random() % 2 == 0 ? mantissa : -mantissa);
    if (random() % 3 == 0) number.append(".").append(std::to_string(random() % 100'000));
    if (random() % 7 == 0) number += "e-5";
    if (random() % 7 == 0) number += ".10";
    text += number + ",";
  }
  text += "-0,-0.0,1E400,9223372036854775807,-9223372036854775808,0.1,0.10000000149011612]";
  for (const TextKind kind : {TextKind::json, TextKind::xml}) check_round_trip({{kind, text}});
  const std::string others = R"({"vertices":{"count":200,"solids":[],"others":)" + text + "}}";
  check_round_trip({{TextKind::json, others}});
}

TEST_CASE("every document of the test data comes back") {
  std::size_t documents = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::source_path("tests/data"))) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".json" && ending != ".jsonl" && ending != ".gml") continue;
    CAPTURE(entry.path().filename().string());
    const std::string text = read_file(entry.path());
    ++documents;
    if (ending == ".gml") {
      check_round_trip({{TextKind::xml, text}});
    } else {
      check_round_trip(lines_of(text, TextKind::json));
    }
  }
  CHECK(documents > 50);
}

TEST_CASE("a thousand features take few bytes each") {
  const std::string text = features(1000);
  const std::vector<Text> lines = lines_of(text, TextKind::json);
  check_round_trip(lines);
  // A place (20 bits for x and y each) and a step of the id are all that is new in a feature.
  CHECK(columns::pack_texts(lines).size() < 9 * 1000);
}

TEST_CASE("digits of a UUID cost four bits each, and nothing the second time") {
  std::mt19937 random(5);
  std::string text = "[";
  for (int i = 0; i < 500; ++i) {
    std::string uuid = "GUID_";
    for (int j = 0; j < 36; ++j) {
      uuid += j == 8 || j == 13 || j == 18 || j == 23 ? '-' : "0123456789ABCDEF"[random() % 16];
    }
    text += "{\"id\":\"" + uuid + "\",\"same\":\"" + uuid + "\"},";
  }
  CHECK(packed_size(text, TextKind::json) < 500 * 33 / 2);
}

TEST_CASE("a counter in an id costs a step, whatever stands around it") {
  std::mt19937 random(4);
  std::string ids = "[";
  int number = 500;
  for (int i = 0; i < 1000; ++i) {
    number += static_cast<int>(random() % 16);
    ids += "\"roof_STAD0158_p1955_" + std::to_string(number) + "-a\",";
  }
  ids.back() = ']';
  check_round_trip({{TextKind::json, ids}});
  CHECK(packed_size(ids, TextKind::json) < 1000 * 6 / 8);
  check_round_trip(
      {{TextKind::json, R"(["a00","a01","a1","a001","a","1a","2a","a9","a10","a00009",)"
                        R"("x999999999999999","x1000000000000000","x0","x9999","x0"])"}});
}

TEST_CASE("floats of 32 bits cost no more than their bits") {
  std::mt19937 random(9);
  std::string text = "[";
  for (int i = 0; i < 1000; ++i) {
    const float value = 5 + static_cast<float>(random() % 1'000'000) / 999'983.0F;
    std::array<char, 40> digits{};
    const int size =
        std::snprintf(digits.data(), digits.size(), "%.17g", static_cast<double>(value));
    double shortest = 0;
    for (int precision = 1; precision <= size; ++precision) {
      std::snprintf(digits.data(), digits.size(), "%.*g", precision, static_cast<double>(value));
      shortest = std::strtod(digits.data(), nullptr);
      if (shortest == static_cast<double>(value)) break;
    }
    text += std::string(digits.data()) + ",";
  }
  CHECK(packed_size(text, TextKind::json) < 1000 * 16 / 5);
}

/// The line of a straight wall over a grid of one unit, as AdV models have it: a position wherever
/// x, y or x - y is whole.
std::string terrain_line(std::mt19937& random) {
  const double x = 280'000 + static_cast<double>(random() % 100'000) / 1000;
  const double y = 5'650'000 + static_cast<double>(random() % 100'000) / 1000;
  const double slope = 0.1 + static_cast<double>(random() % 3000) / 1000;
  std::vector<double> crossings{0};
  for (int i = 1; i <= 60; ++i) {
    crossings.push_back(std::floor(x) + i - x);
    crossings.push_back((std::floor(y) + i - y) / slope);
    crossings.push_back((std::floor(x - y) + i - (x - y)) / (1 - slope));
    crossings.push_back((std::floor(x - y) + 1 - i - (x - y)) / (1 - slope));
  }
  std::sort(crossings.begin(), crossings.end());
  std::string text = "<line><posList>";
  for (const double at : crossings) {
    if (at < 0 || at > 20) continue;
    std::array<char, 80> position{};
    std::snprintf(position.data(), position.size(), "%.3f %.3f %.3f ", x + at, y + slope * at,
                  40 + at / 8);
    text += position.data();
  }
  text.back() = '<';
  return text + "/posList></line>\n";
}

TEST_CASE("a line over a grid of terrain takes little for each position") {
  std::mt19937 random(5);
  std::string text = "<lines>";
  for (int i = 0; i < 40; ++i) text += terrain_line(random);
  text += "</lines>";
  check_round_trip({{TextKind::xml, text}});
  const auto positions = static_cast<std::size_t>(std::count(text.begin(), text.end(), ' ')) / 3;
  REQUIRE(positions > 1500);
  CHECK(packed_size(text, TextKind::xml) < 2 * positions);
}

TEST_CASE("a line along a wall that another line had takes next to nothing") {
  std::mt19937 random(6);
  std::vector<std::string> wall;
  for (int i = 0; i < 500; ++i) {
    std::array<char, 80> position{};
    std::snprintf(position.data(), position.size(), "%.3f %.3f %.3f ",
                  static_cast<double>(random() % 1'000'000) / 1000,
                  static_cast<double>(random() % 1'000'000) / 1000,
                  static_cast<double>(random() % 50'000) / 1000);
    wall.emplace_back(position.data());
  }
  const auto line = [&] {
    std::string text = "<line>";
    for (const std::string& position : wall) text += position;
    return text + "</line>\n";
  };
  const std::string once = "<lines><line>0.125 0 0 1 0 0</line>" + line();
  std::reverse(wall.begin(), wall.end());
  const std::string twice = once + line() + "</lines>";
  check_round_trip({{TextKind::xml, twice}});
  const std::size_t first = packed_size(once, TextKind::xml);
  CHECK(packed_size(twice, TextKind::xml) - first < first / 10);
}

TEST_CASE("lists of positions come back, whatever is in them") {
  check_round_trip({{TextKind::xml,
                     "<a><p>1 2 3 4 5 6</p><p>1.5 2 x</p><p>1 2 3</p><p>9e9 -0 1 2 3 4</p>"
                     "<p>999999999999999999 -999999999999999999 1 -999999999999999999 "
                     "999999999999999999 1 999999999999999999 0.000000000001 1</p>"
                     "<p>1 2</p><p>1 2 3 4 5</p><p>0 0 0 1 0 0 2 0 0 3 0 0</p><p></p></a>"}});
  std::mt19937 random(3);
  for (int i = 0; i < 40; ++i) {
    std::string text = "<a>";
    for (int list = 0; list < 20; ++list) {
      text += "<p>";
      for (auto n = random() % 14; n > 0; --n) {
        const auto digits = static_cast<int>(random() % 4);
        std::array<char, 80> number{};
        std::snprintf(number.data(), number.size(), "%.*f ", digits,
                      static_cast<double>(random() % 20'000) / 100 - 100);
        text += number.data();
      }
      text += "</p>";
    }
    check_round_trip({{TextKind::xml, text + "</a>"}});
  }
}

TEST_CASE("values under different names are of different columns") {
  std::mt19937 random(9);
  std::array<std::string, 2> texts;
  for (int i = 0; i < 400; ++i) {
    for (int name = 0; name < 4; ++name) {
      const std::string value = std::to_string(name * 100'000 + static_cast<int>(random() % 30));
      const std::string is = std::string("v").append(std::to_string(name));
      texts[0] += "<s name=\"" + is + "\"><value>" + value + "</value></s>\n";
      texts[1] += "<s>" + is + "<value>" + value + "</value></s>\n";
    }
  }
  check_round_trip({{TextKind::xml, texts[0]}, {TextKind::xml, texts[1]}});
  CHECK(packed_size(texts[0], TextKind::xml) * 10 < packed_size(texts[1], TextKind::xml) * 9);
}

TEST_CASE("a ring of many vertices comes back, in time that grows with its length") {
  std::mt19937 random(13);
  std::string text = R"({"boundaries":[[)";
  for (int i = 0; i < 20'000; ++i) text += std::to_string(random() % 100'000) + ",";
  check_round_trip({{TextKind::json, text}});
}

/// Lists of numbers that repeat at a distance: columns see no more than numbers in them.
std::string repeated_lists() {
  std::mt19937 random(19);
  std::string list;
  for (int i = 0; i < 500; ++i) list += std::to_string(random() % 10) + ",";
  std::string text;
  for (int i = 0; i < 60; ++i) text += "{\"a\":[" + list + "0]}\n";
  return text;
}

TEST_CASE("texts that repeat and have no columns take what a general compressor takes") {
  const std::string text = repeated_lists();
  CHECK(packed_size(text, TextKind::json) < 500);
  check_round_trip(lines_of(text, TextKind::json));
}

TEST_CASE("a plain text that is cut, longer than allowed or damaged is an error or another text") {
  const std::string text = repeated_lists();
  const Bytes packed = columns::pack_texts(lines_of(text, TextKind::json));
  REQUIRE(packed[0] % 4 == 1);
  for (std::size_t size = 0; size < packed.size(); ++size)
    CHECK_FALSE(columns::unpack_texts(ByteView(packed).first(size), 1'000'000));
  Bytes longer = packed;
  longer.push_back(0);
  CHECK_FALSE(columns::unpack_texts(longer, 1'000'000));
  std::uint64_t bytes = 0;
  for (const Text& line : lines_of(text, TextKind::json)) bytes += line.text.size();
  const auto refused = columns::unpack_texts(packed, bytes - 1);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(columns::unpack_texts(packed, bytes));
  std::mt19937 random(23);
  for (int i = 0; i < 2000; ++i) check_damaged(packed, 1, random);
}

TEST_CASE("a long list of numbers in XML is taken apart in time that grows with its length") {
  std::mt19937 random(29);
  std::string text = "<posList>";
  for (int i = 0; i < 300'000; ++i) text += std::to_string(random() % 10) + ' ';
  check_round_trip({{TextKind::xml, text + "</posList>"}});
}

/// The seconds that it takes to pack and read positions whose x are multiples of a number.
double seconds_for_multiples(std::int64_t number) {
  std::string text = "<l><p>0 0 0 1 1 1</p><p>";
  for (std::int64_t i = 0; i < 70'000; ++i) text += std::to_string(number * i) + " 0 0 ";
  const auto begin = std::chrono::steady_clock::now();
  check_round_trip({{TextKind::xml, text + "</p></l>"}});
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST_CASE(
    "coordinates that a usual hash table would put into one place take no longer than others") {
  constexpr std::int64_t kBuckets = 85'229;
  CHECK(seconds_for_multiples(kBuckets) < 1 + 10 * seconds_for_multiples(kBuckets + 1));
}

TEST_CASE("damaged bytes give an error or other texts, in bounds") {
  const std::string text = features(20);
  const Bytes packed = columns::pack_texts(lines_of(text, TextKind::json));
  std::size_t refused = 0;
  for (std::size_t size = 0; size < packed.size(); ++size) {
    if (!columns::unpack_texts(ByteView(packed).first(size), 1'000'000)) ++refused;
  }
  CHECK(refused + 5 > packed.size());  // few prefixes are packed texts too: others, which end early
  std::mt19937 random(11);
  std::string lines = "<lines><s name=\"b\">a1 b9999</s><s name=\"b\">a1 b10000</s>";
  for (int i = 0; i < 20; ++i) lines += terrain_line(random);
  const Bytes packed_lines = columns::pack_texts(std::vector<Text>{{TextKind::xml, lines}});
  for (int i = 0; i < 4000; ++i) check_damaged(i % 2 == 0 ? packed : packed_lines, 3, random);
}

TEST_CASE("more texts than bytes can stand for are refused") {
  const auto count_of = [](std::uint64_t head) {
    ByteWriter writer;
    writer.varint(head);
    for (int i = 0; i < 8; ++i) writer.u8(0);
    return std::move(writer).bytes();
  };
  for (const std::uint64_t count : {std::uint64_t{1} << 20U, std::uint64_t{1} << 61U}) {
    CHECK_FALSE(columns::unpack_texts(count_of(4 * count), kNoLimit));
    CHECK_FALSE(columns::unpack_texts(count_of(4 * count + 1), kNoLimit));
  }
  check_round_trip(std::vector<Text>(200'000));
}

TEST_CASE("texts beyond the limit are refused") {
  const std::string text = features(50);
  const Bytes packed = columns::pack_texts(lines_of(text, TextKind::json));
  const auto refused = columns::unpack_texts(packed, text.size() / 2);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(columns::unpack_texts(packed, text.size()));
}

TEST_CASE("texts may have exactly the bytes of the limit") {
  for (const std::string& text : {std::string(), std::string("a"), std::string(R"({"new":[1]} )"),
                                  std::string("<new a=\"1\"> </new>"), std::string(5000, ' ')}) {
    for (const TextKind kind : {TextKind::bytes, TextKind::json, TextKind::xml, TextKind::table}) {
      const Bytes packed = columns::pack_texts(std::vector<Text>{{kind, text}});
      CHECK(columns::unpack_texts(packed, text.size()));
      CHECK((text.empty() || !columns::unpack_texts(packed, text.size() - 1)));
    }
  }
}

TEST_CASE("repetitions in strings take a number, whatever their length") {
  const std::string part = "The quick brown fox jumps over the lazy dog, and 4711 others. ";
  for (const std::size_t size :
       {std::size_t{4095}, std::size_t{4104}, std::size_t{4105}, std::size_t{100'000}}) {
    CAPTURE(size);
    std::string text;
    while (text.size() < size) text += part;
    text.resize(size);
    check_round_trip({{TextKind::bytes, text}, {TextKind::bytes, text + '!'}});
    CHECK(packed_size(text, TextKind::bytes) < 100 + size / 1000);
  }
  std::string zeros = part + part;
  zeros[part.size() + 20] = '\0';
  check_round_trip({{TextKind::bytes, zeros}, {TextKind::bytes, zeros + zeros}});
}

TEST_CASE("coordinates with an exponent are predicted as others are") {
  std::string plain = R"({"vertices":{"count":400,"others":[)";
  std::string scaled = plain;
  for (int i = 0; i < 1200; ++i) {
    const std::string number = std::to_string(28'155'563 + 10 * (i * i % 977) + 1);
    plain += number + ',';
    scaled += number + "e-2,";
  }
  plain.back() = ']';
  scaled.back() = ']';
  plain += "}}";
  scaled += "}}";
  check_round_trip({{TextKind::json, scaled}});
  CHECK(packed_size(scaled, TextKind::json) < packed_size(plain, TextKind::json) + 50);
}

}  // namespace
std::shared_ptr<const columns::Examples> examples_of(const std::vector<Text>& texts) {
  auto examples = columns::Examples::of(columns::Examples::pack_examples(texts), 1'000'000);
  REQUIRE(examples);
  return *examples;
}

TEST_CASE(
    "a text like the examples takes few bytes, and each is packed as if it were the only one") {
  const auto text_of = [](int number) {
    std::string text = R"({"type":"Building","attributes":{"roof_material":"slate","height":)";
    return text.append(std::to_string(number)).append(R"(,"ids":["a","b"]}})");
  };
  std::vector<std::string> texts;
  for (int i = 0; i < 12; ++i) texts.push_back(text_of(i * 37));
  std::vector<columns::Text> views;
  for (const std::string& text : texts) views.push_back({columns::TextKind::json, text});
  const auto examples = examples_of(views);
  const auto none = examples_of({});
  const std::string text = text_of(1234);
  const Bytes packed = examples->pack({columns::TextKind::json, text});
  CHECK(packed.size() < 6);
  CHECK(none->pack({columns::TextKind::json, text}).size() > 4 * packed.size());
  CHECK(*examples->unpack(packed, 1000) == text);
  const std::string other = R"({"another":["text",1.5,"0f8fad5b-d9cb-469f-a165-70867728950e"]})";
  const Bytes other_packed = examples->pack({columns::TextKind::json, other});
  CHECK(*examples->unpack(other_packed, 1000) == other);
  CHECK(examples->pack({columns::TextKind::json, text}) == packed);
  CHECK(*examples->unpack(packed, 1000) == text);
  CHECK(examples->unpack(packed, 20).error().code == ErrorCode::limit_exceeded);
  for (std::size_t size = 0; size < packed.size(); ++size) {
    const auto cut = examples->unpack(ByteView(packed).first(size), 1000);
    CHECK((!cut || *cut != text));
  }
}

}  // namespace watertight
