// SPDX-License-Identifier: GPL-3.0-or-later
//
// The suite: solids with a name whose verdict and codes are known by construction, and the way to
// write them as CityJSON for tests/golden/solids.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tests/solids/shape.h"

namespace watertight::solids {

/// The question, and with it the answer that can be expected.
enum class Ask : std::uint8_t {
  rung_zero,  // the exact tests and the canonical Delaunay tetrahedralization decide
  engines,    // needs the engines' rungs
  boundary    // proof by boundary: the exact tests alone
};

struct SuiteCase {
  std::string name;
  Solid solid;
  std::set<int> errors = {};
  std::set<int> warnings = {};
  Ask ask = Ask::rung_zero;
  Verdict verdict() const { return errors.empty() ? Verdict::valid : Verdict::invalid; }
};

/// All cases, in a fixed order, with distinct names.
std::vector<SuiteCase> suite();

/// Cases by subject; suite() joins them.
std::vector<SuiteCase> shell_cases();    // shells beside, in and on each other
std::vector<SuiteCase> ring_cases();     // rings that touch, in planes of all directions
std::vector<SuiteCase> surface_cases();  // tori, notches, surfaces with one side
std::vector<SuiteCase> number_cases();   // small, large, thin, geographic

/// A dent in a block whose floor is sloped: the tip lies on the floor exactly, or one step above.
enum class Tip : std::uint8_t { on_floor, above_floor };
Shape dented_block(Random& random, Tip tip);

/// The solid as a CityJSON document with a transform. Requires a decimal lattice.
std::string city_json_text(const Solid& solid);

}  // namespace watertight::solids
