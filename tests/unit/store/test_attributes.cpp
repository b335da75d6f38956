// SPDX-License-Identifier: GPL-3.0-or-later
//
// Chosen attributes: which values are kept, when, and what queries find. The text of a feature is a
// line "name|object|type|value" for each value.
#include <algorithm>
#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "fixture.h"
#include "tests/unit/pipeline/filter_oracle.h"

namespace watertight::test_attributes {
using store::AttributeCondition;
using store::Comparison;
using test::Database;
using test::sample_feature;
using Type = AttributeValue::Type;

namespace {

Result<std::vector<store::FeatureAttribute>> read_lines(const StoredFeature& feature,
                                                        std::span<const std::string> names) {
  std::vector<store::FeatureAttribute> values;
  std::istringstream lines(std::string(as_text(feature.skeleton.bytes)));
  for (std::string name, object, type, value;
       std::getline(lines, name, '|') && std::getline(lines, object, '|') &&
       std::getline(lines, type, '|') && std::getline(lines, value);) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) continue;
    const Type of = type == "number" ? Type::number : type == "text" ? Type::text : Type::truth;
    values.push_back({object, static_cast<std::size_t>(found - names.begin()), {of, value}});
  }
  return values;
}

std::unique_ptr<SolidStore> open(const Database& database) {
  auto opened = store::open_postgres_store(database.connection(), 4, {}, {}, read_lines);
  REQUIRE(opened);
  return std::move(*opened);
}

StoredFeature feature(const std::string& id, const std::string& lines) {
  StoredFeature made = sample_feature(id);
  const ByteView text = as_bytes(lines);
  made.skeleton.bytes.assign(text.begin(), text.end());
  return made;
}

std::string line(const std::string& name, const std::string& object, const std::string& type,
                 const std::string& value) {
  return std::string(name).append("|").append(object).append("|").append(type).append("|").append(
      value + "\n");
}

void put(SolidStore& store, const std::vector<StoredFeature>& features) {
  const auto versions = store.put(features);
  INFO((versions ? std::string() : to_string(versions.error())));
  REQUIRE(versions);
}

void choose(SolidStore& store, const store::AttributeChange& change) {
  const Status changed = store.change_attributes("buildings", change);
  INFO((changed ? std::string() : to_string(changed.error())));
  REQUIRE(changed);
}

AttributeCondition number(const std::string& name, Comparison comparison,
                          const std::string& digits) {
  return {name, comparison, {{Type::number, digits}}};
}

AttributeCondition text(const std::string& name, Comparison comparison, const std::string& value) {
  return {name, comparison, {{Type::text, value}}};
}

/// The ids of the features for which the conditions hold, sorted and separated by spaces; by pages
/// of 2, and the same by a walk.
std::string found(SolidStore& store, const std::vector<AttributeCondition>& where) {
  std::vector<std::string> ids;
  store::FeatureQuery query{"buildings", 2, {}, {}, 0, {}, where};
  do {
    const auto page = store.list(query);
    INFO((page ? std::string() : to_string(page.error())));
    REQUIRE(page);
    for (const store::FeatureSummary& summary : page->features) ids.push_back(summary.id);
    query.after = page->next;
  } while (!query.after.empty());
  std::vector<std::string> walked;
  std::string after;
  do {
    const auto batch = store.walk("buildings", 2, after, store::filter_of(where));
    REQUIRE(batch);
    for (const StoredFeature& feature : batch->features) walked.push_back(feature.id);
    after = batch->next;
  } while (!after.empty());
  std::sort(ids.begin(), ids.end());
  std::sort(walked.begin(), walked.end());
  CHECK(ids == walked);
  std::string joined;
  for (const std::string& id : ids) joined.append(joined.empty() ? "" : " ").append(id);
  return joined;
}

std::string values_of(const Database& database) {
  return database.ask("SELECT count(*)::text FROM watertight.attribute_value");
}

}  // namespace

