// SPDX-License-Identifier: GPL-3.0-or-later
#include "web/files.h"

#include <array>

namespace watertight::web {

// web/dist, which CMakeLists.txt embeds.
extern const std::string_view kMainScript;
extern const std::string_view kThreeScript;
extern const std::string_view kStyle;

std::span<const WebFile> files() {
  static const std::array<WebFile, 3> all{
      {{"main.js", "text/javascript; charset=utf-8", kMainScript},
       {"three.js", "text/javascript; charset=utf-8", kThreeScript},
       {"main.css", "text/css; charset=utf-8", kStyle}}};
  return all;
}

}  // namespace watertight::web
