// SPDX-License-Identifier: GPL-3.0-or-later
//
// A number by which a finding is found again in a later report of the same file. For baselines
// (cli/baseline.h) and SARIF.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "pipeline/pipeline.h"

namespace watertight::report {

/// The object that a finding is in, and the place in its solid.
struct FindingSide {
  std::string_view object;
  std::string_view lod;
  Place place = {};
};

/// The facts of a finding that stay when other findings come and go.
struct FindingIdentity {
  std::string_view file;  // as the user named it
  int code = 0;
  FindingSide side;
  std::optional<FindingSide> other = {};
  std::optional<std::array<double, 3>> witness = {};
};

/// The fingerprint: of file, code, objects with their levels of detail, and the witness to about a
/// millimetre, or the places where there is none. It does not depend on the order of the
/// document, of its findings or of the two sides. Several findings may have the same one. Cost:
/// linear in the names.
std::uint64_t fingerprint_of(const FindingIdentity& identity);

/// The name of a file as fingerprints take it: "./a/../b.json" is "b.json".
std::string plain_file_name(std::string_view file);

/// A finding of a feature, with its fingerprint.
struct IdentifiedFinding {
  const Finding* finding = nullptr;
  std::uint64_t fingerprint = 0;
};

/// The findings of a feature of `file`, in the order of findings_of().
std::vector<IdentifiedFinding> identified_findings(std::string_view file,
                                                   const pipeline::InspectedFeature& feature);

}  // namespace watertight::report