TEST_CASE("values are kept only of chosen attributes, by stores that can read them") {
  const Database database;
  const auto plain = database.store();
  put(*plain, {feature("a", line("height", "a", "number", "3"))});
  CHECK(values_of(database) == "0");
  CHECK(plain->attributes("buildings")->empty());
  CHECK(plain->attributes("none").error().code == ErrorCode::not_found);
  CHECK(plain->change_attributes("none", {{"height"}, {}}).error().code == ErrorCode::not_found);
  CHECK(plain->change_attributes("buildings", {{}, {"height"}}).error().code ==
        ErrorCode::not_found);
  const auto store = open(database);
  choose(*store, {{"height"}, {}});
  CHECK(values_of(database) == "1");
  CHECK(plain->put(std::vector{feature("b", "")}).error().code == ErrorCode::unsupported);
  const auto chosen = plain->attributes("buildings");
  REQUIRE(chosen);
  REQUIRE(chosen->size() == 1);
  CHECK(chosen->front().name == "height");
  CHECK(chosen->front().is_complete());
  CHECK(chosen->front().has_numbers);
  CHECK_FALSE(chosen->front().has_texts);
}

TEST_CASE("values follow their features: put, replaced, removed") {
  const Database database;
  const auto store = open(database);
  put(*store, {feature("a", line("height", "a", "number", "3")),
               feature("b", line("height", "b-part", "number", "4"))});
  choose(*store, {{"height"}, {}});
  CHECK(found(*store, {number("height", Comparison::equal, "3")}) == "a");
  CHECK(found(*store, {number("height", Comparison::at_least, "3")}) == "a b");
  put(*store, {feature("a", line("height", "a", "number", "5")),
               feature("c", line("height", "x", "number", "3"))});
  CHECK(found(*store, {number("height", Comparison::equal, "3")}) == "c");
  CHECK(found(*store, {number("height", Comparison::greater, "3")}) == "a b");
  CHECK(database.ask("SELECT string_agg(feature || ' ' || object || ' ' || value, ', ' ORDER BY 1)"
                     " FROM (SELECT * FROM watertight.attribute ORDER BY feature) a") ==
        "a a 5, b b-part 4, c x 3");
  REQUIRE(store->remove("buildings", "b"));
  CHECK(values_of(database) == "2");
  REQUIRE(store->rename_collection("buildings", "town"));
  CHECK(database.ask("SELECT count(*)::text FROM watertight.attribute WHERE collection = 'town'") ==
        "2");
  REQUIRE(store->remove_collection("town", {}));
  CHECK(values_of(database) == "0");
  CHECK(database.ask("SELECT count(*)::text FROM watertight.attribute_name") == "0");
}

TEST_CASE("numbers compare exactly, and the largest that are kept are known") {
  const Database database;
  const auto store = open(database);
  put(*store, {feature("a", line("n", "a", "number", "9007199254740993")),
               feature("b", line("n", "b", "number", "9007199254740992")),
               feature("c", line("n", "c", "number", "0.10")),
               feature("d", line("n", "d", "number", "-1E+400")),
               feature("e", line("n", "e", "number", "1e1001")),
               feature("f", line("n", "f", "number", "1e99999999999999999999")),
               feature("g", line("n", "g", "number", std::string(1001, '7'))),
               feature("h", line("n", "h", "text", "0.1"))});
  choose(*store, {{"n"}, {}});
  CHECK(found(*store, {number("n", Comparison::equal, "9007199254740993")}) == "a");
  CHECK(found(*store, {number("n", Comparison::equal, "9007199254740992.0")}) == "b");
  CHECK(found(*store, {number("n", Comparison::equal, "1e-1")}) == "c");
  CHECK(found(*store, {number("n", Comparison::less, "0")}) == "d");
  CHECK(found(*store, {number("n", Comparison::at_most, "1e1000")}) == "a b c d");
  CHECK(found(*store, {number("n", Comparison::equal, "1e1001")}) == "");
  CHECK(found(*store, {{"n", Comparison::equal, {{Type::text, "0.1"}, {Type::number, "0.1"}}}}) ==
        "c h");
}

