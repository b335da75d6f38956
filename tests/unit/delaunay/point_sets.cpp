// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_sets.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <utility>

namespace watertight::point_sets {
namespace {

using Integers = std::vector<std::int64_t>;
using IntegerPoint = std::array<std::int64_t, 3>;
using IntegerPoints = std::vector<IntegerPoint>;
constexpr std::int64_t kMost = (std::int64_t{1} << 30) - 1;

/// The points (i, j, k) for 0 <= i < a, 0 <= j < b, 0 <= k < c.
IntegerPoints box(std::int64_t a, std::int64_t b, std::int64_t c) {
  IntegerPoints points;
  for (std::int64_t i = 0; i < a; ++i) {
    for (std::int64_t j = 0; j < b; ++j) {
      for (std::int64_t k = 0; k < c; ++k) points.push_back({i, j, k});
    }
  }
  return points;
}

/// All integer points whose squared distance from the origin is q.
IntegerPoints sphere(std::int64_t q) {
  IntegerPoints points;
  std::int64_t r = 0;
  while ((r + 1) * (r + 1) <= q) ++r;
  for (std::int64_t x = -r; x <= r; ++x) {
    for (std::int64_t y = -r; y <= r; ++y) {
      for (std::int64_t z = -r; z <= r; ++z) {
        if (x * x + y * y + z * z == q) points.push_back({x, y, z});
      }
    }
  }
  return points;
}

IntegerPoints random(std::int64_t n, std::int64_t m, std::int64_t seed) {
  Numbers numbers(static_cast<std::uint64_t>(seed));
  IntegerPoints points;
  for (std::int64_t i = 0; i < n; ++i) {
    IntegerPoint p{};
    for (std::int64_t& c : p) c = numbers.below(m);
    points.push_back(p);
  }
  return points;
}

/// n points, each coordinate of which is one of five values.
IntegerPoints extreme(std::int64_t n, std::int64_t seed) {
  constexpr std::array<std::int64_t, 5> kChoices{0, 1, std::int64_t{1} << 29, kMost - 1, kMost};
  IntegerPoints points = random(n, 5, seed);
  for (IntegerPoint& p : points) {
    for (std::int64_t& c : p) c = kChoices[static_cast<std::size_t>(c)];
  }
  return points;
}

/// The points of a sphere times k, with each coordinate moved by -1, 0 or 1.
IntegerPoints near_sphere(std::int64_t q, std::int64_t k, std::int64_t seed) {
  Numbers numbers(static_cast<std::uint64_t>(seed));
  IntegerPoints points = sphere(q);
  for (IntegerPoint& p : points) {
    for (std::int64_t& c : p) c = k * c + numbers.below(3) - 1;
  }
  return points;
}

/// The points (x, y, z) with x^2 + y^2 = q at k heights that are h apart.
IntegerPoints circles(std::int64_t q, std::int64_t k, std::int64_t h) {
  IntegerPoints points;
  for (std::int64_t x = -q; x <= q; ++x) {
    for (std::int64_t y = -q; y <= q && x * x <= q; ++y) {
      for (std::int64_t i = 0; i < k && x * x + y * y == q; ++i) points.push_back({x, y, i * h});
    }
  }
  return points;
}

/// A row of gabled houses of 1000 by 800 by 500, with ridges 300 higher.
IntegerPoints houses(std::int64_t n) {
  IntegerPoints points;
  for (std::int64_t i = 0; i <= n; ++i) {
    for (const std::int64_t y : {0, 800}) {
      for (const std::int64_t z : {0, 500}) points.push_back({1000 * i, y, z});
    }
    points.push_back({1000 * i, 400, 800});
  }
  return points;
}

/// A random footprint at two or three heights: points on walls and on few planes.
IntegerPoints tower(std::int64_t n, std::int64_t m, std::int64_t seed) {
  Numbers numbers(static_cast<std::uint64_t>(seed));
  const std::array<std::int64_t, 3> heights{0, numbers.below(m), numbers.below(m)};
  IntegerPoints points;
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t x = numbers.below(m);
    const std::int64_t y = numbers.below(m);
    points.push_back({x, y, 0});
    points.push_back({x, y, heights[static_cast<std::size_t>(1 + numbers.below(2))]});
  }
  return points;
}

/// A random set in a plane, and d points off the plane.
IntegerPoints flat(std::int64_t n, std::int64_t m, std::int64_t d, std::int64_t seed) {
  IntegerPoints points = random(n, m, seed);
  for (std::int64_t i = d; i < n; ++i) points[static_cast<std::size_t>(i)][2] = 0;
  return points;
}

/// Points on few lines: all coordinates but one are 0 or m.
IntegerPoints lines(std::int64_t n, std::int64_t m, std::int64_t seed) {
  Numbers numbers(static_cast<std::uint64_t>(seed));
  IntegerPoints points;
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t free = numbers.below(3);
    IntegerPoint p{};
    for (std::int64_t axis = 0; axis < 3; ++axis) {
      p[static_cast<std::size_t>(axis)] =
          axis == free ? numbers.below(m + 1) : m * numbers.below(2);
    }
    points.push_back(p);
  }
  return points;
}

IntegerPoints transformed(IntegerPoints points, std::int64_t k) {
  for (auto& p : points) p = {k * p[0], k * p[1], k * p[2]};
  return points;
}

