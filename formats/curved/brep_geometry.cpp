// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/curved/brep_geometry.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "surfaces/curves/elementary.h"
#include "surfaces/curves/nurbs.h"

namespace watertight::formats {
namespace {

using surfaces::Curve;
using surfaces::Frame;
using surfaces::Surface;
using surfaces::Vector3;

}  // namespace

Error BrepValue::wrong(std::string message) const {
  return Error{ErrorCode::malformed, std::move(message), {}, pointer};
}

Result<BrepValue> BrepValue::member(std::string_view key) const {
  const Json* found = find_member(json, key);
  if (found == nullptr) return wrong("a member \"" + std::string(key) + "\" should stand here");
  return BrepValue{*found, pointer + pointer_token(key)};
}

Result<BrepValue> BrepValue::array(std::string_view key, std::size_t fewest) const {
  auto found = member(key);
  if (!found) return found;
  if (!found->json.is_array() || found->json.size() < fewest) {
    return found->wrong(fewest == 0 ? "an array should stand here"
                                    : "an array of " + std::to_string(fewest) +
                                          " or more should stand here");
  }
  return found;
}

BrepValue BrepValue::at(std::size_t index) const {
  return {json[index], pointer + pointer_token(index)};
}

Result<double> BrepValue::number() const {
  double value = 0;
  if (json.is_binary()) {  // a number that is kept as its text
    const auto& text = json.get_binary();
    const std::string digits(text.begin(), text.end());
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
  } else if (json.is_number()) {
    value = json.get<double>();
  } else {
    return wrong("a number should stand here");
  }
  if (!std::isfinite(value)) return wrong("a number beyond the range of doubles");
  return value;
}

Result<double> BrepValue::positive(std::string_view key) const {
  const auto found = member(key);
  if (!found) return found.error();
  const auto value = found->number();
  if (value && !(*value > 0)) return found->wrong("a positive number should stand here");
  return value;
}

Result<std::vector<double>> BrepValue::numbers() const {
  if (!json.is_array()) return wrong("an array of numbers should stand here");
  std::vector<double> values;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const auto value = at(i).number();
    if (!value) return value.error();
    values.push_back(*value);
  }
  return values;
}

Result<Vector3> BrepValue::point() const {
  const auto values = numbers();
  if (!values) return values.error();
  if (values->size() != 3) return wrong("an array of three numbers should stand here");
  return Vector3{(*values)[0], (*values)[1], (*values)[2]};
}

Result<bool> BrepValue::flag(std::string_view key) const {
  if (!has(key)) return false;
  const auto found = member(key);
  if (!found) return found.error();
  if (!found->json.is_boolean()) return found->wrong("true or false should stand here");
  return found->json.get<bool>();
}

Result<std::int64_t> BrepValue::whole(std::int64_t low, std::int64_t high) const {
  const bool is_too_large =
      json.is_number_unsigned() && json.get<std::uint64_t>() > static_cast<std::uint64_t>(high);
  if (!json.is_number_integer() || is_too_large || json.get<std::int64_t>() < low ||
      json.get<std::int64_t>() > high) {
    return wrong("a whole number from " + std::to_string(low) + " to " + std::to_string(high) +
                 " should stand here");
  }
  return json.get<std::int64_t>();
}

namespace {

/// A point or direction that may be missing.
Result<Vector3> point_or(const BrepValue& from, std::string_view key, const Vector3& without) {
  if (!from.has(key)) return without;
  const auto found = from.member(key);
  if (!found) return found.error();
  return found->point();
}

/// origin, axis (0, 0, 1 if missing), x (any across the axis if missing).
Result<Frame> frame_in(const BrepValue& from) {
  const auto origin = point_or(from, "origin", {0, 0, 0});
  if (!origin) return origin.error();
  const auto axis = point_or(from, "axis", {0, 0, 1});
  if (!axis) return axis.error();
  const auto x = point_or(from, "x", {1, 0, 0});
  if (!x) return x.error();
  if (!(surfaces::length(*axis) > 0)) return from.wrong("the axis has no direction");
  if (!(surfaces::length(*x) > 0)) return from.wrong("x has no direction");
  return surfaces::frame_of(*origin, *axis, *x);
}

Result<std::array<double, 2>> two_radii(const BrepValue& from) {
  const auto found = from.member("radii");
  if (!found) return found.error();
  const auto values = found->numbers();
  if (!values) return values.error();
  if (values->size() != 2 || !((*values)[0] > 0) || !((*values)[1] > 0)) {
    return found->wrong("two positive numbers should stand here");
  }
  return std::array<double, 2>{(*values)[0], (*values)[1]};
}

Result<std::vector<Vector3>> points_in(const BrepValue& list) {
  if (!list.json.is_array()) return list.wrong("an array of points should stand here");
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < list.json.size(); ++i) {
    const auto place = list.at(i).point();
    if (!place) return place.error();
    points.push_back(*place);
  }
  return points;
}

