// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/dms_surface.h"

#include <cmath>
#include <string>
#include <utility>

#include "spline/plane/triangle_parts.h"

namespace watertight::spline {
namespace {

void add(Point& sum, double factor, const Point& coefficient) {
  sum.x += factor * coefficient.x;
  sum.y += factor * coefficient.y;
  sum.z += factor * coefficient.z;
}

Point combined(std::span<const Point> points, std::span<const double> factors) {
  Point sum;
  for (std::size_t i = 0; i < points.size(); ++i) add(sum, factors[i], points[i]);
  return sum;
}

}  // namespace

BasisEvaluator::BasisEvaluator(const DmsDomain& domain)
    : domain_(domain), splines_(domain.table_.size()) {}

/// The recursion of the paper's equation 1, from the triangles of knots upwards. Each part is
/// computed once a point: functions share most.
template <class IsIn>
void BasisEvaluator::compute_splines(std::span<const Index> splines, const Point& u,
                                     const IsIn& is_in) {
  ++point_;
  for (const Index number : splines) {
    const SplitSpline& spline = domain_.table_[number];
    const std::array<Point, 3> corners = spline.corners();
    const auto& [a, b, c] = corners;
    double value = 0;
    if (spline.is_leaf()) {
      if (is_in(corners)) value = spline.inverse_area;
    } else {
      value = (twice_area(u, b, c) * value_of(spline.lower[0]) +
               twice_area(u, c, a) * value_of(spline.lower[1]) +
               twice_area(u, a, b) * value_of(spline.lower[2])) *
              spline.inverse_area;
    }
    splines_[number] = {point_, value};
  }
}

void BasisEvaluator::add_derivatives(Index function, int order, BasisValue& value) const {
  const SplineTable& table = domain_.table_;
  const Index spline = domain_.tops_[function];
  const SplitSpline& top = table[spline];
  const double scale = domain_.scales_[function];
  const auto outer = table.gradients(spline);
  const int degree = domain_.degree();
  for (std::size_t j = 0; j < 3; ++j) {
    const double factor = degree * scale;
    const double lower = value_of(top.lower[j]);
    value.first[0] += factor * outer[j].x * lower;
    value.first[1] += factor * outer[j].y * lower;
    const SplitSpline& middle = table[top.lower[j]];
    if (order < 2 || middle.is_leaf()) continue;
    const auto inner = table.gradients(top.lower[j]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double part = factor * (degree - 1) * value_of(middle.lower[k]);
      value.second[0] += part * outer[j].x * inner[k].x;
      value.second[1] += part * (outer[j].x * inner[k].y + outer[j].y * inner[k].x) / 2;
      value.second[2] += part * outer[j].y * inner[k].y;
    }
  }
}

template <class IsIn>
std::span<const BasisValue> BasisEvaluator::compute(Index triangle, const Point& u, int order,
                                                    const IsIn& is_in) {
  const Triangle& corners = domain_.arrays().triangles[triangle];
  const std::array<Point, 3> points{domain_.knot(corners[0], 0), domain_.knot(corners[1], 0),
                                    domain_.knot(corners[2], 0)};
  const std::size_t part = triangle * kParts + part_of(points, u);
  const auto& plan = domain_.plans_[part];
  const auto& end = domain_.plans_[part + 1];
  compute_splines(std::span(domain_.planned_splines_)
                      .subspan(plan.first_spline, end.first_spline - plan.first_spline),
                  u, is_in);
  found_.clear();
  for (std::size_t i = plan.first_function; i < end.first_function; ++i) {
    const Index function = domain_.planned_functions_[i];
    BasisValue value{
        function, domain_.scales_[function] * value_of(domain_.tops_[function]), {}, {}};
    if (order > 0) add_derivatives(function, order, value);
    const bool is_zero = value.value == 0 && value.first == std::array<double, 2>{} &&
                         value.second == std::array<double, 3>{};
    if (!is_zero) found_.push_back(value);
  }
  return found_;
}

std::optional<std::span<const BasisValue>> BasisEvaluator::at(const Point& u, int order) {
  const std::optional<PlaceInDomain> place = domain_.place_of(u);
  if (!place) return std::nullopt;
  if (place->is_on_border) return in_triangle(place->triangle, u, order);
  return compute(place->triangle, u, order, [&](const std::array<Point, 3>& corners) {
    return is_in_triangle(corners[0], corners[1], corners[2], u);
  });
}

std::span<const BasisValue> BasisEvaluator::in_triangle(Index triangle, const Point& u, int order) {
  Point center;
  for (const Index corner : domain_.arrays().triangles[triangle]) {
    center.x += domain_.knot(corner, 0).x / 3;
    center.y += domain_.knot(corner, 0).y / 3;
  }
  return compute(triangle, u, order, [&](const std::array<Point, 3>& corners) {
    return is_in_triangle_from(corners[0], corners[1], corners[2], u, center);
  });
}

SurfacePoint sum_of(std::span<const BasisValue> functions, std::span<const Point> coefficients) {
  SurfacePoint sum;
  for (const BasisValue& function : functions) {
    const Point& coefficient = coefficients[function.function];
    add(sum.value, function.value, coefficient);
    for (std::size_t i = 0; i < 2; ++i) add(sum.first[i], function.first[i], coefficient);
    for (std::size_t i = 0; i < 3; ++i) add(sum.second[i], function.second[i], coefficient);
  }
  return sum;
}

Result<DmsSurface> DmsSurface::make(const DmsDomain& domain, std::vector<Point> coefficients) {
  if (coefficients.size() != domain.function_count()) {
    return Error{ErrorCode::malformed, std::to_string(coefficients.size()) + " coefficients for " +
                                           std::to_string(domain.function_count()) + " functions"};
  }
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const Point& c = coefficients[i];
    if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z)) {
      return Error{ErrorCode::malformed, "coefficient " + std::to_string(i) + " is not finite"};
    }
  }
  return DmsSurface(domain, std::move(coefficients));
}

