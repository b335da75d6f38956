// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/spline_json.h"

#include <array>
#include <cstddef>
#include <span>

#include "base/json_text.h"

namespace watertight::spline {
namespace {

void write_pair(JsonText& json, const Point& point) {
  json.open('[').value(point.x).value(point.y).close(']');
}

void write_pairs(JsonText& json, std::span<const Point> points) {
  json.open('[');
  for (const Point& point : points) write_pair(json, point);
  json.close(']');
}

}  // namespace

std::string to_json(const DmsSurface& surface) {
  const DomainArrays& arrays = surface.domain().arrays();
  const auto degree = static_cast<std::size_t>(arrays.degree);
  const std::size_t functions = surface.domain().functions_per_triangle();
  JsonText json;
  json.open('{')
      .key("type")
      .value("watertight_spline")
      .key("schema")
      .value(1)
      .key("degree")
      .value(arrays.degree);
  json.key("vertices");
  write_pairs(json, arrays.vertices);
  json.key("clouds").open('[');
  for (std::size_t v = 0; v < arrays.vertices.size(); ++v)
    write_pairs(json, std::span(arrays.clouds).subspan(v * degree, degree));
  json.close(']').key("triangles").open('[');
  for (const auto& [a, b, c] : arrays.triangles)
    json.open('[').value(a).value(b).value(c).close(']');
  json.close(']').key("coefficients").open('[');
  for (std::size_t t = 0; t < arrays.triangles.size(); ++t) {
    json.open('[');
    for (const Point& c : surface.coefficients().subspan(t * functions, functions))
      json.value(std::array{c.x, c.y, c.z});
    json.close(']');
  }
  return json.close(']').close('}').take();
}

}  // namespace watertight::spline
