// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/dms_domain.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "geometry/predicates/turn.h"
#include "spline/plane/proper_triangulation.h"
#include "spline/plane/triangle_parts.h"

namespace watertight::spline {
namespace {

std::vector<std::array<int, 3>> all_ijk(int degree) {
  std::vector<std::array<int, 3>> all;
  for (int i = degree; i >= 0; --i) {
    for (int j = degree - i; j >= 0; --j) all.push_back({i, j, degree - i - j});
  }
  return all;
}

/// Whether all knots lie on the right side of an edge of a triangle, so that their hull does not
/// meet it.
bool is_beyond_an_edge(std::span<const Point> knots, const std::array<Point, 3>& corners) {
  for (std::size_t j = 0; j < 3; ++j) {
    if (std::ranges::all_of(knots, [&](const Point& knot) {
          return geometry::turn(corners[j], corners[(j + 1) % 3], knot) < 0;
        })) {
      return true;
    }
  }
  return false;
}

bool has_three_on_a_line(std::span<const Point> knots) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    for (std::size_t j = i + 1; j < knots.size(); ++j) {
      for (std::size_t k = j + 1; k < knots.size(); ++k) {
        if (geometry::turn(knots[i], knots[j], knots[k]) == 0) return true;
      }
    }
  }
  return false;
}

std::array<Point, 3> corners_at(const DomainArrays& arrays, std::size_t triangle) {
  const auto& [a, b, c] = arrays.triangles[triangle];
  return {arrays.vertices[a], arrays.vertices[b], arrays.vertices[c]};
}

std::string name_of(Index triangle, const std::array<int, 3>& ijk) {
  return "function " + std::to_string(ijk[0]) + std::to_string(ijk[1]) + std::to_string(ijk[2]) +
         " of triangle " + std::to_string(triangle);
}

}  // namespace

Result<DmsDomain> DmsDomain::make(DomainArrays arrays) {
  if (arrays.degree < 1 || arrays.degree > kMostDegree) {
    return Error{ErrorCode::malformed, "the degree is not 1 to " + std::to_string(kMostDegree)};
  }
  if (arrays.triangles.size() > kMostTriangles) {
    return Error{ErrorCode::limit_exceeded,
                 "more than " + std::to_string(kMostTriangles) + " triangles"};
  }
  if (arrays.clouds.size() != arrays.vertices.size() * static_cast<std::size_t>(arrays.degree)) {
    return Error{ErrorCode::malformed, "the number of knots is not vertices times degree"};
  }
  for (std::size_t k = 0; k < arrays.clouds.size(); ++k) {
    if (!std::isfinite(arrays.clouds[k].x) || !std::isfinite(arrays.clouds[k].y)) {
      return Error{ErrorCode::malformed, "knot " + std::to_string(k) + " is not finite"};
    }
  }
  if (Status proper = check_triangulation(arrays.vertices, arrays.triangles); !proper)
    return proper.error();
  DmsDomain domain(std::move(arrays));
  if (Status checked = domain.check_functions(); !checked) return checked.error();
  domain.split_functions();
  domain.list_functions();
  domain.plan_parts();
  return domain;
}

DmsDomain::DmsDomain(DomainArrays arrays)
    : arrays_(std::move(arrays)),
      ijk_(all_ijk(arrays_.degree)),
      grid_(arrays_.vertices, arrays_.triangles) {}

const Point& DmsDomain::knot(Index vertex, int l) const {
  if (l == 0) return arrays_.vertices[vertex];
  return arrays_
      .clouds[static_cast<std::size_t>(vertex) * static_cast<std::size_t>(arrays_.degree) +
              static_cast<std::size_t>(l - 1)];
}

std::vector<Point> DmsDomain::knots_of(Index function) const {
  const Triangle& corners = arrays_.triangles[triangle_of(function)];
  const auto ijk = ijk_of(function);
  std::vector<Point> knots;
  for (std::size_t j = 0; j < 3; ++j) {
    for (int l = 0; l <= ijk[j]; ++l) knots.push_back(knot(corners[j], l));
  }
  return knots;
}

std::vector<Point> DmsDomain::blossom_arguments(Index function) const {
  const Triangle& corners = arrays_.triangles[triangle_of(function)];
  const auto ijk = ijk_of(function);
  std::vector<Point> arguments;
  for (std::size_t j = 0; j < 3; ++j) {
    for (int l = 0; l < ijk[j]; ++l) arguments.push_back(knot(corners[j], l));
  }
  return arguments;
}

Status DmsDomain::check_functions() const {
  for (Index t = 0; t < arrays_.triangles.size(); ++t) {
    const Triangle& corners = arrays_.triangles[t];
    for (int i = 0; i <= degree(); ++i) {
      for (int j = 0; j <= degree(); ++j) {
        for (int k = 0; k <= degree(); ++k) {
          if (geometry::turn(knot(corners[0], i), knot(corners[1], j), knot(corners[2], k)) > 0)
            continue;
          return Error{ErrorCode::malformed, "triangle " + std::to_string(t) +
                                                 " does not turn left with knots " +
                                                 std::to_string(i) + ", " + std::to_string(j) +
                                                 " and " + std::to_string(k) + " of its corners"};
        }
      }
    }
    for (std::size_t place = 0; place < ijk_.size(); ++place) {
      const auto function = static_cast<Index>(t * ijk_.size() + place);
      if (has_three_on_a_line(knots_of(function))) {
        return Error{ErrorCode::malformed,
                     "three knots of " + name_of(t, ijk_[place]) + " lie on a line"};
      }
    }
  }
  return Done{};
}

