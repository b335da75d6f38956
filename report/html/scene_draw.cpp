// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/json_text.h"
#include "geometry/vector3.h"
#include "report/html/scene.h"

namespace watertight::report {
namespace {

constexpr double kWidth = 640;
constexpr double kHeight = 480;
constexpr double kMargin = 28;
constexpr double kDegree = std::numbers::pi / 180;

using geometry::dot;

/// The normal of a ring by Newell's method, of length 1; 0 for a ring without area.
Triple normal_of(const std::vector<Triple>& ring) {
  Triple sum{};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Triple& a = ring[i];
    const Triple& b = ring[(i + 1) % ring.size()];
    sum[0] += (a[1] - b[1]) * (a[2] + b[2]);
    sum[1] += (a[2] - b[2]) * (a[0] + b[0]);
    sum[2] += (a[0] - b[0]) * (a[1] + b[1]);
  }
  const double length = std::sqrt(dot(sum, sum));
  if (!(length > 0)) return {};
  return {sum[0] / length, sum[1] / length, sum[2] / length};
}

/// The unit vectors to the right, up and towards the viewer.
struct Axes {
  Triple right;
  Triple up;
  Triple viewer;
};

Axes axes_of(const View& view) {
  const double a = view.azimuth * kDegree;
  const double e = view.elevation * kDegree;
  return {{-std::sin(a), std::cos(a), 0},
          {-std::sin(e) * std::cos(a), -std::sin(e) * std::sin(a), std::cos(e)},
          {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}};
}

/// Projects coordinates of a scene to those of the picture.
class Projection2 {
 public:
  Projection2(const Scene& scene, const Axes& axes) : axes_(axes) {
    double left = 0, right = 0, top = 0, bottom = 0;
    bool is_first = true;
    for (const SceneFacet& facet : scene.facets) {
      for (const auto& ring : facet.rings) {
        for (const Triple& p : ring) {
          // Facets that stick out of the scene's ball are cut off by the picture's frame.
          const double u = std::clamp(dot(p, axes.right), -kEdge, kEdge);
          const double v = std::clamp(dot(p, axes.up), -kEdge, kEdge);
          left = is_first ? u : std::min(left, u);
          right = is_first ? u : std::max(right, u);
          bottom = is_first ? v : std::min(bottom, v);
          top = is_first ? v : std::max(top, v);
          is_first = false;
        }
      }
    }
    const double width = std::max(right - left, 1.0);
    const double height = std::max(top - bottom, 1.0);
    scale_ = std::min((kWidth - 2 * kMargin) / width, (kHeight - 2 * kMargin) / height);
    middle_ = {(left + right) / 2, (top + bottom) / 2};
  }

  std::string operator()(const Triple& p) const {
    const auto [x, y] = at(p);
    std::string text = std::to_string(x);
    text += ' ';
    text += std::to_string(y);
    return text;
  }

  std::array<long, 2> at(const Triple& p) const {
    return {std::lround(kWidth / 2 + (dot(p, axes_.right) - middle_[0]) * scale_),
            std::lround(kHeight / 2 - (dot(p, axes_.up) - middle_[1]) * scale_)};
  }

 private:
  static constexpr double kEdge = 1100;  // a little more than a scene's radius
  Axes axes_;
  double scale_ = 1;
  std::array<double, 2> middle_{};
};

struct Drawn {
  const SceneFacet* facet = nullptr;
  double depth = 0;  // the mean distance towards the viewer
  std::string_view style;
};

/// The class of a facet in the page's style: that of a facet concerned, else one by how the facet
/// faces the light.
std::string_view style_of(const SceneFacet& facet, const Triple& normal, const Axes& axes) {
  if (facet.role == Role::first) return "a";
  if (facet.role == Role::second) return "b";
  if (dot(normal, axes.viewer) < 0) return "k";  // the back of a facet
  const Triple light{0.35 * axes.right[0] * -1 + 0.3 * axes.viewer[0],
                     0.35 * axes.right[1] * -1 + 0.3 * axes.viewer[1], 0.3 * axes.viewer[2] + 0.75};
  const double shade = dot(normal, light);
  return shade > 0.75 ? "n4" : shade > 0.45 ? "n3" : shade > 0.15 ? "n2" : "n1";
}

std::string path_of(const std::vector<std::vector<Triple>>& rings, const Projection2& project,
                    bool is_closed) {
  std::string path;
  for (const auto& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      path += i == 0 ? 'M' : 'L';
      path += project(ring[i]);
    }
    if (is_closed) path += 'Z';
  }
  return path;
}