TEST_CASE("texts compare by their bytes, however long they are and whatever is in them") {
  const Database database;
  const auto store = open(database);
  const std::string quoted = "it's \"x\"; DROP TABLE watertight.feature_row; -- \\ $1 %s";
  const std::string name = "na'me\" über.\xF0\x9F\x8F\xA0";
  std::string longer(3 << 20, 'x');
  std::string other = longer;
  other.back() = 'y';
  put(*store,
      {feature("a", line(name, "a", "text", quoted)), feature("b", line(name, "b", "text", longer)),
       feature("c", line(name, "c", "text", other)),
       feature("d", line(name, "d", "text", "\xF0\x9F\x8F\xA0")),
       feature("e", line(name, "e", "text", "Zebra") + line(name, "e", "text", "ape")),
       feature("f", line(name, "f", "text", std::string("a\0b", 3))),
       feature("g", line(name, "g", "text", "\xFF"))});
  choose(*store, {{name}, {}});
  const auto equal = [&](const std::string& value) {
    return found(*store, {text(name, Comparison::equal, value)});
  };
  CHECK(equal(quoted) == "a");
  CHECK(equal(longer) == "b");
  CHECK(equal(other) == "c");
  CHECK(equal("\xF0\x9F\x8F\xA0") == "d");
  CHECK(equal("ape") == "e");
  CHECK(equal(std::string("a\0b", 3)) == "");
  CHECK(found(*store, {text(name, Comparison::less, "a")}) == "e");
  CHECK(values_of(database) == "6");
  for (const std::string& wrong :
       {std::string(), std::string("a\0b", 3), std::string("\xC3"), std::string(1025, 'a')}) {
    CHECK(store->change_attributes("buildings", {{wrong}, {}}).error().code ==
          ErrorCode::invalid_argument);
  }
}

TEST_CASE("conditions must all hold, with a box and with other restrictions") {
  const Database database;
  const auto store = open(database);
  StoredFeature far = feature("far", line("n", "", "number", "1") + line("t", "", "truth", "true"));
  far.box = store::StoredBox{{100, 100, 0}, {101, 101, 1}};
  put(*store, {feature("a", line("n", "a", "number", "1") + line("t", "a", "truth", "false")),
               feature("b", line("n", "b", "number", "1") + line("t", "b", "truth", "true")), far});
  choose(*store, {{"t", "n"}, {}});
  const AttributeCondition one = number("n", Comparison::equal, "1");
  const AttributeCondition is_true{"t", Comparison::equal, {{Type::truth, "true"}}};
  CHECK(found(*store, {one}) == "a b far");
  CHECK(found(*store, {one, is_true}) == "b far");
  for (const double share : {0.0, 0.5, 1.0}) {
    const auto page = store->list(
        {"buildings", 10, {}, store::StoredBox{{0, 0, 0}, {2, 2, 2}}, share, true, {one, is_true}});
    REQUIRE(page);
    REQUIRE(page->features.size() == 1);
    CHECK(page->features[0].id == "b");
  }
  const auto refused = store->list({"buildings", 10, {}, {}, 0, {}, {one, text("x", {}, "1")}});
  REQUIRE(!refused);
  CHECK(refused.error().code == ErrorCode::invalid_argument);
  CHECK(refused.error().message.find("'x'") != std::string::npos);
  CHECK(refused.error().message.find("not chosen") != std::string::npos);
  const std::vector<AttributeCondition> many(store::kMostConditions + 1, one);
  CHECK(store->list({"buildings", 1, {}, {}, 0, {}, many}).error().code ==
        ErrorCode::invalid_argument);
}

TEST_CASE("a filling that was broken off is not announced, and goes on") {
  const Database database;
  const auto store = open(database);
  std::vector<StoredFeature> features;
  for (int i = 0; i < 1200; ++i) {
    const std::string id = "f" + std::to_string(i);
    features.push_back(feature(id, line("n", id, "number", std::to_string(i % 100))));
  }
  put(*store, features);
  int batches = 0;
  const Status stopped = store->change_attributes(
      "buildings", {{"n"}, {}}, [&] { return batches > 0; }, [&](double) { ++batches; });
  CHECK(stopped.error().code == ErrorCode::cancelled);
  CHECK(values_of(database) == "200");
  const auto chosen = store->attributes("buildings");
  REQUIRE(chosen->size() == 1);
  CHECK(chosen->front().share > 0.05);
  CHECK(chosen->front().share < 0.5);
  const AttributeCondition condition = number("n", Comparison::equal, "42");
  const auto early = store->list({"buildings", 10, {}, {}, 0, {}, {condition}});
  REQUIRE(!early);
  CHECK(early.error().message.find("filled in") != std::string::npos);
  CHECK(database.ask("SELECT count(*)::text FROM watertight.attribute") == "0");
  // What is written meanwhile is right, before and after the place where the filling stopped.
  put(*store, {feature("f1", line("n", "f1", "number", "42")), feature("f42", "")});
  choose(*store, {{"m"}, {}});
  CHECK(store->list({"buildings", 20, {}, {}, 0, {}, {condition}})->features.size() == 12);
  CHECK(values_of(database) == "1199");
  choose(*store, {{}, {"n"}});
  CHECK(values_of(database) == "0");
  CHECK(store->attributes("buildings")->size() == 1);
}