void DmsDomain::split_functions() {
  const auto per_vertex = static_cast<Index>(degree() + 1);
  for (Index function = 0; function < function_count(); ++function) {
    const Triangle& corners = arrays_.triangles[triangle_of(function)];
    const auto ijk = ijk_of(function);
    std::vector<Index> numbers;
    for (std::size_t j = 0; j < 3; ++j) {
      for (Index l = 0; l <= static_cast<Index>(ijk[j]); ++l)
        numbers.push_back(corners[j] * per_vertex + l);
    }
    tops_.push_back(table_.add(numbers, knots_of(function)));
    scales_.push_back(std::abs(
        twice_area(knot(corners[0], ijk[0]), knot(corners[1], ijk[1]), knot(corners[2], ijk[2]))));
  }
  table_.finish();
}

/// Lists for each triangle the functions whose hull can meet it.
void DmsDomain::list_functions() {
  std::vector<std::vector<Index>> functions(arrays_.triangles.size());
  for (Index function = 0; function < function_count(); ++function) {
    const std::vector<Point> knots = knots_of(function);
    for (const Index t : grid_.near(table_.rectangle(tops_[function]))) {
      if (!is_beyond_an_edge(knots, corners_at(arrays_, t))) functions[t].push_back(function);
    }
  }
  starts_.push_back(0);
  for (const std::vector<Index>& own : functions) {
    functions_.insert(functions_.end(), own.begin(), own.end());
    starts_.push_back(functions_.size());
  }
}

std::span<const Index> DmsDomain::functions_at(Index triangle) const {
  return std::span(functions_)
      .subspan(starts_[triangle], starts_[triangle + 1] - starts_[triangle]);
}

/// The splines of functions and all that they consist of. Parts of splines have smaller numbers, so
/// they come first.
std::vector<Index> DmsDomain::splines_of(std::span<const Index> functions) const {
  std::vector<Index> splines;
  for (const Index function : functions) splines.push_back(tops_[function]);
  for (std::size_t next = 0; next < splines.size(); ++next) {  // grows
    const SplitSpline& spline = table_[splines[next]];
    if (!spline.is_leaf()) splines.insert(splines.end(), spline.lower.begin(), spline.lower.end());
  }
  std::ranges::sort(splines);
  splines.erase(std::unique(splines.begin(), splines.end()), splines.end());
  return splines;
}

/// Most functions of a triangle are 0 but near one of its corners, where the knots are.
void DmsDomain::plan_parts() {
  for (Index t = 0; t < arrays_.triangles.size(); ++t) {
    const std::span<const Index> functions = functions_at(t);
    const std::vector<Index> splines = splines_of(functions);
    std::vector<std::vector<Point>> knots;
    for (const Index function : functions) knots.push_back(knots_of(function));
    for (std::size_t part = 0; part < kParts; ++part) {
      plans_.push_back({planned_functions_.size(), planned_splines_.size()});
      const std::array<Point, 3> corners = part_corners(corners_at(arrays_, t), part);
      const Rectangle around = Rectangle::around(corners);
      for (std::size_t i = 0; i < functions.size(); ++i) {
        const bool is_near = table_.rectangle(tops_[functions[i]]).meets(around);
        if (is_near && !is_beyond_an_edge(knots[i], corners))
          planned_functions_.push_back(functions[i]);
      }
      for (const Index number : splines) {
        const SplitSpline& spline = table_[number];
        const bool is_near = table_.rectangle(number).meets(around);
        if (is_near && !(spline.is_leaf() && is_beyond_an_edge(spline.corners(), corners)))
          planned_splines_.push_back(number);
      }
    }
  }
  plans_.push_back({planned_functions_.size(), planned_splines_.size()});
}

std::optional<PlaceInDomain> DmsDomain::place_of(const Point& u) const {
  std::optional<PlaceInDomain> touched;
  for (const Index t : grid_.at(u)) {
    const auto& [a, b, c] = corners_at(arrays_, t);
    if (geometry::turn(a, b, u) < 0 || geometry::turn(b, c, u) < 0 || geometry::turn(c, a, u) < 0)
      continue;
    if (is_in_triangle(a, b, c, u)) return PlaceInDomain{t, false};
    if (!touched) touched = PlaceInDomain{t, true};
  }
  return touched;
}

std::vector<ConstantPiece> DmsDomain::second_derivatives(Index function) const {
  WATERTIGHT_ASSERT(degree() == 2);
  std::vector<ConstantPiece> pieces;
  const SplitSpline& top = table_[tops_[function]];
  const auto outer = table_.gradients(tops_[function]);
  for (std::size_t j = 0; j < 3; ++j) {
    const SplitSpline& middle = table_[top.lower[j]];
    const auto inner = table_.gradients(top.lower[j]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double factor = 2 * scale_of(function) / table_[middle.lower[k]].doubled_area;
      pieces.push_back({middle.lower[k], factor * outer[j].x * inner[k].x,
                        factor * (outer[j].x * inner[k].y + outer[j].y * inner[k].x) / 2,
                        factor * outer[j].y * inner[k].y});
    }
  }
  return pieces;
}

}  // namespace watertight::spline