IntegerPoints sheared(IntegerPoints points) {
  for (auto& [x, y, z] : points) {
    const IntegerPoint p{5 * x + 2 * y, 3 * y - z, 7 * z + x};
    x = p[0], y = p[1], z = p[2];
  }
  return points;
}

IntegerPoints hollow(std::int64_t a) {
  IntegerPoints points = box(a, a, a);
  std::erase_if(points, [a](const IntegerPoint& p) {
    return std::all_of(p.begin(), p.end(), [a](std::int64_t c) { return c > 0 && c < a - 1; });
  });
  return points;
}

IntegerPoints paraboloid(std::int64_t a) {
  IntegerPoints points = box(2 * a + 1, 2 * a + 1, 1);
  for (auto& [x, y, z] : points) z = (x - a) * (x - a) + (y - a) * (y - a);
  return points;
}

/// Two skew lines of n points each.
IntegerPoints skew(std::int64_t n) {
  IntegerPoints points;
  for (std::int64_t i = 0; i < n; ++i) {
    points.push_back({i, 0, 0});
    points.push_back({0, i, n});
  }
  return points;
}

IntegerPoints both(IntegerPoints points, const IntegerPoints& others) {
  points.insert(points.end(), others.begin(), others.end());
  return points;
}

IntegerPoints integers(const std::string& kind, const Integers& p) {
  const auto is = [&](const char* name, std::size_t count) {
    return kind == name && p.size() == count;
  };
  if (is("grid", 4)) return transformed(box(p[0], p[1], p[2]), p[3]);
  if (is("sheared", 3)) return sheared(box(p[0], p[1], p[2]));
  if (is("hollow", 1)) return hollow(p[0]);
  if (is("random", 3)) return random(p[0], p[1], p[2]);
  if (is("sphere", 2)) return transformed(sphere(p[0]), p[1]);
  if (is("spheres", 2)) return both(sphere(p[0]), sphere(p[1]));
  if (is("near", 3)) return near_sphere(p[0], p[1], p[2]);
  if (is("circles", 3)) return circles(p[0], p[1], p[2]);
  if (is("houses", 1)) return houses(p[0]);
  if (is("tower", 3)) return tower(p[0], p[1], p[2]);
  if (is("flat", 4)) return flat(p[0], p[1], p[2], p[3]);
  if (is("lines", 3)) return lines(p[0], p[1], p[2]);
  if (is("paraboloid", 1)) return paraboloid(p[0]);
  if (is("skew", 1)) return skew(p[0]);
  if (is("extreme", 2)) return extreme(p[0], p[1]);
  return {};
}

std::string formula(const char* kind, const Integers& parameters) {
  std::string text = kind;
  for (const std::int64_t p : parameters) text.append(" ").append(std::to_string(p));
  return text;
}

}  // namespace

std::vector<Point> make(const std::string& formula) {
  std::istringstream words(formula);
  std::string kind;
  words >> kind;
  Integers parameters;
  for (std::int64_t p = 0; words >> p;) parameters.push_back(p);
  std::vector<Point> points;
  for (const auto& [x, y, z] : integers(kind, parameters)) {
    points.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

std::string any_formula(std::uint64_t number) {
  Numbers numbers(number);
  numbers.below(2);
  const auto seed = static_cast<std::int64_t>(number % (std::uint64_t{1} << 40));
  const auto from = [&](std::int64_t least, std::int64_t most) {
    return least + numbers.below(most - least + 1);
  };
  // One set of 64 is large.
  const std::int64_t n = from(0, 63) == 0 ? from(100, 2000) : from(4, from(8, 100));
  constexpr std::array<std::int64_t, 14> kSpheres{9,  14, 17, 21, 25, 26, 29,
                                                  41, 50, 54, 65, 81, 89, 101};
  const auto radius = [&] { return kSpheres[static_cast<std::size_t>(from(0, 13))]; };
  const std::int64_t m = std::int64_t{1} << from(2, 30);
  switch (from(0, 17)) {
    case 0:
      return formula("grid", {from(1, 6), from(1, 6), from(1, 6), from(1, 100000000)});
    case 1:
      return formula("sheared", {from(2, 5), from(2, 5), from(2, 5)});
    case 2:
      return formula("hollow", {from(2, 7)});
    case 3:
      return formula("sphere", {radius(), from(1, 50000000)});
    case 4:
      return formula("spheres", {radius(), radius()});
    case 5:
      return formula("near", {radius(), from(1, 50000000), seed});
    case 6:
      return formula("circles", {from(0, 1) == 0 ? 65 : 25, from(1, 4), from(1, 100)});
    case 7:
      return formula("houses", {from(1, 20)});
    case 8:
    case 9:
      return formula("tower", {n / 2 + 2, m, seed});
    case 10:
      return formula("flat", {n, m, from(1, 4), seed});
    case 11:
      return formula("lines", {n, m - 1, seed});
    case 12:
      return formula("paraboloid", {from(1, 7)});
    case 13:
      return formula("skew", {from(2, 20)});
    case 14:
      return formula("extreme", {n, seed});
    case 15:
      return formula("random", {n, from(2, 12), seed});
    default:
      return formula("random", {n, m, seed});
  }
}

std::vector<Point> shuffled(std::vector<Point> points, std::uint64_t seed) {
  Numbers numbers(seed);
  for (std::size_t i = points.size(); i > 1; --i) {
    const auto other = static_cast<std::size_t>(numbers.below(static_cast<std::int64_t>(i)));
    std::swap(points[i - 1], points[other]);
  }
  return points;
}

}  // namespace watertight::point_sets