TEST_CASE("writers and a filling at the same time leave the values of the last texts") {
  const Database database;
  const auto store = open(database);
  constexpr int kFeatures = 1500;
  const auto made = [](int i, int round) {
    const std::string id = "f" + std::to_string(i);
    return feature(id, line("n", id, "number", std::to_string(round)));
  };
  std::vector<StoredFeature> features;
  for (int i = 0; i < kFeatures; ++i) features.push_back(made(i, 0));
  put(*store, features);
  std::atomic<bool> is_over = false;
  std::atomic<int> failures = 0;
  std::vector<std::thread> writers;
  for (int writer = 0; writer < 3; ++writer) {
    writers.emplace_back([&, writer] {
      for (int round = 1; !is_over || round < 3; ++round) {
        std::vector<StoredFeature> some;
        for (int i = writer; i < kFeatures; i += 37) some.push_back(made(i, round * 10 + writer));
        if (!store->put(some)) ++failures;
        if (!store->remove("buildings", "f" + std::to_string(kFeatures - 1 - writer)) &&
            round == 1) {
          ++failures;
        }
      }
    });
  }
  for (int round = 0; round < 3; ++round) {
    choose(*store, {{"n"}, {}});
    choose(*store, {{}, {"n"}});
  }
  choose(*store, {{"n"}, {}});
  is_over = true;
  for (std::thread& writer : writers) writer.join();
  CHECK(failures == 0);
  CHECK(database.ask(
            "SELECT count(*)::text FROM watertight.feature_row f FULL JOIN"
            " watertight.attribute_value v ON v.feature = hashtextextended(f.id, 0)"
            " WHERE f.id IS NULL OR v.feature IS NULL OR v.number::text <>"
            " split_part(trim(E'\\n' from convert_from(f.packed_text, 'UTF8')), '|', 4)") == "0");
}

TEST_CASE("queries of the view use the indexes") {
  const Database database;
  const auto store = open(database);
  database.add_many_features();
  database.ask(
      "INSERT INTO watertight.attribute_name (key, collection, name, is_complete)"
      " VALUES (1, 1, 'n', true), (2, 1, 't', true), (3, 1, 'b', true)");
  database.ask(
      "INSERT INTO watertight.attribute_value (feature, attribute, number, text, truth)"
      " SELECT hashtextextended(i::text, 0), a, CASE WHEN a = 1 THEN i END,"
      " CASE WHEN a = 2 THEN 'x' || i END, CASE WHEN a = 3 THEN i % 5000 = 0 END"
      " FROM generate_series(1, 20000) i, generate_series(1, 3) a");
  database.ask("ANALYZE");
  for (const auto& [condition, index] :
       std::vector<std::pair<std::string, std::string>>{{"name = 'n' AND number = 17", "number"},
                                                        {"name = 'n' AND number >= 17 AND number <"
                                                         " 19.5",
                                                         "number"},
                                                        {"name = 't' AND text = 'x17'", "text"},
                                                        {"name = 'b' AND truth", "truth"}}) {
    const std::string query =
        "SELECT feature FROM watertight.attribute WHERE collection = 'c' AND " + condition;
    const std::string plan = database.ask("EXPLAIN (FORMAT JSON) " + query);
    INFO(plan);
    CHECK(plan.find("\"attribute_" + index + "\"") != std::string::npos);
    CHECK(plan.find("Seq Scan\",\n              \"Relation Name\": \"attribute_value") ==
          std::string::npos);
    CHECK(!database.ask("SELECT string_agg(feature, ' ') FROM (" + query + ") q").empty());
  }
}

