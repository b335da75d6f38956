// SPDX-License-Identifier: GPL-3.0-or-later
//
// A table of the units of all EPSG codes, by runs of codes with one unit. Private to geometry/: see
// crs.h.
#pragma once

#include <cstdint>
#include <span>

namespace watertight::geometry {

/// The unit of the horizontal axes, and of the vertical axis too unless the name says otherwise
/// (degrees and grads have heights in metres).
enum class CrsUnit : std::uint8_t {
  metre,
  us_survey_foot,
  foot,
  degree,
  degree_foot,
  degree_us_survey_foot,
  grad,
  kilometre,
  german_legal_metre,
  indian_yard,
  clarke_foot,
  clarke_link,
  clarke_yard,
  gold_coast_foot,
  link,
  sears_yard,
  sears_foot,
  sears_chain,
  sears_chain_truncated,
  benoit_chain
};

/// The EPSG codes first .. last, inclusive, and their unit.
struct CrsRun {
  std::uint32_t first;
  std::uint32_t last;
  CrsUnit unit;
};

/// The runs of all EPSG codes, sorted by code, without overlap.
std::span<const CrsRun> crs_runs();

}  // namespace watertight::geometry
