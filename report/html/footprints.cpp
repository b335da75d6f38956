// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html/footprints.h"

#include <algorithm>
#include <cmath>

#include "geometry/crs/crs.h"
#include "report/html/html_page.h"

namespace watertight::report {
namespace {

constexpr std::size_t kMostDots = 20'000;
constexpr std::size_t kFewestDots = 8;
constexpr double kWidth = 1160;
constexpr double kHeight = 300;
constexpr double kMargin = 8;

}  // namespace

void Footprints::add(const pipeline::InspectedFeature& feature) {
  if (dots_.size() >= kMostDots || feature.feature.solids.empty()) return;
  const Solid& solid = feature.feature.solids.front().solid;
  if (solid.vertex_count() == 0) return;
  if (dots_.empty()) srid_ = solid.srid();
  if (solid.srid() != srid_) return;
  const Box box = solid.box();
  const Lattice& lattice = solid.lattice();
  dots_.push_back({lattice.world(box.min.x + (box.max.x - box.min.x) / 2, 0),
                   lattice.world(box.min.y + (box.max.y - box.min.y) / 2, 1), feature.verdict()});
}

std::string Footprints::svg() const {
  if (dots_.size() < kFewestDots) return "";
  double left = dots_[0].x, right = left, low = dots_[0].y, high = low;
  for (const Dot& dot : dots_) {
    left = std::min(left, dot.x);
    right = std::max(right, dot.x);
    low = std::min(low, dot.y);
    high = std::max(high, dot.y);
  }
  const auto metres = geometry::axis_units(srid_, {left, low, 0}).metres_per_unit;
  const double width = (right - left) * metres[0];
  const double height = (high - low) * metres[1];
  const double scale = std::min((kWidth - 2 * kMargin) / std::max(width, 1e-9),
                                (kHeight - 2 * kMargin) / std::max(height, 1e-9));
  if (!std::isfinite(width) || !std::isfinite(height) || !std::isfinite(scale)) return "";
  // The view box has the proportions of the area that the features cover. A browser, which scales
  // the view box to the width of the page, so shows the map without empty borders.
  const double shown_width = width * scale + 2 * kMargin;
  const double shown_height = height * scale + 2 * kMargin;
  std::string html = "<svg viewBox=\"0 0 ";
  append(html,
         {std::to_string(std::lround(shown_width)), " ", std::to_string(std::lround(shown_height)),
          "\" role=\"img\" aria-label=\"Map of features\">"});
  for (const Verdict verdict : {Verdict::valid, Verdict::undecided, Verdict::invalid}) {
    std::string path;
    for (const Dot& dot : dots_) {
      if (dot.verdict != verdict) continue;
      const double x = kMargin + (dot.x - left) * metres[0] * scale;
      const double y = shown_height - kMargin - (dot.y - low) * metres[1] * scale;
      append(path,
             {"M", std::to_string(std::lround(x)), " ", std::to_string(std::lround(y)), "h0"});
    }
    if (path.empty()) continue;
    html += "<path class=\"";
    html += validate::to_string(verdict);
    append(html, {"\" d=\"", path, "\"/>"});
  }
  return html + "</svg>";
}

}  // namespace watertight::report
