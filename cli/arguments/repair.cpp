// SPDX-License-Identifier: GPL-3.0-or-later
//
// The options of remedies, and numbers in a range.
#include <charconv>
#include <system_error>

#include "cli/arguments/arguments.h"
#include "cli/commands.h"
#include "repair/repair.h"

namespace watertight::cli {

CLI::Validator in_range(double min, double max, const std::string& words) {
  const auto check = [min, max, words](std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const bool is_good = error == std::errc{} && rest == end && value >= min && value <= max;
    return is_good ? std::string() : "'" + text + "' is not a number " + words;
  };
  return CLI::Validator(check, words);
}

CLI::Option* add_remedies(CLI::App& sub, const std::string& name, std::string& remedies,
                          double& weld_metres) {
  sub.add_option("--weld", weld_metres, "largest move of a vertex by weld, metres")
      ->check(in_range(0, 1000, "from 0 to 1000"))
      ->capture_default_str();
  return sub
      .add_option(name, remedies,
                  "remedies for invalid solids: rings, orientation and junctions guess nothing; "
                  "weld (with --weld), facets and fill do; all: every one of these; smooth: holes "
                  "get patches that go on as the surface around them does")
      ->type_name("LIST")
      ->check([](const std::string& list) {
        const auto read = repair::remedies_of(list);
        return read ? std::string() : read.error().message;
      });
}

void add_smooth(CLI::App& sub, RepairCommand& command) {
  repair::SmoothOptions& smooth = command.smooth;
  sub.add_option("--density", smooth.density,
                 "smooth: distance of new vertices in edges of the border; smaller gives more")
      ->check(in_range(repair::kLeastDensity, repair::kMostDensity, "from 0.1 to 100"))
      ->capture_default_str();
  sub.add_option("--regularity", smooth.regularity,
                 "smooth: least distance of new vertices from each other, likewise")
      ->check(in_range(repair::kLeastDensity, repair::kMostDensity, "from 0.1 to 100"))
      ->capture_default_str();
  sub.add_option("--collar", smooth.collar.rings,
                 "smooth: rings of triangles around a hole that the patch follows")
      ->check(in_range(1, repair::kMostRings, "from 1 to 10"))
      ->capture_default_str();
  sub.add_option("--crease", smooth.collar.crease_degrees,
                 "smooth: rings end at edges that turn more, degrees")
      ->check(in_range(0, 180, "from 0 to 180"))
      ->type_name("DEG")
      ->capture_default_str();
  sub.add_option("--spline", command.spline,
                 "smooth: write the surfaces of the patches as JSON, one on a line");
}

}  // namespace watertight::cli
