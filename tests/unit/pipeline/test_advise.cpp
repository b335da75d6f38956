// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "pipeline/advise.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_advise {
namespace {

std::vector<SubmittedSolid> solids_of(const std::string& text) {
  const auto document = formats::read_document(as_bytes(text), Format::city_json_seq);
  REQUIRE(document);
  std::vector<SubmittedSolid> solids;
  for (const Feature& feature : document->features) {
    solids.insert(solids.end(), feature.solids.begin(), feature.solids.end());
  }
  return solids;
}

/// A box of 1 m by 1 m, and as high as `millimetres`.
std::string flat_box(const std::string& id, const std::string& millimetres) {
  const std::string z = "," + millimetres + "]";
  return samples::feature(id, samples::kBoxFacets,
                          "[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0" + z + ",[1000,0" + z +
                              ",[1000,1000" + z + ",[0,1000" + z + "]");
}

TEST_CASE("advice names the decimals at which the first solid breaks, and why") {
  const auto solids = solids_of(
      samples::sequence({samples::feature("house"), flat_box("plate", "4"), flat_box("step", "50"),
                         samples::feature("open", samples::kOpenFacets)}));
  for (const std::size_t threads : {1, 3}) {
    pipeline::AdviceOptions options;
    options.threads = threads;
    const auto advice = pipeline::advise(solids, nullptr, options);
    REQUIRE(advice);
    CHECK(advice->solids == 4);
    CHECK(advice->valid == 3);
    CHECK(advice->off_grid == 0);
    REQUIRE(advice->levels.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(advice->levels[i].decimals == 3 - static_cast<int>(i));
      CHECK(advice->levels[i].valid + advice->levels[i].broken == 3);
    }
    CHECK(advice->levels[0].broken == 0);
    CHECK(advice->levels[1].broken == 1);  // the plate is flat in centimetres
    REQUIRE(advice->levels[1].first_broken);
    CHECK(advice->levels[1].first_broken->first.object_id == "plate");
    CHECK(advice->levels[1].first_broken->second != 0);
    CHECK(advice->levels[2].broken == 1);  // 0.05 m is rounded up to 0.1 m
    CHECK(advice->levels[3].broken == 2);
    CHECK(advice->levels[3].valid == 1);
    CHECK(advice->levels[0].blob_bytes > advice->levels[3].blob_bytes);
  }
}

TEST_CASE("advice about nothing is empty") {
  CHECK(pipeline::advise({}, nullptr, {})->levels.empty());
  const auto open = solids_of(samples::sequence({samples::feature("a", samples::kOpenFacets)}));
  const auto advice = pipeline::advise(open, nullptr, {});
  REQUIRE(advice);
  CHECK(advice->valid == 0);
  CHECK(advice->levels.empty());
}

}  // namespace
}  // namespace watertight::test_advise
