// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "codec/entropy/bank_trial.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/page/model_sets.h"

using namespace watertight;

namespace {

enum Family : std::uint32_t { kBit };
enum Number : std::uint32_t { kNumber };
constexpr codec::FamilyShape kFamilies[] = {{kBit, 2, {3, 16}}};
constexpr codec::NumberShape kNumbers[] = {{kNumber, 1, {4, 2}}};
constexpr const codec::FamilyShape& shape_of(Family family) { return kFamilies[family]; }
constexpr const codec::NumberShape& shape_of(Number number) { return kNumbers[number]; }
constexpr codec::ModelLayout kLayout{kFamilies, kNumbers};

struct Sample {
  std::uint32_t context = 0;
  bool bit = false;
  std::int64_t number = 0;
  std::uint64_t size = 1;
  std::uint64_t uniform = 0;
};

std::vector<Sample> samples(std::uint32_t seed, int count) {
  std::mt19937 random(seed);
  std::vector<Sample> result;
  for (int i = 0; i < count; ++i) {
    Sample sample;
    sample.context = static_cast<std::uint32_t>(random() % 3);
    sample.bit = random() % 16 < 1 + 5 * sample.context;
    const std::int64_t magnitude = static_cast<std::int64_t>(random()) >> (random() % 32);
    sample.number = random() % 2 == 0 ? magnitude : -magnitude;
    sample.size = 1 + random() % 100;
    sample.uniform = random() % sample.size;
    result.push_back(sample);
  }
  return result;
}

/// Codes the samples in the direction of the stream; a reader overwrites `all`.
void code(codec::EntropyStream& stream, codec::ModelBank& models, std::vector<Sample>& all) {
  std::uint32_t last = 0;
  for (Sample& sample : all) {
    const codec::Context<2> parity(last & 1U);
    sample.bit = models.code<kBit>(
        stream, parity, {codec::Context<3>(sample.context), codec::Context<16>(last % 16)},
        sample.bit);
    sample.number = models.code_signed<kNumber>(stream, {codec::Context<4>(sample.context), parity},
                                                sample.number);
    sample.uniform = stream.code_uniform(sample.uniform, sample.size);
    last = static_cast<std::uint32_t>(sample.uniform);
  }
}

}  // namespace

TEST_CASE("contexts are combined in mixed radix, and their sizes with them") {
  using codec::Context;
  constexpr auto combined = codec::combine(Context<5>(3U), Context<2>(true), Context<7>(6U));
  static_assert(std::is_same_v<decltype(combined), const Context<5 * 2 * 7>>);
  CHECK(combined.value == (3 * 2 + 1) * 7 + 6);
  CHECK(codec::capped<4>(-1).value == 0);
  CHECK(codec::capped<4>(3U).value == 3);
  CHECK(codec::capped<4>(std::uint64_t{1} << 40).value == 3);
  static_assert(std::is_same_v<decltype(codec::halved(Context<21>(20U))), Context<11>>);
  CHECK(codec::halved(Context<21>(20U)).value == 10);
  static_assert(std::is_same_v<decltype(codec::leading<4>(Context<3>(2U))), Context<7>>);
  CHECK(codec::leading<4>(Context<3>(2U)).value == 2);
  CHECK(codec::trailing<4>(Context<3>(2U)).value == 6);
}

TEST_CASE("the latest answers are the lowest bits, and older ones are forgotten") {
  codec::Answers<3> answers;
  CHECK(answers.last().value == 0);
  for (const bool answer : {true, false, true, true}) answers.add(answer);
  CHECK(answers.last().value == 0b011);
  CHECK(answers.last<1>().value == 1);
}

TEST_CASE("a reader reads what a writer has written, and ends where the writer ended") {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::vector<Sample> written = samples(seed, 300);
    codec::EntropyStream writer = codec::EntropyStream::writer();
    codec::ModelBank models(kLayout);
    code(writer, models, written);
    const Bytes bytes = std::move(writer).finish();

    std::vector<Sample> read = written;
    for (Sample& sample : read) sample.bit = false, sample.number = 0, sample.uniform = 0;
    codec::EntropyStream reader = codec::EntropyStream::reader(bytes);
    codec::ModelBank again(kLayout);
    code(reader, again, read);
    REQUIRE(reader.is_finished());
    for (std::size_t i = 0; i < read.size(); ++i) {
      REQUIRE(read[i].bit == written[i].bit);
      REQUIRE(read[i].number == written[i].number);
      REQUIRE(read[i].uniform == written[i].uniform);
    }
    REQUIRE(models.save({.max_count = 250}) == again.save({.max_count = 250}));
  }
}

TEST_CASE("a measuring stream measures the bytes that a writing stream takes") {
  std::vector<Sample> all = samples(7, 5000);
  codec::EntropyStream writer = codec::EntropyStream::writer();
  codec::EntropyStream meter = codec::EntropyStream::meter();
  codec::ModelBank one(kLayout);
  codec::ModelBank two(kLayout);
  code(writer, one, all);
  code(meter, two, all);
  const auto written = static_cast<double>(std::move(writer).finish().size());
  const double measured = static_cast<double>(meter.cost()) / (8.0 * (1 << codec::kCostBits));
  REQUIRE(measured > 0.998 * written - 2);
  REQUIRE(measured < 1.002 * written + 2);
}