std::vector<std::optional<SurfacePoint>> DmsSurface::values(std::span<const Point> us,
                                                            int order) const {
  std::vector<std::optional<SurfacePoint>> found;
  found.reserve(us.size());
  BasisEvaluator evaluator(*domain_);
  for (const Point& u : us) {
    const auto functions = evaluator.at(u, order);
    found.push_back(functions ? std::optional(sum_of(*functions, coefficients_)) : std::nullopt);
  }
  return found;
}

std::optional<Point> DmsSurface::value(const Point& u) const {
  const auto found = values({&u, 1}).front();
  return found ? std::optional(found->value) : std::nullopt;
}

std::optional<Point> DmsSurface::derivative(const Point& u, const Point& direction) const {
  const auto found = values({&u, 1}, 1).front();
  if (!found) return std::nullopt;
  return combined(found->first, std::array{direction.x, direction.y});
}

std::optional<Point> DmsSurface::second_derivative(const Point& u, const Point& first,
                                                   const Point& second) const {
  const auto found = values({&u, 1}, 2).front();
  if (!found) return std::nullopt;
  return combined(
      found->second,
      std::array{first.x * second.x, first.x * second.y + first.y * second.x, first.y * second.y});
}

double gaussian_curvature(const SurfacePoint& at) {
  const auto dot = [](const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
  const auto& [du, dv] = at.first;
  const Point normal{du.y * dv.z - du.z * dv.y, du.z * dv.x - du.x * dv.z,
                     du.x * dv.y - du.y * dv.x};
  const double area = dot(normal, normal);  // squared
  const double mixed = dot(at.second[1], normal);
  return (dot(at.second[0], normal) * dot(at.second[2], normal) - mixed * mixed) / (area * area);
}

}  // namespace watertight::spline
