// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "codec/page.h"
#include "formats/ewkb.h"
#include "sql/bridge.h"

namespace watertight {
namespace {

using Function = void (*)(const wt_job*, wt_reply*) noexcept;

/// A reply that frees its memory.
struct Reply {
  wt_reply value{};
  Reply() = default;
  Reply(const Reply&) = delete;
  Reply& operator=(const Reply&) = delete;
  Reply(Reply&& other) noexcept : value(std::exchange(other.value, wt_reply{})) {}
  Reply& operator=(Reply&&) = delete;
  ~Reply() { wt_reply_clear(&value); }
  std::string state() const { return value.failure.sqlstate; }
  std::string text() const {
    return std::string(reinterpret_cast<const char*>(value.bytes), value.size);
  }
  Bytes bytes() const { return Bytes(value.bytes, value.bytes + value.size); }
};

Reply call(Function function, ByteView bytes, wt_poll poll = nullptr,
           const wt_rule_choice* rules = nullptr) {
  Reply reply;
  const wt_job job{bytes.data(), bytes.size(), nullptr, poll, 0, 0, rules, 0};
  function(&job, &reply.value);
  return reply;
}

/// A box of 10 m whose roof has one corner raised by `raised` metres, as four quads around it.
Bytes warped(double raised) {
  const std::string top = std::to_string(10 + raised);
  const auto submitted = formats::read_wkt(
      "POLYHEDRALSURFACE Z (((0 0 0,0 10 0,10 10 0,10 0 0,0 0 0)),((0 0 10,10 0 10,10 10 " + top +
      ",0 10 10,0 0 10)),((0 0 0,10 0 0,10 0 10,0 0 10,0 0 0)),((0 10 0,0 10 10,10 10 " + top +
      ",10 10 0,0 10 0)),((0 0 0,0 0 10,0 10 10,0 10 0,0 0 0)),((10 0 0,10 10 0,10 10 " + top +
      ",10 0 10,10 0 0)))");
  REQUIRE(submitted);
  return formats::write_ewkb(submitted->solid);
}

/// A unit cube at (84000.5, 447000.25, 0) without its first `missing` facets.
Bytes cube(int missing = 0) {
  const char* const facets[6] = {
      "((0 0 0,0 1 0,1 1 0,1 0 0,0 0 0))", "((0 0 1,1 0 1,1 1 1,0 1 1,0 0 1))",
      "((0 0 0,1 0 0,1 0 1,0 0 1,0 0 0))", "((0 1 0,0 1 1,1 1 1,1 1 0,0 1 0))",
      "((0 0 0,0 0 1,0 1 1,0 1 0,0 0 0))", "((1 0 0,1 1 0,1 1 1,1 0 1,1 0 0))"};
  std::string wkt = "POLYHEDRALSURFACE Z (";
  for (int i = missing; i < 6; ++i) {
    if (i > missing) wkt += ',';
    wkt += facets[i];
  }
  wkt += ')';
  const auto submitted = formats::read_wkt(wkt);
  REQUIRE(submitted);
  return formats::write_ewkb(submitted->solid);
}

}  // namespace

TEST_CASE("the bridge encodes a valid solid and decodes it to the same bytes") {
  const Bytes ewkb = cube();
  const Reply blob = call(wt_bridge_encode, ewkb);
  INFO(blob.value.failure.message);
  REQUIRE(blob.state().empty());
  CHECK(blob.value.size < ewkb.size());
  const Reply back = call(wt_bridge_decode, blob.bytes());
  REQUIRE(back.state().empty());
  CHECK(back.bytes() == ewkb);
  const Reply info = call(wt_bridge_info, blob.bytes());
  REQUIRE(info.state().empty());
  CHECK(info.text().find("\"facets\":6") != std::string::npos);
  CHECK(info.text().find("\"vertices\":8") != std::string::npos);
  CHECK(info.text().find("\"bytes\":" + std::to_string(blob.value.size)) != std::string::npos);
}

TEST_CASE("the bridge gives the blobs of a page") {
  const Reply blob = call(wt_bridge_encode, cube());
  REQUIRE(blob.state().empty());
  const Bytes bytes = blob.bytes();
  const std::vector<ByteView> blobs{bytes, bytes};
  const auto page = codec::page_of_blobs(blobs);
  REQUIRE((page && *page));
  for (const std::int32_t slot : {-1, 0, 1, 2}) {
    Reply reply;
    const wt_job job{(*page)->data(), (*page)->size(), nullptr, nullptr, 0, 0, nullptr, slot};
    wt_bridge_blob(&job, &reply.value);
    const bool is_there = slot == 0 || slot == 1;
    CHECK(reply.state() == (is_there ? "" : "22023"));
    if (is_there) CHECK(reply.bytes() == bytes);
  }
  CHECK(call(wt_bridge_blob, bytes).state() == "22P03");
}

TEST_CASE("the bridge separates valid from invalid and names the findings") {
  CHECK(call(wt_bridge_is_valid, cube()).value.truth);
  const Reply open = call(wt_bridge_is_valid, cube(1));
  CHECK(open.state().empty());
  CHECK(!open.value.truth);
  const Reply refused = call(wt_bridge_encode, cube(1));
  CHECK(refused.state() == "22023");
  CHECK(refused.value.bytes == nullptr);
  REQUIRE(refused.value.failure.detail != nullptr);
  CHECK(std::string(refused.value.failure.detail).find("302") != std::string::npos);
  const Reply report = call(wt_bridge_validate, cube(1));
  CHECK(report.state().empty());
  CHECK(report.text().find("302") != std::string::npos);
  CHECK(report.text() == call(wt_bridge_validate, cube(1)).text());
}

TEST_CASE("the bridge fails on bytes that are no solid, with the offset") {
  for (const Function function :
       {wt_bridge_validate, wt_bridge_is_valid, wt_bridge_encode, wt_bridge_decode, wt_bridge_info,
        wt_bridge_rules_of, wt_bridge_blob, wt_bridge_solid, wt_bridge_solid_of_wkt, wt_bridge_wkt,
        wt_bridge_faces}) {
    CHECK(!call(function, {}).state().empty());
    CHECK(!call(function, as_bytes("garbage")).state().empty());
    const Reply truncated = call(function, ByteView(cube()).first(20));
    CHECK(!truncated.state().empty());
    CHECK(std::strlen(truncated.value.failure.message) > 0);
    CHECK(truncated.value.bytes == nullptr);
  }
  const Reply truncated = call(wt_bridge_encode, ByteView(cube()).first(100));
  CHECK(truncated.state() == "22P03");
  REQUIRE(truncated.value.failure.detail != nullptr);
  CHECK(std::string(truncated.value.failure.detail).starts_with("At byte "));
}

TEST_CASE("the bridge judges by the rules of the call, and the blob states them") {
  const Bytes ewkb = warped(0.1);
  wt_rule_choice rules = wt_default_rules();
  CHECK(rules.planarity == 0.01);
  CHECK(rules.planarity_angle == 20);
  CHECK(!call(wt_bridge_is_valid, ewkb).value.truth);
  CHECK(!call(wt_bridge_is_valid, ewkb, nullptr, &rules).value.truth);
  rules.planarity = 0.05;
  CHECK(call(wt_bridge_is_valid, ewkb, nullptr, &rules).value.truth);
  rules.planarity_angle = 0.5;
  CHECK(!call(wt_bridge_is_valid, ewkb, nullptr, &rules).value.truth);
  rules.planarity_angle = 5;
  rules.is_boundary_enough = true;
  const Reply blob = call(wt_bridge_encode, ewkb, nullptr, &rules);
  INFO(blob.value.failure.message);
  REQUIRE(blob.state().empty());
  CHECK(call(wt_bridge_rules_of, blob.bytes()).text() ==
        R"({"planarity":0.05,"planarity_angle":5,"proof":"boundary","rule_set":1})");
  const std::string report = call(wt_bridge_validate, ewkb, nullptr, &rules).text();
  CHECK(report.find("\"planarity_d2p_tol\":0.05") != std::string::npos);
  CHECK(report.find("\"proof\":\"boundary\"") != std::string::npos);
  CHECK(report.find("strict") == std::string::npos);
  rules.is_strict = true;
  CHECK(call(wt_bridge_validate, ewkb, nullptr, &rules).text().find("\"strict\":true") !=
        std::string::npos);
}

TEST_CASE("the bridge gives no value once it is asked to stop") {
  const Reply stopped = call(wt_bridge_is_valid, cube(), [] { return true; });
  CHECK(stopped.state() == "57014");
}

TEST_CASE("an engine that finds no helpers is made and ended") {
  wt_engine* const engine = wt_engine_make("/no/such/folder");
  REQUIRE(engine != nullptr);
  const Bytes ewkb = cube();
  const wt_job job{ewkb.data(), ewkb.size(), engine, nullptr, 0, 0, nullptr, 0};
  Reply reply;
  wt_bridge_is_valid(&job, &reply.value);
  CHECK(reply.value.truth);  // a cube needs no helper
  wt_engine_end(engine);
  wt_engine_end(nullptr);
}

}  // namespace watertight