/// The knots of a Bezier curve: all of them at its ends.
surfaces::Knots bezier_knots(std::size_t degree) {
  surfaces::Knots knots{degree, std::vector<double>(degree + 1, 0.0)};
  knots.values.insert(knots.values.end(), degree + 1, 1.0);
  return knots;
}

/// The knots of `count` control points: as stated, or those of a Bezier curve.
Result<surfaces::Knots> knots_in(const std::optional<BrepValue>& degree,
                                 const std::optional<BrepValue>& knots, std::size_t count) {
  if (!knots || !degree) return bezier_knots(count - 1);
  const auto number = degree->whole(1, surfaces::kMostDegree);
  if (!number) return number.error();
  auto values = knots->numbers();
  if (!values) return values.error();
  if (values->size() != count + static_cast<std::size_t>(*number) + 1) {
    return knots->wrong(std::to_string(count) + " control points of degree " +
                        std::to_string(*number) + " have " +
                        std::to_string(count + static_cast<std::size_t>(*number) + 1) + " knots");
  }
  return surfaces::Knots{static_cast<std::size_t>(*number), *std::move(values)};
}

template <class Made>
Made at_value(const BrepValue& from, Made made) {
  if (made) return made;
  Error error = std::move(made).error();
  error.pointer = from.pointer;
  return error;
}

/// points; degree and knots, or neither for a Bezier curve; weights, or all 1.
Result<Curve> spline_curve_in(const BrepValue& from) {
  const auto list = from.array("points", 2);
  if (!list) return list.error();
  const auto points = points_in(*list);
  if (!points) return points.error();
  std::optional<BrepValue> degree;
  std::optional<BrepValue> knots;
  if (from.has("knots")) {
    auto found = from.member("degree");
    if (!found) return found.error();
    degree.emplace(*std::move(found));
    knots.emplace(*from.member("knots"));
  }
  const auto own = knots_in(degree, knots, points->size());
  if (!own) return own.error();
  std::vector<double> weights(points->size(), 1);
  if (from.has("weights")) {
    const auto stated = from.member("weights")->numbers();
    if (!stated) return stated.error();
    if (stated->size() != points->size()) return from.wrong("as many weights as control points");
    weights = *stated;
  }
  return at_value(from, surfaces::curve_of(*own, *points, weights));
}

/// The degree or the knots along u (0) or v (1).
Result<std::optional<BrepValue>> of_direction(const BrepValue& from, std::string_view key,
                                              std::size_t direction) {
  if (!from.has("knots")) return std::optional<BrepValue>();
  const auto both = from.array(key, 2);
  if (!both) return both.error();
  return std::optional<BrepValue>(both->at(direction));
}

Result<surfaces::Knots> knots_along(const BrepValue& from, std::size_t direction,
                                    std::size_t count) {
  const auto degree = of_direction(from, "degrees", direction);
  if (!degree) return degree.error();
  const auto knots = of_direction(from, "knots", direction);
  if (!knots) return knots.error();
  return knots_in(*degree, *knots, count);
}

