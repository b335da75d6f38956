// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "base/shared_text.h"

namespace watertight {
namespace {

TEST_CASE("copies of a shared text are the same bytes") {
  const SharedText text(std::string(100, 'x'));
  const SharedText copy = text;
  CHECK(&copy.str() == &text.str());
  CHECK(copy == text);
}

TEST_CASE("shared texts compare by their content") {
  SharedText a;
  CHECK(a.empty());
  CHECK(a == SharedText(std::string()));
  a = std::string("header");
  CHECK(a == SharedText(std::string("header")));
  CHECK(a == "header");
  CHECK_FALSE(a == SharedText());
  CHECK(SharedText() < a);
  CHECK(a < SharedText(std::string("header 2")));
}

}  // namespace
}  // namespace watertight