TEST_CASE("a meter fails once its cost reaches the limit, and not before") {
  std::vector<Sample> all = samples(7, 500);
  const auto measured = [&](std::uint64_t limit) {
    codec::EntropyStream meter = codec::EntropyStream::meter(limit);
    codec::ModelBank models(kLayout);
    code(meter, models, all);
    return meter;
  };
  const std::uint64_t cost = measured(~std::uint64_t{0}).cost();
  CHECK_FALSE(measured(cost + 1).failed());
  CHECK(measured(cost).failed());
  CHECK(measured(cost / 2).failed());
}

TEST_CASE("a stream cut short fails instead of going on for ever") {
  std::vector<Sample> all = samples(3, 2000);
  codec::EntropyStream writer = codec::EntropyStream::writer();
  codec::ModelBank models(kLayout);
  code(writer, models, all);
  const Bytes bytes = std::move(writer).finish();
  for (const std::size_t size : {std::size_t{0}, bytes.size() / 2, bytes.size() - 8}) {
    codec::EntropyStream reader = codec::EntropyStream::reader(ByteView(bytes).first(size));
    codec::ModelBank again(kLayout);
    code(reader, again, all);
    CHECK(reader.failed());
    CHECK_FALSE(reader.is_finished());
  }
}

TEST_CASE("a bank learns, and starts where its prior left off") {
  std::vector<Sample> training = samples(11, 20000);
  codec::ModelBank trained(kLayout);
  codec::EntropyStream first = codec::EntropyStream::meter();
  code(first, trained, training);

  const Bytes prior = trained.save({.max_count = 60});
  codec::ModelBank loaded(kLayout);
  REQUIRE(loaded.load(prior));
  REQUIRE(loaded.save({.max_count = 60}) == prior);

  std::vector<Sample> test = samples(12, 50);
  codec::EntropyStream cold = codec::EntropyStream::meter();
  codec::EntropyStream warm = codec::EntropyStream::meter();
  codec::ModelBank neutral(kLayout);
  code(cold, neutral, test);
  code(warm, loaded, test);
  CHECK(warm.cost() < cold.cost() * 95 / 100);
}

TEST_CASE("after a trial, and trials within it, a bank goes on as if there had been none") {
  for (const std::size_t vertices : {std::size_t{0}, std::size_t{1'000'000}}) {
    codec::ModelBank models(kLayout);
    codec::EntropyStream meter = codec::EntropyStream::meter();
    std::vector<Sample> coded = samples(13, 500);
    code(meter, models, coded);
    codec::ModelBank untouched = models;
    const auto attempt = [&](std::uint32_t seed) {
      codec::EntropyStream unused = codec::EntropyStream::meter();
      std::vector<Sample> tried = samples(seed, 700);
      code(unused, models, tried);
    };
    {
      const codec::BankTrial trial(models, vertices);
      attempt(14);
      {
        const codec::BankTrial inner(models, 0);
        attempt(15);
      }
      attempt(16);
    }
    const codec::PriorShape whole{.max_count = 250};
    CHECK(models.save(whole) == untouched.save(whole));
    codec::EntropyStream one = codec::EntropyStream::meter();
    codec::EntropyStream other = codec::EntropyStream::meter();
    std::vector<Sample> next = samples(17, 500);
    code(one, models, next);
    code(other, untouched, next);
    CHECK(one.cost() == other.cost());
    CHECK(models.save(whole) == untouched.save(whole));
  }
}

TEST_CASE("a kept trial and its recorded decisions are as if the bank had coded them at once") {
  for (const std::size_t vertices : {std::size_t{0}, std::size_t{1'000'000}}) {
    codec::ModelBank models(kLayout);
    codec::ModelBank plain(kLayout);
    std::vector<Sample> tried = samples(14, 700);
    std::vector<Sample> next = samples(15, 300);
    codec::EntropyStream stream = codec::EntropyStream::writer();
    codec::EntropyStream recorder = codec::EntropyStream::recorder();
    {
      codec::BankTrial trial(models, vertices);
      code(recorder, models, tried);
      trial.keep();
    }
    stream.append(recorder);
    code(stream, models, next);
    codec::EntropyStream expected = codec::EntropyStream::writer();
    code(expected, plain, tried);
    code(expected, plain, next);
    CHECK(stream.costs() == expected.costs());
    CHECK(std::move(stream).finish() == std::move(expected).finish());
    {
      const codec::BankTrial trial(models, 0);  // undoes only what it learned itself
      code(recorder, models, tried);
    }
    const codec::PriorShape whole{.max_count = 250};
    CHECK(models.save(whole) == plain.save(whole));
  }
}

TEST_CASE("a prior of another layout is refused") {
  constexpr codec::FamilyShape families[] = {{0, 1, {3}}};
  codec::ModelBank other(codec::ModelLayout{families, {}});
  codec::ModelBank models(kLayout);
  CHECK_FALSE(other.load(models.save({.max_count = 30})));
  CHECK_FALSE(models.load(other.save({.max_count = 30})));
  CHECK_FALSE(models.load({}));
}

TEST_CASE("every numbered set of priors exists, and no other") {
  for (std::uint8_t number = 0; number < 2; ++number) {
    INFO(int{number});
    const auto models = codec::ModelSet::make(number);
    REQUIRE(models);
    CHECK(models->number() == number);
  }
  const auto none = codec::ModelSet::make(2);
  REQUIRE_FALSE(none);
  CHECK(none.error().code == ErrorCode::unsupported);
}
