// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of requests, which arrive in parts of any length.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <random>
#include <string>

#include "server/transport/received_body.h"

namespace watertight::test_received_body {
namespace {

std::string random_text(std::mt19937& random, std::size_t length) {
  std::string text(length, '\0');
  std::generate(text.begin(), text.end(), [&] { return static_cast<char>(random()); });
  return text;
}

}  // namespace

TEST_CASE("a body is taken as it arrived, whatever the lengths of its parts") {
  std::mt19937 random(1);
  for (const std::size_t length : {0, 1, 65'535, 65'536, 65'537, 131'072, 1'000'003}) {
    for (const std::size_t most : {std::size_t{977}, std::size_t{16'384}, std::size_t{1'000'000}}) {
      const std::string text = random_text(random, length);
      server::ReceivedBody body;
      while (body.size() < length) {
        const auto space = body.space();
        REQUIRE(!space.empty());
        const std::size_t count = std::min({space.size(), most, length - body.size()});
        std::copy_n(text.begin() + static_cast<std::ptrdiff_t>(body.size()), count, space.begin());
        body.add(count);
      }
      CHECK(body.take() == text);
      CHECK(body.size() == 0);
      CHECK(body.take().empty());
    }
  }
}

TEST_CASE("a body that was cleared begins anew") {
  server::ReceivedBody body;
  for (int i = 0; i < 3; ++i) body.add(body.space().size());
  body.clear();
  CHECK(body.size() == 0);
  body.space()[0] = 'a';
  body.add(1);
  CHECK(body.take() == "a");
}

}  // namespace watertight::test_received_body
