// SPDX-License-Identifier: GPL-3.0-or-later
//
// The program of the pages of the service: scripts and style, as Vite makes them of web/src.
#pragma once

#include <span>
#include <string_view>

namespace watertight::web {

struct WebFile {
  std::string_view name;  // "main.js"
  std::string_view type;  // its media type
  std::string_view text;
};

/// All files. main.js names the others relative to itself.
std::span<const WebFile> files();

}  // namespace watertight::web
