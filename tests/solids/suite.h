// SPDX-License-Identifier: GPL-3.0-or-later
//
// The suite: solids with a name whose verdict and codes are known by construction, and a function
// that writes them as CityJSON for tests/golden/solids.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tests/solids/shape.h"

namespace watertight::solids {

/// The proof that the case needs; the verdict to be expected depends on it.
enum class Ask : std::uint8_t {
  rung_zero,  // the exact tests and the canonical DT decide
  engines,    // the engines' rungs decide
  boundary    // the exact tests alone decide
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

/// The cases of one subject each; suite() joins them.
std::vector<SuiteCase> shell_cases();    // shells beside, in and on each other
std::vector<SuiteCase> ring_cases();     // rings that touch, in planes of all directions
std::vector<SuiteCase> surface_cases();  // tori, notches, surfaces with one side
std::vector<SuiteCase> number_cases();   // small, large, thin and geographic coordinates

/// A block with a sloped floor and a dent whose tip lies exactly on the floor, or one step above.
enum class Tip : std::uint8_t { on_floor, above_floor };
Shape dented_block(Random& random, Tip tip);

/// The solid as a CityJSON document with a transform. Requires a decimal lattice.
std::string city_json_text(const Solid& solid);

}  // namespace watertight::solids