namespace {

/// A random filter over the attributes a, b and c, of at most so many levels.
store::Filter random_filter(std::mt19937& random, int levels) {
  using Kind = store::Filter::Kind;
  const auto value = [&] {
    const int choice = static_cast<int>(random() % 3);
    if (choice == 0) return AttributeValue{Type::number, std::to_string(random() % 4)};
    if (choice == 1) return AttributeValue{Type::truth, random() % 2 == 0 ? "true" : "false"};
    return AttributeValue{Type::text,
                          std::string(1 + random() % 2, static_cast<char>('x' + random() % 3))};
  };
  const auto kind = static_cast<Kind>(levels == 0 ? 3 + random() % 6 : random() % 9);
  store::Filter filter{kind};
  switch (kind) {
    case Kind::all:
    case Kind::any:
      for (int i = 0; i < 2; ++i) filter.parts.push_back(random_filter(random, levels - 1));
      break;
    case Kind::no:
      filter.parts.push_back(random_filter(random, levels - 1));
      break;
    case Kind::box:
      for (std::size_t axis = 0; axis < 3; ++axis) {
        filter.box.min[axis] = static_cast<double>(random() % 12);
        filter.box.max[axis] = filter.box.min[axis] + static_cast<double>(random() % 4);
      }
      break;
    case Kind::constant:
      filter.truth = random() % 2 == 0;
      break;
    default:
      filter.name = std::string(1, static_cast<char>('a' + random() % 3));
      filter.comparison = static_cast<Comparison>(random() % 6);
      filter.values = {value(), value()};
      if (kind == Kind::like) {
        constexpr const char* kPatterns[] = {"x%", "_", "%y", "__", "%", "x\\%", "z_"};
        filter.values = {{Type::text, kPatterns[random() % std::size(kPatterns)]}};
      }
  }
  return filter;
}

}  // namespace

