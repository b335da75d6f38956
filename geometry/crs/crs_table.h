// SPDX-License-Identifier: GPL-3.0-or-later
//
// The unit of every EPSG code as a table of runs. Private to geometry/: see crs.h.
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

/// EPSG codes first .. last, inclusive.
struct CrsRun {
  std::uint32_t first;
  std::uint32_t last;
  CrsUnit unit;
};

/// Sorted, without overlap.
std::span<const CrsRun> crs_runs();

}  // namespace watertight::geometry
