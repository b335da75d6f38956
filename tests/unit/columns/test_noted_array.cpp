// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/noted_array.h"

#include <catch2/catch_test_macros.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "columns/columns.h"
#include "columns/flat_map.h"
#include "columns/value_table.h"

namespace watertight {
namespace {

using columns::Examples;
using columns::FlatMap;
using columns::NotedArray;
using columns::Text;
using columns::TextKind;
using columns::ValueTable;

constexpr std::uint64_t kMostOut = 1'000'000;

std::vector<int> elements_of(const NotedArray<int>& array) {
  std::vector<int> elements;
  for (std::size_t i = 0; i < array.size(); ++i) elements.push_back(array[i]);
  return elements;
}

TEST_CASE("a copy of an array that changed anywhere becomes equal to its original") {
  std::mt19937 random(5);
  for (const std::size_t size : {0U, 1U, 15U, 16U, 17U, 1000U}) {
    NotedArray<int> original(size, 7);
    for (std::size_t i = 0; i < size; i += 3) original.change(i) = static_cast<int>(i);
    NotedArray<int> copy = original;
    for (int round = 0; round < 50; ++round) {
      for (int i = 0; i < 20 && size > 0; ++i) copy.change(random() % size) = -1;
      for (int i = 0; i < round % 40; ++i) copy.push_back(i);
      if (round % 5 == 0 && copy.size() > 0) copy.change(copy.size() - 1) = -2;
      if (round % 7 == 0) copy.replace(std::vector<int>(random() % 40, -3));
      if (round % 14 == 0) copy.push_back(-4);
      copy.revert(original);
      CHECK(elements_of(copy) == elements_of(original));
    }
  }
}

TEST_CASE("a copy of a map or table that grew becomes equal to its original") {
  std::mt19937 random(6);
  FlatMap<std::uint32_t, int> map;
  ValueTable table;
  for (std::uint32_t i = 0; i < 20; ++i) {
    map[i * 977] = static_cast<int>(i);
    table.add("text " + std::to_string(i));
  }
  FlatMap<std::uint32_t, int> map_copy = map;
  ValueTable table_copy = table;
  for (const int more : {1, 3, 300, 2, 0, 5000, 4}) {
    for (int i = 0; i < more; ++i) {
      map_copy[static_cast<std::uint32_t>(random())] = -1;
      map_copy[977] = -2;
      table_copy.add("other " + std::to_string(random() % 1000));
    }
    map_copy.revert(map);
    table_copy.revert(table);
    CHECK(map_copy.size() == 20);
    CHECK(table_copy.size() == 20);
    for (std::uint32_t i = 0; i < 20; ++i) {
      REQUIRE(map_copy.find(i * 977) != nullptr);
      CHECK(*map_copy.find(i * 977) == static_cast<int>(i));
      CHECK(table_copy.find("text " + std::to_string(i)) == i);
      CHECK(table_copy.text(i) == "text " + std::to_string(i));
      CHECK_FALSE(table_copy.find("other " + std::to_string(i)));
    }
  }
}

std::string text_at(int number) {
  std::string text = R"({"type":"CityJSONFeature","id":"building )" + std::to_string(number * 31) +
                     R"(","attributes":{"height":)" + std::to_string(number % 9) + R"(.25,"u":")";
  text += "0f8fad5b-d9cb-469f-a165-" + std::to_string(708'677'289'500 + number) + R"(","list":[)";
  for (int i = 0; i <= number; ++i) text += std::to_string(i * i) + ",";
  return text + R"(0],"boundaries":[[[0,1,2]]],"vertices":{"count":3,"others":[1.5,2,3,4,5,6,7]}})";
}

TEST_CASE("the bytes of a text do not depend on what its thread packed or read before") {
  std::vector<std::string> texts;
  for (int i = 0; i < 60; i += 4) texts.push_back(text_at(i));
  std::vector<Text> learned;
  for (std::size_t i = 0; i < texts.size(); i += 2) learned.push_back({TextKind::json, texts[i]});
  const auto none = *Examples::of(Examples::pack_examples({}), 0);
  const auto some = *Examples::of(Examples::pack_examples(learned), kMostOut);
  std::vector<Bytes> alone;  // each packed by a thread of its own
  for (const std::string& text : texts) {
    for (const auto& examples : {none, some}) {
      std::thread([&] { alone.push_back(examples->pack({TextKind::json, text})); }).join();
    }
  }
  std::mt19937 random(9);
  for (int round = 0; round < 400; ++round) {
    const std::size_t which = random() % alone.size();
    const auto& examples = which % 2 == 0 ? none : some;
    const std::string& text = texts[which / 2];
    Bytes damaged = alone[which];
    damaged[random() % damaged.size()] ^= 4;
    if (round % 3 == 0) static_cast<void>(examples->unpack(damaged, kMostOut));
    if (round % 5 == 0) CHECK_FALSE(examples->unpack(alone[which], text.size() / 2));
    CHECK(examples->pack({TextKind::json, text}) == alone[which]);
    const auto back = examples->unpack(alone[which], kMostOut);
    REQUIRE(back);
    CHECK(*back == text);
  }
}

}  // namespace
}  // namespace watertight