/// points: rows along v, each along u; degrees and knots along u and v, or neither for a Bezier
/// patch; weights as points, or all 1.
Result<Surface> spline_surface_in(const BrepValue& from) {
  const auto rows = from.array("points", 2);
  if (!rows) return rows.error();
  std::vector<Vector3> points;
  std::vector<double> weights;
  std::size_t columns = 0;
  for (std::size_t k = 0; k < rows->json.size(); ++k) {
    const auto row = points_in(rows->at(k));
    if (!row) return row.error();
    if (k == 0) columns = row->size();
    if (row->size() != columns || columns < 2) {
      return rows->at(k).wrong("rows of as many control points, two or more");
    }
    points.insert(points.end(), row->begin(), row->end());
  }
  if (from.has("weights")) {
    const auto lists = from.array("weights", rows->json.size());
    if (!lists) return lists.error();
    for (std::size_t k = 0; k < lists->json.size(); ++k) {
      const auto row = lists->at(k).numbers();
      if (!row) return row.error();
      if (row->size() != columns) return lists->at(k).wrong("as many weights as control points");
      weights.insert(weights.end(), row->begin(), row->end());
    }
    if (weights.size() != points.size()) return lists->wrong("as many weights as control points");
  }
  weights.resize(points.size(), 1);
  const auto u = knots_along(from, 0, columns);
  if (!u) return u.error();
  const auto v = knots_along(from, 1, rows->json.size());
  if (!v) return v.error();
  return at_value(from, surfaces::surface_of(*u, *v, points, weights));
}

Result<Surface> swept_surface_in(const BrepValue& from, bool is_revolution) {
  const auto profile = from.member("curve");
  if (!profile) return profile.error();
  const auto curve = curve_in(*profile);
  if (!curve) return curve.error();
  if (is_revolution) {
    const auto frame = frame_in(from);
    if (!frame) return frame.error();
    return surfaces::revolved(*curve, *frame);
  }
  const auto found = from.member("direction");
  if (!found) return found.error();
  const auto direction = found->point();
  if (!direction) return direction.error();
  if (!(surfaces::length(*direction) > 0)) return found->wrong("no direction");
  return surfaces::extruded(*curve, *direction);
}

/// A cone grows along its axis: another one is written about the opposite axis.
Result<Surface> cone_in(const BrepValue& from, const Frame& frame) {
  const auto slope = from.positive("slope");
  if (!slope) return slope.error();
  const auto found = from.member("radius");
  if (!found) return found.error();
  const auto radius = found->number();
  if (!radius) return radius.error();
  if (*radius < 0) return found->wrong("a radius that is not negative should stand here");
  return surfaces::cone(frame, *radius, *slope);
}

Error unknown_kind(const BrepValue& from, const std::string& kind, const std::string& kinds) {
  return Error{
      ErrorCode::unsupported, "the type '" + kind + "' is none of " + kinds, {}, from.pointer};
}

}  // namespace

Result<Curve> curve_in(const BrepValue& from) {
  if (!from.json.is_object()) return from.wrong("an object should stand here");
  const std::string kind = string_member(from.json, "type");
  if (kind == "bspline") return spline_curve_in(from);
  if (kind == "polyline") {
    const auto list = from.array("points", 2);
    if (!list) return list.error();
    const auto points = points_in(*list);
    if (!points) return points.error();
    return surfaces::polyline(*points);
  }
  if (kind != "circle" && kind != "ellipse") {
    return unknown_kind(from, kind, "circle, ellipse, polyline, bspline");
  }
  const auto frame = frame_in(from);
  if (!frame) return frame.error();
  if (kind == "circle") {
    const auto radius = from.positive("radius");
    if (!radius) return radius.error();
    return surfaces::ellipse(*frame, *radius, *radius);
  }
  const auto radii = two_radii(from);
  if (!radii) return radii.error();
  return surfaces::ellipse(*frame, (*radii)[0], (*radii)[1]);
}

Result<Surface> surface_in(const BrepValue& from) {
  if (!from.json.is_object()) return from.wrong("an object should stand here");
  const std::string kind = string_member(from.json, "type");
  if (kind == "bspline") return spline_surface_in(from);
  if (kind == "revolution" || kind == "extrusion") {
    return swept_surface_in(from, kind == "revolution");
  }
  if (kind != "cylinder" && kind != "cone" && kind != "sphere" && kind != "torus") {
    return unknown_kind(from, kind,
                        "cylinder, cone, sphere, torus, revolution, extrusion, bspline");
  }
  const auto frame = frame_in(from);
  if (!frame) return frame.error();
  if (kind == "cone") return cone_in(from, *frame);
  if (kind == "torus") {
    const auto radii = two_radii(from);
    if (!radii) return radii.error();
    return surfaces::torus(*frame, (*radii)[0], (*radii)[1]);
  }
  const auto radius = from.positive("radius");
  if (!radius) return radius.error();
  return kind == "sphere" ? surfaces::sphere(*frame, *radius) : surfaces::cylinder(*frame, *radius);
}

}  // namespace watertight::formats
