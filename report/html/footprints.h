// SPDX-License-Identifier: GPL-3.0-or-later
//
// A map of features as dots, for the HTML report. Internal to report/.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::report {

class Footprints {
 public:
  /// Remembers where a feature is; only the first 20,000 features, in the first one's reference
  /// system.
  void add(const pipeline::InspectedFeature& feature);
  /// The map as an <svg> element; "" when there are too few features for a map.
  std::string svg() const;

 private:
  struct Dot {
    double x = 0;
    double y = 0;
    Verdict verdict = Verdict::valid;
  };
  std::vector<Dot> dots_;
  std::uint32_t srid_ = 0;
};

}  // namespace watertight::report
