// SPDX-License-Identifier: GPL-3.0-or-later
//
// The elements of a document that stand for a solid and its parts, for formats that name them
// (GML): findings carry the names, so that a person finds the place in the file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "geometry/solid.h"
#include "validate/report.h"

namespace watertight::validate {

/// The lines count from 1; 0 is an unknown line. A list is empty, or has an entry for each facet or
/// each ring of the solid. The owner of the lists keeps them alive.
struct SourceElements {
  std::uint64_t line = 0;  // of the solid
  std::span<const std::string> facet_ids = {};
  std::span<const std::string> ring_ids = {};
  std::span<const std::uint64_t> facet_lines = {};
  std::span<const std::uint64_t> ring_lines = {};
};

/// The innermost element that holds a place of the solid. Cost: constant.
SourceElement element_at(const Place& place, const Solid& solid, const SourceElements& elements);

/// Sets Finding::source and Finding::other_source of a finding about one solid.
void name_elements(const Solid& solid, const SourceElements& elements, Finding& finding);

}  // namespace watertight::validate
