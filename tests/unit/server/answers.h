// SPDX-License-Identifier: GPL-3.0-or-later
//
// For tests of handlers: answers in parts, put together.
#pragma once

#include <catch2/catch_test_macros.hpp>
#include <string>

#include "server/transport/http.h"

namespace watertight::test {

/// The whole body of an answer: its first bytes and all further parts.
inline std::string whole(const server::Response& response) {
  std::string text = response.body;
  while (response.rest) {
    const auto part = response.rest({});
    REQUIRE(part);
    if (part->empty()) break;
    text += *part;
  }
  return text;
}

}  // namespace watertight::test