std::string path_element(std::string_view style, const std::string& path) {
  std::string text = "<path class=\"";
  text += style;
  text += "\" d=\"";
  text += path;
  text += "\"/>";
  return text;
}

std::string witness_element(const Triple& witness, const Projection2& project) {
  const auto [x, y] = project.at(witness);
  std::string place = " cx=\"";
  place += std::to_string(x);
  place += "\" cy=\"";
  place += std::to_string(y);
  std::string text = "<circle class=\"h\"";
  text += place;
  text += "\" r=\"22\"/><circle class=\"w\"";
  text += place;
  text += "\" r=\"8\"/>";
  return text;
}

void append_ring(JsonText& json, const std::vector<Triple>& ring) {
  json.open('[');
  for (const Triple& p : ring) {
    for (const double coordinate : p) json.value(static_cast<std::int64_t>(coordinate));
  }
  json.close(']');
}

double score_of(const Scene& scene, const View& view) {
  const Axes axes = axes_of(view);
  double score = view.elevation > 0 ? 0.2 : 0;
  for (const SceneFacet& facet : scene.facets) {
    if (facet.role == Role::other_facet || facet.rings.empty()) continue;
    score += std::min(dot(normal_of(facet.rings.front()), axes.viewer), 0.6);
  }
  return score;
}

}  // namespace

View best_view(const Scene& scene) {
  View best{-60, 28};
  double best_score = score_of(scene, best) + 0.05;
  for (const double elevation : {28.0, -28.0}) {
    for (int step = 0; step < 12; ++step) {
      const View view{-60.0 + 30 * step, elevation};
      const double score = score_of(scene, view);
      if (score <= best_score + 1e-9) continue;
      best = view;
      best_score = score;
    }
  }
  return best;
}

std::string svg_of(const Scene& scene, const View& view) {
  const Axes axes = axes_of(view);
  const Projection2 project(scene, axes);
  std::vector<Drawn> drawn;
  for (const SceneFacet& facet : scene.facets) {
    if (facet.rings.empty() || facet.rings.front().empty()) continue;
    double depth = 0;
    for (const Triple& p : facet.rings.front()) depth += dot(p, axes.viewer);
    depth /= static_cast<double>(facet.rings.front().size());
    drawn.push_back({&facet, depth, style_of(facet, normal_of(facet.rings.front()), axes)});
  }
  // The facets that face away from the viewer are drawn first: on a closed surface they lie behind
  // those that face the viewer.
  std::stable_sort(drawn.begin(), drawn.end(), [](const Drawn& a, const Drawn& b) {
    return std::pair(a.style != "k", a.depth) < std::pair(b.style != "k", b.depth);
  });
  std::string svg = "<svg viewBox=\"0 0 640 480\" role=\"img\" aria-label=\"3D view\">";
  std::string outlines;
  for (const Drawn& facet : drawn) {
    const std::string path = path_of(facet.facet->rings, project, true);
    svg += path_element(facet.style, path);
    // The outlines of the facets concerned show through everything in front of them.
    if (facet.facet->role == Role::first) outlines += path_element("oa", path);
    if (facet.facet->role == Role::second) outlines += path_element("ob", path);
  }
  svg += outlines;
  if (!scene.lines.empty()) svg += path_element("l", path_of(scene.lines, project, false));
  if (scene.witness) svg += witness_element(*scene.witness, project);
  return svg + "</svg>";
}

std::string json_of(const Scene& scene, const View& view) {
  JsonText json;
  json.open('{').key("f").open('[');
  for (const SceneFacet& facet : scene.facets) {
    json.open('[').value(static_cast<int>(facet.role));
    for (const auto& ring : facet.rings) append_ring(json, ring);
    json.close(']');
  }
  json.close(']').key("l").open('[');
  for (const auto& line : scene.lines) append_ring(json, line);
  json.close(']');
  if (scene.witness) {
    json.key("w");
    append_ring(json, {*scene.witness});
  }
  json.key("v").open('[').value(view.azimuth).value(view.elevation).close(']');
  return json.close('}').take();
}

}  // namespace watertight::report
