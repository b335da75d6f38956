// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids and texts of features as their row has them.
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "fixture.h"
#include "packing/text_dictionary.h"
#include "store/rows/packed_solids.h"

namespace watertight::test_packed_rows {
namespace {

using test::Database;
using test::sample_feature;

StoredSolid solid_of(const std::string& object, std::uint32_t geometry, const std::string& lod,
                     std::size_t bytes) {
  StoredSolid solid;
  solid.object_id = object;
  solid.geometry = geometry;
  solid.lod = lod;
  solid.blob.assign(bytes, 7);
  return solid;
}

store::FeatureRecord feature_with(std::vector<StoredSolid> solids) {
  store::FeatureRecord feature;
  feature.id = "h\u00e4user";
  feature.solids = std::move(solids);
  return feature;
}

bool are_equal(const StoredSolid& a, const StoredSolid& b) {
  return a.object_id == b.object_id && a.geometry == b.geometry && a.ordinal == b.ordinal &&
         a.lod == b.lod && a.blob == b.blob && a.is_proven == b.is_proven;
}

/// The bytes give the solids and the page, and no shorter ones do.
void check_unpacked(const store::FeatureRecord& all, const Bytes& packed) {
  store::FeatureRecord back;
  back.id = all.id;
  REQUIRE(store::unpack_solids(back, all.solids.size(), packed));
  REQUIRE(back.solids.size() == all.solids.size());
  for (std::size_t i = 0; i < back.solids.size(); ++i) {
    CHECK(are_equal(back.solids[i], all.solids[i]));
  }
  CHECK(back.page == all.page);
  for (std::size_t size = 0; size + all.page.size() < packed.size(); ++size) {
    CHECK_FALSE(store::unpack_solids(back, all.solids.size(), ByteView(packed).first(size)));
  }
  const Bytes without_page(packed.begin(),
                           packed.end() - static_cast<std::ptrdiff_t>(all.page.size()));
  CHECK(store::unpack_solids(back, all.solids.size(), without_page).has_value() ==
        all.page.empty());
  CHECK_FALSE(store::unpack_solids(back, 1'000'000'000, packed));
}

std::vector<std::string> texts(int count, int first) {
  std::vector<std::string> all;
  for (int i = first; i < first + count; ++i) {
    std::string text = R"({"type":"CityJSONFeature","CityObjects":{"type":"Building","roof":)";
    text += std::to_string(i * 7919 % 1000);
    text += R"(,"attributes":{"height":)";
    text += std::to_string(i * 104729 % 5000);
    all.push_back(text + R"(},"geometry":[{"type":"Solid","lod":"2.2"}]}})");
  }
  return all;
}

}  // namespace

TEST_CASE("solids come back from their bytes, and what is expected takes two bytes") {
  const auto usual = feature_with({solid_of("h\u00e4user", 0, "1.2", 5)});
  CHECK(store::pack_solids(usual).size() == 2 + 5);
  StoredSolid other = solid_of("elsewhere", 9, "about 2", 300);
  other.ordinal = 4;
  StoredSolid unproven = solid_of("h\u00e8", 0, "", 0);  // shares half a character with the id
  unproven.is_proven = false;
  const auto all = feature_with(
      {solid_of("h\u00e4user-0", 0, "1.2", 1), solid_of("h\u00e4user-0", 1, "1.3", 2), other,
       unproven, solid_of("h\u00e8", 4294967295U, "3.3", 0), solid_of("h\u00e8", 0, "x", 1)});
  const Bytes packed = store::pack_solids(all);
  check_unpacked(all, packed);
}

TEST_CASE("a page of solids comes back behind their facts and blobs") {
  auto all = feature_with({solid_of("h\u00e4user-0", 0, "1.2", 0), solid_of("b", 1, "", 3),
                           solid_of("c", 0, "x", 0), solid_of("c", 1, "2.2", 0)});
  all.solids[2].is_proven = false;
  all.page = {9, 8, 7, 6};
  const Bytes packed = store::pack_solids(all);
  CHECK(packed.front() == store::kPageMark);
  check_unpacked(all, packed);
}

TEST_CASE("solids take memory by their bytes, also where many have one id") {
  const std::size_t longest = store::kLongestId;
  for (const std::size_t size : {longest, longest + 1}) {
    auto many = feature_with({solid_of(std::string(size, 'x'), 0, "1", 0)});
    many.solids.resize(100, many.solids.front());
    store::FeatureRecord back;
    back.id = many.id;
    const auto unpacked = store::unpack_solids(back, 100, store::pack_solids(many));
    CHECK(unpacked.has_value() == (size <= longest));
  }
}

TEST_CASE("SQL sees the same solids as the store") {
  const Database database;
  const auto store = database.store();
  StoredFeature feature = sample_feature("h\u00e4user");
  feature.solids = {solid_of("h\u00e4user-0", 0, "1.2", 3),
                    solid_of("h\u00e4user-0", 1, "odd", 200), solid_of("h\u00e8", 5, "", 2)};
  feature.solids[2].ordinal = 300;
  feature.solids[0].is_proven = false;
  feature.solids[0].blob = {};
  REQUIRE(store->put(std::vector{feature}));
  CHECK(database.ask("SELECT string_agg(concat_ws('|', collection, feature, object_id, geometry,"
                     " ordinal, position, lod, coalesce(length(blob), -1)), ' ' ORDER BY position)"
                     " FROM watertight.solid") ==
        "buildings|h\u00e4user|h\u00e4user-0|0|0|0|1.2|-1 "
        "buildings|h\u00e4user|h\u00e4user-0|1|0|1|odd|200 "
        "buildings|h\u00e4user|h\u00e8|5|300|2||2");
  feature.solids[1].blob = {};
  feature.page = {1, 2, 3};
  feature.solids.push_back(solid_of("h\u00e8", 6, "", 0));
  REQUIRE(store->put(std::vector{feature}));
  CHECK(database.ask("SELECT string_agg(concat_ws('|', object_id, geometry, is_proven::int, lod,"
                     " coalesce(length(blob), -1), coalesce(encode(page, 'hex'), '-'), slot), ' '"
                     " ORDER BY position) FROM watertight.solid") ==
        "h\u00e4user-0|0|0|1.2|-1|- h\u00e4user-0|1|1|odd|-1|010203|0 "
        "h\u00e8|5|1||2|- h\u00e8|6|1||-1|010203|1");
  const auto got = store->get("buildings", feature.id);
  REQUIRE(got);
  CHECK(got->page == feature.page);
  CHECK(database.ask("SELECT blob_bytes::text FROM watertight.feature") == "5");
}

TEST_CASE("a dictionary makes texts smaller, and they come back with it alone") {
  const auto dictionary = packing::best_dictionary(texts(200, 0), 1000);
  REQUIRE(dictionary);
  REQUIRE(*dictionary);
  const std::string text = texts(1, 500).front();
  const auto packed = packing::pack(text, dictionary->get());
  const auto plain = packing::pack(text, nullptr);
  REQUIRE((packed && plain));
  CHECK(packed->size() * 3 < plain->size());
  CHECK(*packing::unpack(*packed, dictionary->get(), 1000) == text);
  CHECK(*packing::unpack(*plain, nullptr, 1000) == text);
  CHECK(packing::unpack(*packed, dictionary->get(), 10).error().code == ErrorCode::limit_exceeded);
  for (std::size_t size = 0; size < packed->size(); ++size) {
    const auto cut = packing::unpack(ByteView(*packed).first(size), dictionary->get(), 1000);
    CHECK_FALSE((cut && *cut == text));  // few prefixes are packed texts too: others
  }
  // It is kept when a new one would not be better, or cannot be made.
  CHECK(*packing::best_dictionary(texts(200, 300), 1000, *dictionary) == *dictionary);
  CHECK(*packing::best_dictionary(texts(5, 0), 1000, *dictionary) == *dictionary);
  CHECK(*packing::best_dictionary(texts(5, 0), 1000) == nullptr);
}

TEST_CASE("a dictionary of a form that is not known is refused as of a newer program") {
  const auto dictionary = packing::best_dictionary(texts(200, 0), 1000);
  REQUIRE((dictionary && *dictionary));
  Bytes content = (*dictionary)->content();
  REQUIRE(packing::TextDictionary::of(content));
  content[0] = 1;
  const auto refused = packing::TextDictionary::of(content);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::unsupported);
  CHECK(refused.error().message == "texts of form 1 are not known: a newer program wrote them");
  CHECK(packing::TextDictionary::of({}).error().code == ErrorCode::malformed);
}

TEST_CASE("a collection keeps the dictionaries of its features, also when it is made anew") {
  const Database database;
  const auto store = database.store();
  const auto dictionary = packing::best_dictionary(texts(200, 0), 1000);
  REQUIRE((dictionary && *dictionary));
  StoredFeature feature = sample_feature("a");
  feature.skeleton = {*packing::pack("text", dictionary->get()), *dictionary};
  for (int round = 0; round < 2; ++round) {
    REQUIRE(store->put(std::vector{feature}));
    const auto other = database.store();
    const auto got = other->get("buildings", "a");
    REQUIRE(got);
    REQUIRE(got->skeleton.dictionary);
    CHECK(*packing::unpack(got->skeleton.bytes, got->skeleton.dictionary.get(), 100) == "text");
    CHECK((*other->dictionary("buildings"))->content() == (*dictionary)->content());
    CHECK(database.ask("SELECT count(*)::text FROM watertight.dictionary") == "1");
    REQUIRE(store->remove_collection("buildings", {}));
    CHECK(database.ask("SELECT count(*)::text FROM watertight.dictionary") == "0");
  }
}

TEST_CASE("a feature is packed again under its version, unless it changed meanwhile") {
  const Database database;
  const auto store = database.store();
  REQUIRE(store->put(std::vector{sample_feature("a"), sample_feature("b")}));
  auto batch = store->walk("buildings", 10, "");
  REQUIRE(batch);
  REQUIRE(store->put(std::vector{sample_feature("b")}));
  for (StoredFeature& feature : batch->features) feature.skeleton = {{1, 2, 3}, {}};
  const auto repacked = store->repack(batch->features);
  REQUIRE(repacked);
  CHECK(*repacked == 1);
  CHECK(store->get("buildings", "a")->skeleton.bytes == Bytes{1, 2, 3});
  CHECK(store->get("buildings", "a")->version == batch->features[0].version);
  CHECK(store->get("buildings", "b")->skeleton == sample_feature("b").skeleton);
}

}  // namespace watertight::test_packed_rows