TEST_CASE("a filter selects the features for which it is true, by SQL as by another way") {
  const Database database;
  const auto store = open(database);
  std::mt19937 random(11);
  std::vector<StoredFeature> features;
  std::map<std::string, samples::Values> values;
  for (int i = 0; i < 60; ++i) {
    const std::string id = "f" + std::to_string(i);
    std::string lines;
    for (auto count = random() % 5; count > 0; --count) {
      const std::string name(1, static_cast<char>('a' + random() % 3));
      const auto type = static_cast<Type>(random() % 3);
      const std::string text =
          type == Type::number ? std::to_string(random() % 4)
          : type == Type::truth
              ? (random() % 2 == 0 ? "true" : "false")
              : std::string(1 + random() % 2, static_cast<char>('x' + random() % 3));
      const char* words[] = {"number", "text", "truth"};
      lines += line(name, id + "-" + std::to_string(count), words[static_cast<int>(type)], text);
      values[id][name].push_back({type, text});
    }
    features.push_back(feature(id, lines));
    const double place = i % 11;
    if (i % 7 != 0) features.back().box = {{place, place / 2, 0}, {place + 1, place, 3}};
    if (i % 7 == 0) features.back().box.reset();
  }
  put(*store, features);
  choose(*store, {{"a", "b", "c"}, {}});
  for (int i = 0; i < 400; ++i) {
    const store::Filter filter = random_filter(random, 3);
    store::FeatureQuery query;
    query.collection = "buildings";
    query.limit = 100;
    query.filter = filter;
    const auto page = store->list(query);
    REQUIRE(page);
    std::set<std::string> found;
    for (const auto& summary : page->features) found.insert(summary.id);
    for (const StoredFeature& each : features) {
      INFO("filter " << i << ", feature " << each.id);
      const bool is_true = samples::truth_of(filter, values[each.id], each.box).value_or(false);
      CHECK(found.contains(each.id) == is_true);
    }
  }
  store::Filter unknown{store::Filter::Kind::is_null, {}, "d"};
  store::FeatureQuery query;
  query.collection = "buildings";
  query.limit = 100;
  query.filter = unknown;
  CHECK(store->list(query).error().code == ErrorCode::invalid_argument);
  query.filter = store::Filter{store::Filter::Kind::like, {}, "a"};
  query.filter->values = {{Type::text, std::string("%\0x", 3)}};
  CHECK(store->list(query)->features.empty());
  store::Filter deep{};
  for (int i = 0; i < 40; ++i) {
    store::Filter outer{store::Filter::Kind::no};
    outer.parts.push_back(deep);
    deep = outer;
  }
  query.filter = deep;
  CHECK(store->list(query).error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("a list can be in the order of an attribute, each feature once") {
  const Database database;
  const auto store = open(database);
  std::mt19937 random(5);
  std::vector<StoredFeature> features;
  std::map<std::string, std::vector<AttributeValue>> values;
  for (int i = 0; i < 80; ++i) {
    const std::string id = "f" + std::to_string(i);
    std::string lines;
    for (auto count = random() % 4; count > 0; --count) {
      const auto type = static_cast<Type>(random() % 3);
      const std::string text = type == Type::number  ? std::to_string(random() % 9) + ".50"
                               : type == Type::truth ? (random() % 2 == 0 ? "true" : "false")
                                                     : std::string(1 + random() % 3, 'x');
      const char* words[] = {"number", "text", "truth"};
      lines += line("a", id + "-" + std::to_string(count), words[static_cast<int>(type)], text);
      values[id].push_back({type, text});
    }
    features.push_back(feature(id, lines));
  }
  put(*store, features);
  choose(*store, {{"a"}, {}});
  for (const bool is_down : {false, true}) {
    // The rank of a feature: the kind of its first value, then that value.
    const auto rank = [&](const std::string& id) {
      std::pair<int, std::string> best{3, ""};
      for (const AttributeValue& value : values[id]) {
        const std::pair<int, std::string> one{static_cast<int>(value.type), value.text};
        const bool is_first = one.first < best.first ||
                              (one.first == best.first &&
                               (is_down ? one.second > best.second : one.second < best.second));
        if (is_first) best = one;
      }
      return best;
    };
    for (const std::uint64_t limit : {1, 7, 100}) {
      store::FeatureQuery query;
      query.collection = "buildings";
      query.limit = limit;
      query.sort = store::SortKey{"a", is_down};
      std::vector<std::string> ids;
      do {
        const auto page = store->list(query);
        REQUIRE(page);
        for (const auto& summary : page->features) ids.push_back(summary.id);
        query.after = page->next;
      } while (!query.after.empty());
      CHECK(ids.size() == features.size());
      CHECK(std::set<std::string>(ids.begin(), ids.end()).size() == features.size());
      for (std::size_t i = 1; i < ids.size(); ++i) {
        const auto before = rank(ids[i - 1]);
        const auto here = rank(ids[i]);
        INFO(ids[i - 1] << " before " << ids[i]);
        CHECK(before.first <= here.first);
        if (before.first != here.first) continue;
        CHECK((is_down ? before.second >= here.second : before.second <= here.second));
      }
    }
  }
  store::FeatureQuery query;
  query.collection = "buildings";
  query.sort = store::SortKey{"a", false};
  query.filter = store::Filter{store::Filter::Kind::is_null, {}, "a"};
  const auto without = store->list(query);
  REQUIRE(without);
  for (const auto& summary : without->features) CHECK(values[summary.id].empty());
  query.filter.reset();
  for (const char* wrong : {"f1", "n3:1.5", "n9:1f1", "x1:af1", "n1:xf1", "n2:1-f1", "n:f1",
                            "n99999999999999999999:1f", "b1:1f", "t-1:f", "n3:1e9f"}) {
    INFO(wrong);
    query.after = wrong;
    CHECK(store->list(query).error().code == ErrorCode::invalid_argument);
  }
  query.after.clear();
  query.sort->name = "b";
  CHECK(store->list(query).error().code == ErrorCode::invalid_argument);
  query.collection = "none";
  CHECK(store->list(query).error().code == ErrorCode::not_found);
}

}  // namespace watertight::test_attributes
