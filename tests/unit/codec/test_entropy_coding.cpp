// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <random>
#include <utility>
#include <vector>

#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/page/model_sets.h"

using namespace watertight;

namespace {

constexpr FamilyShape kFamilies[] = {{2, {3, 16}}};
constexpr NumberShape kNumbers[] = {{1, {4, 2}}};
constexpr ModelLayout kLayout{kFamilies, kNumbers};

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

/// Codes the samples in one of the three directions; when reading, `all` is overwritten.
void code(EntropyStream& stream, ModelBank& models, std::vector<Sample>& all) {
  std::uint32_t last = 0;
  for (Sample& sample : all) {
    sample.bit = models.code(stream, 0, last & 1U, {sample.context, last % 16}, sample.bit);
    sample.number = models.code_signed(stream, 0, 0, {sample.context, last & 1U}, sample.number);
    sample.uniform = stream.code_uniform(sample.uniform, sample.size);
    last = static_cast<std::uint32_t>(sample.uniform);
  }
}

}  // namespace

TEST_CASE("what an entropy stream writes it reads, and ends where it ended") {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::vector<Sample> written = samples(seed, 300);
    EntropyStream writer = EntropyStream::writer();
    ModelBank models(kLayout);
    code(writer, models, written);
    const Bytes bytes = std::move(writer).finish();

    std::vector<Sample> read = written;
    for (Sample& sample : read) sample.bit = false, sample.number = 0, sample.uniform = 0;
    EntropyStream reader = EntropyStream::reader(bytes);
    ModelBank again(kLayout);
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

TEST_CASE("a measuring stream tells the bytes that a writing one takes") {
  std::vector<Sample> all = samples(7, 5000);
  EntropyStream writer = EntropyStream::writer();
  EntropyStream meter = EntropyStream::meter();
  ModelBank one(kLayout);
  ModelBank two(kLayout);
  code(writer, one, all);
  code(meter, two, all);
  const auto written = static_cast<double>(std::move(writer).finish().size());
  const double measured = static_cast<double>(meter.cost()) / (8.0 * (1 << kCostBits));
  REQUIRE(measured > 0.998 * written - 2);
  REQUIRE(measured < 1.002 * written + 2);
}

TEST_CASE("a stream cut short fails instead of going on for ever") {
  std::vector<Sample> all = samples(3, 2000);
  EntropyStream writer = EntropyStream::writer();
  ModelBank models(kLayout);
  code(writer, models, all);
  const Bytes bytes = std::move(writer).finish();
  for (const std::size_t size : {std::size_t{0}, bytes.size() / 2, bytes.size() - 8}) {
    EntropyStream reader = EntropyStream::reader(ByteView(bytes).first(size));
    ModelBank again(kLayout);
    code(reader, again, all);
    CHECK(reader.failed());
    CHECK_FALSE(reader.is_finished());
  }
}

TEST_CASE("a bank learns, and starts where its prior left off") {
  std::vector<Sample> training = samples(11, 20000);
  ModelBank trained(kLayout);
  EntropyStream first = EntropyStream::meter();
  code(first, trained, training);

  const Bytes prior = trained.save({.max_count = 60});
  ModelBank loaded(kLayout);
  REQUIRE(loaded.load(prior));
  REQUIRE(loaded.save({.max_count = 60}) == prior);

  std::vector<Sample> test = samples(12, 50);
  EntropyStream cold = EntropyStream::meter();
  EntropyStream warm = EntropyStream::meter();
  ModelBank neutral(kLayout);
  code(cold, neutral, test);
  code(warm, loaded, test);
  CHECK(warm.cost() < cold.cost() * 95 / 100);
}

TEST_CASE("after a trial, and trials within it, a bank goes on as if there had been none") {
  for (const std::size_t vertices : {std::size_t{0}, std::size_t{1'000'000}}) {
    ModelBank models(kLayout);
    EntropyStream meter = EntropyStream::meter();
    std::vector<Sample> coded = samples(13, 500);
    code(meter, models, coded);
    ModelBank untouched = models;
    const auto attempt = [&](std::uint32_t seed) {
      EntropyStream unused = EntropyStream::meter();
      std::vector<Sample> tried = samples(seed, 700);
      code(unused, models, tried);
    };
    {
      const BankTrial trial(models, vertices);
      attempt(14);
      {
        const BankTrial inner(models, 0);
        attempt(15);
      }
      attempt(16);
    }
    const PriorShape whole{.max_count = 250};
    CHECK(models.save(whole) == untouched.save(whole));
    EntropyStream one = EntropyStream::meter();
    EntropyStream other = EntropyStream::meter();
    std::vector<Sample> next = samples(17, 500);
    code(one, models, next);
    code(other, untouched, next);
    CHECK(one.cost() == other.cost());
    CHECK(models.save(whole) == untouched.save(whole));
  }
}

TEST_CASE("a prior of another layout is refused") {
  constexpr FamilyShape families[] = {{1, {3}}};
  ModelBank other(ModelLayout{families, {}});
  ModelBank models(kLayout);
  CHECK_FALSE(other.load(models.save({.max_count = 30})));
  CHECK_FALSE(models.load(other.save({.max_count = 30})));
  CHECK_FALSE(models.load({}));
}

TEST_CASE("every numbered set of priors is there, and no other") {
  for (std::uint8_t number = 0; number < 2; ++number) {
    INFO(int{number});
    const auto models = ModelSet::make(number);
    REQUIRE(models);
    CHECK(models->number() == number);
  }
  const auto none = ModelSet::make(2);
  REQUIRE_FALSE(none);
  CHECK(none.error().code == ErrorCode::unsupported);
}
