// SPDX-License-Identifier: GPL-3.0-or-later
//
// A finding as one line of text: code, name, object, place, coordinates, measured value. For the
// command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::report {

/// The object of a solid with its level of detail and, beyond the first, the number of the geometry
/// and of the solid in it: "b (LoD 2.2, geometry 1)". Without the id of an object: "solid 0", with
/// `noun` for "solid".
std::string object_words(const SolidSource& source, std::string_view noun = "solid");

/// A finding with its line.
struct FindingLine {
  const Finding* finding = nullptr;
  std::string text;
};

/// "error 302 SHELL_NOT_CLOSED in b (LoD 2.2), shell 0 facet 5, at 84616.468 447422.999 0.45:
/// a border of 4 edges (1.83 m, limit 10 mm)", for each finding of a feature, in the order of
/// findings_of().
std::vector<FindingLine> finding_lines(const pipeline::InspectedFeature& feature);

/// The same lines for a feature of which only the outcome is known: coordinates are those of
/// witnesses.
std::vector<FindingLine> finding_lines(const pipeline::FeatureOutcome& feature);

}  // namespace watertight::report
