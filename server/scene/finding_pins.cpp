// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/scene/finding_pins.h"

#include <utility>

#include "report/stored_findings.h"
#include "tiles/pin.h"

namespace watertight::server {
namespace {

tiles::Frame::Position middle_of(const std::optional<store::StoredBox>& box) {
  tiles::Frame::Position middle{};
  if (!box) return middle;
  for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] = (box->min[axis] + box->max[axis]) / 2;
  return middle;
}

}  // namespace

Result<std::vector<tiles::FeatureMesh>> pins_of(StoredFeature stored, std::uint32_t srid,
                                                const tiles::Frame& frame, const Limits& limits) {
  const auto feature = pipeline::unpack(std::move(stored), limits, pipeline::Reports::of_unproven);
  if (!feature) return feature.error();
  std::vector<report::StoredFinding> findings = report::findings_of(*feature);
  if (findings.empty()) findings.emplace_back().name = "not proven";
  if (findings.size() > kMostPins) findings.resize(kMostPins);
  std::vector<tiles::Frame::Position> places;
  for (const report::StoredFinding& finding : findings) {
    places.push_back(finding.witness.value_or(middle_of(feature->box)));
  }
  const auto placed = frame.place(srid, places);
  std::vector<tiles::FeatureMesh> pins;
  if (!placed) return pins;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    tiles::FeatureMesh& pin = pins.emplace_back();
    pin.id = feature->id;
    pin.type = "finding";
    pin.properties = report::properties_of(findings[i]);
    tiles::add_pin(pin, (*placed)[i]);
  }
  return pins;
}

}  // namespace watertight::server
