// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "pipeline/validate_stream.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_stream {
namespace {

/// A sequence of `count` features; every fifth is open, every seventh is no JSON.
class LongSequence {
 public:
  explicit LongSequence(std::size_t count) : count_(count), rest_(samples::kHeader) {
    rest_ += '\n';
  }

  Result<std::size_t> operator()(std::span<std::uint8_t> bytes) {
    if (rest_.empty() && next_ < count_) {
      const std::size_t i = next_++;
      std::string id(1, 'f');
      id += std::to_string(i);
      rest_ = samples::feature(id, i % 5 == 4 ? samples::kOpenFacets : samples::kBoxFacets);
      if (i % 7 == 6) rest_.resize(8);
      rest_ += '\n';
    }
    const std::size_t size = std::min(bytes.size(), rest_.size());
    std::copy_n(rest_.begin(), size, bytes.begin());
    rest_.erase(0, size);
    return size;
  }

 private:
  std::size_t count_;
  std::size_t next_ = 0;
  std::string rest_;
};

struct Run {
  std::vector<std::string> events;
  pipeline::StreamOutcome outcome;
};

Run run(std::size_t count, std::size_t threads) {
  auto reader = formats::FeatureReader::open(LongSequence(count), "x.jsonl");
  REQUIRE(reader);
  pipeline::StreamOptions options;
  options.threads = threads;
  Run run;
  const auto outcome = pipeline::validate_stream(
      *reader, nullptr, options,
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        std::string event = std::to_string(feature.number);
        event += ' ' + feature.inspected.feature.id + ' ';
        event += validate::to_string(feature.inspected.verdict());
        run.events.push_back(std::move(event));
        return Done{};
      },
      [&](const Error& error) -> Status {
        run.events.push_back(error.message);
        return Done{};
      });
  REQUIRE(outcome);
  run.outcome = *outcome;
  return run;
}

TEST_CASE("a stream hands on features in document order whatever the threads") {
  const Run one = run(300, 1);
  REQUIRE(one.events.size() == 300);
  CHECK(one.outcome.features == 258);
  CHECK(one.outcome.unreadable == 42);
  CHECK(one.outcome.verdict == Verdict::invalid);
  CHECK(one.events[3] == "3 f3 valid");
  CHECK(one.events[4] == "4 f4 invalid");
  CHECK(one.events[6].find("line 8: ") == 0);
  for (const std::size_t threads : {std::size_t{2}, std::size_t{5}}) {
    CHECK(run(300, threads).events == one.events);
  }
}

TEST_CASE("an error of a sink ends a stream with that error") {
  for (const std::size_t threads : {std::size_t{1}, std::size_t{3}}) {
    auto reader = formats::FeatureReader::open(LongSequence(1'000'000), "x.jsonl");
    REQUIRE(reader);
    pipeline::StreamOptions options;
    options.threads = threads;
    std::size_t taken = 0;
    const auto outcome = pipeline::validate_stream(
        *reader, nullptr, options,
        [&](pipeline::ValidatedFeature&&) -> Status {
          if (++taken == 4) return Error{ErrorCode::unavailable, "no space left"};
          return Done{};
        },
        [](const Error&) -> Status { return Done{}; });
    REQUIRE_FALSE(outcome);
    CHECK(outcome.error().message == "no space left");
    CHECK(taken == 4);
  }
}

TEST_CASE("a cancelled stream stops soon") {
  auto reader = formats::FeatureReader::open(LongSequence(1'000'000), "x.jsonl");
  REQUIRE(reader);
  pipeline::StreamOptions options;
  options.threads = 2;
  std::atomic<std::size_t> taken = 0;
  options.is_cancelled = [&taken] { return taken >= 10; };
  const auto outcome = pipeline::validate_stream(
      *reader, nullptr, options,
      [&](pipeline::ValidatedFeature&&) -> Status {
        ++taken;
        return Done{};
      },
      [](const Error&) -> Status { return Done{}; });
  REQUIRE_FALSE(outcome);
  CHECK(outcome.error().code == ErrorCode::cancelled);
  CHECK(taken < 1000);
}

TEST_CASE("features read far ahead of a slow sink are bounded") {
  auto reader = formats::FeatureReader::open(LongSequence(2'000), "x.jsonl");
  REQUIRE(reader);
  pipeline::StreamOptions options;
  options.threads = 2;
  std::uint64_t farthest = 0;
  const std::uint64_t line = samples::feature("f0000", samples::kOpenFacets).size();
  options.progress = [&](std::uint64_t done, std::uint64_t bytes_read) {
    farthest = std::max(farthest, bytes_read / line - std::min(done, bytes_read / line));
  };
  std::uint64_t handed_on = 0;
  const auto outcome = pipeline::validate_stream(
      *reader, nullptr, options,
      [&](pipeline::ValidatedFeature&&) -> Status {
        ++handed_on;
        return Done{};
      },
      [](const Error&) -> Status { return Done{}; });
  REQUIRE(outcome);
  CHECK(handed_on == outcome->features);
  CHECK(farthest < 900);  // not all 2,000 features, but those in one chunk of bytes and 64 more
}

}  // namespace
}  // namespace watertight::test_stream
