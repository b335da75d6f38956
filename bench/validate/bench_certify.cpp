// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures the cost of each group of rules on large generated solids (seconds of CPU time on one
// thread), without the constrained Delaunay tetrahedralization.
//
//   bench_certify [CASE FACES]...        default: all cases at 100,000 facets
//
// Cases: sphere (uneven, of triangles), boxgrid (a box of squares), bentgrid (a box of squares that
// are each slightly off their planes: rules 204 and 804), plate (a facet with FACES / 4 holes),
// cavities (one box with FACES / 6 boxes inside), comb (FACES / 5 teeth that nearly touch), soup
// (squares that share no edge), dust (a sphere 0.4 mm wide).
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include "validate/certify.h"
#include "validate/rules/rules.h"

using namespace watertight;

namespace {

class Builder {
 public:
  Index vertex(double x, double y, double z) {
    arrays_.vertices.push_back({std::nearbyint(x), std::nearbyint(y), std::nearbyint(z)});
    return static_cast<Index>(arrays_.vertices.size() - 1);
  }
  void ring(const std::vector<Index>& corners) {
    arrays_.ring_vertices.insert(arrays_.ring_vertices.end(), corners.begin(), corners.end());
    arrays_.end_ring();
  }
  void facet(const std::vector<Index>& corners) {
    ring(corners);
    arrays_.end_facet();
  }
  void end_facet() { arrays_.end_facet(); }
  void end_shell() { arrays_.end_shell(); }
  /// Adds an axis-parallel box, turned inward for a cavity.
  void box(const Point& low, const Point& high, bool is_inward) {
    std::array<Index, 8> v{};
    for (std::size_t i = 0; i < 8; ++i) {
      v[i] = vertex((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y,
                    (i & 4U) != 0 ? high.z : low.z);
    }
    const std::array<std::array<std::size_t, 4>, 6> facets{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}}};
    for (const auto& f : facets) {
      if (is_inward) {
        facet({v[f[3]], v[f[2]], v[f[1]], v[f[0]]});
      } else {
        facet({v[f[0]], v[f[1]], v[f[2]], v[f[3]]});
      }
    }
    end_shell();
  }
  Solid solid(double step_metres) {
    Lattice lattice;
    lattice.step.fill(geometry::shortest_decimal(step_metres));
    Limits limits;
    limits.vertices = limits.facets = limits.rings = limits.shells = 100'000'000;
    auto made = Solid::make(std::move(arrays_), lattice, 0, limits);
    if (!made) std::abort();
    return *std::move(made);
  }

 private:
  SolidArrays arrays_;
};

Solid sphere(std::size_t facets, double radius, double step) {
  Builder builder;
  const auto rows = static_cast<int>(std::sqrt(static_cast<double>(facets) / 4)) + 2;
  const int columns = 2 * rows;
  const auto at = [&](int row, int column) {
    const double polar = std::numbers::pi * row / rows;
    const double around = 2 * std::numbers::pi * column / columns;
    const double r = radius * (1 + 0.05 * std::sin(9 * around) * std::sin(7 * polar));
    return builder.vertex(r * std::sin(polar) * std::cos(around),
                          r * std::sin(polar) * std::sin(around), r * std::cos(polar));
  };
  const Index north = at(0, 0);
  std::vector<std::vector<Index>> grid(static_cast<std::size_t>(rows));
  for (int row = 1; row < rows; ++row) {
    for (int c = 0; c < columns; ++c) grid[static_cast<std::size_t>(row)].push_back(at(row, c));
  }
  const Index south = at(rows, 0);
  for (std::size_t c = 0; c < static_cast<std::size_t>(columns); ++c) {
    const std::size_t d = (c + 1) % static_cast<std::size_t>(columns);
    builder.facet({north, grid[1][c], grid[1][d]});
    for (std::size_t row = 1; row + 1 < grid.size(); ++row) {
      builder.facet({grid[row][c], grid[row + 1][c], grid[row + 1][d]});
      builder.facet({grid[row][c], grid[row + 1][d], grid[row][d]});
    }
    builder.facet({grid.back()[c], south, grid.back()[d]});
  }
  builder.end_shell();
  return builder.solid(step);
}

/// A box of squares of 1 m, in which every second corner of the top is `bend` millimetres higher.
Solid box_grid(std::size_t facets, double bend) {
  Builder builder;
  const auto n = static_cast<int>(std::sqrt(static_cast<double>(facets) / 6)) + 1;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_far : {false, true}) {
      const auto at = [&](int i, int j) {
        Point p;
        p[axis] = is_far ? n * 1000.0 : 0.0;
        p[(axis + 1) % 3] = i * 1000.0;
        p[(axis + 2) % 3] = j * 1000.0;
        const bool is_inner = i > 0 && j > 0 && i < n && j < n;
        if (is_inner && is_far && (i + j) % 2 == 0) p[axis] += bend;
        return builder.vertex(p.x, p.y, p.z);
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          if (is_far) {
            builder.facet({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
          } else {
            builder.facet({at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
          }
        }
      }
    }
  }
  builder.end_shell();
  return builder.solid(0.001);
}

Solid plate(std::size_t facets) {
  Builder builder;
  const auto n = static_cast<int>(std::sqrt(static_cast<double>(facets) / 4)) + 1;
  const double size = 3000.0 * n;
  const double thick = 500;
  const auto square = [&](double x, double y, double width, double z) {
    return std::vector<Index>{builder.vertex(x, y, z), builder.vertex(x + width, y, z),
                              builder.vertex(x + width, y + width, z),
                              builder.vertex(x, y + width, z)};
  };
  std::vector<std::vector<Index>> low{square(0, 0, size, 0)};
  std::vector<std::vector<Index>> high{square(0, 0, size, thick)};
  for (int i = 0; i < n * n; ++i) {
    const double x = 3000.0 * (i % n) + 1000;
    const double y = 3000.0 * (i / n) + 1000;
    low.push_back(square(x, y, 1000, 0));
    high.push_back(square(x, y, 1000, thick));
  }
  for (const bool is_top : {false, true}) {
    for (std::size_t r = 0; r < low.size(); ++r) {
      std::vector<Index> corners = is_top ? high[r] : low[r];
      if (is_top == (r != 0)) corners = {corners[3], corners[2], corners[1], corners[0]};
      builder.ring(corners);
    }
    builder.end_facet();
  }
  for (std::size_t r = 0; r < low.size(); ++r) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      if (r == 0) {
        builder.facet({low[r][i], low[r][j], high[r][j], high[r][i]});
      } else {
        builder.facet({low[r][j], low[r][i], high[r][i], high[r][j]});
      }
    }
  }
  builder.end_shell();
  return builder.solid(0.001);
}

Solid cavities(std::size_t facets) {
  Builder builder;
  const auto n = static_cast<int>(std::cbrt(static_cast<double>(facets) / 6)) + 1;
  const double size = 3000.0 * n;
  builder.box({0, 0, 0}, {size, size, size}, false);
  for (int i = 0; i < n * n * n; ++i) {
    const Point low{3000.0 * (i % n) + 1000, 3000.0 * (i / n % n) + 1000,
                    3000.0 * (i / n / n) + 1000};
    builder.box(low, {low.x + 1000, low.y + 1000, low.z + 1000}, true);
  }
  return builder.solid(0.001);
}

/// A row of long thin teeth: an extruded zigzag.
Solid comb(std::size_t facets) {
  Builder builder;
  const auto teeth = static_cast<int>(facets / 4) + 1;
  std::vector<Index> low;
  std::vector<Index> high;
  const auto corner = [&](double x, double y) {
    low.push_back(builder.vertex(x, y, 0));
    high.push_back(builder.vertex(x, y, 1000));
  };
  corner(0, -1000);
  corner(20.0 * teeth - 10, -1000);
  for (int i = teeth; i-- > 0;) {
    corner(20.0 * i + 10, 1e6);
    corner(20.0 * i, 1e6);
    if (i == 0) break;
    corner(20.0 * i, 0);
    corner(20.0 * i - 10, 0);
  }
  builder.facet(high);
  builder.facet(std::vector<Index>(low.rbegin(), low.rend()));
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t j = (i + 1) % low.size();
    builder.facet({low[i], low[j], high[j], high[i]});
  }
  builder.end_shell();
  return builder.solid(0.001);
}

Solid soup(std::size_t facets) {
  Builder builder;
  const auto n = static_cast<int>(std::sqrt(static_cast<double>(facets))) + 1;
  for (int i = 0; i < n * n; ++i) {
    const double x = 3000.0 * (i % n);
    const double y = 3000.0 * (i / n);
    builder.facet({builder.vertex(x, y, 0), builder.vertex(x + 1000, y, 0),
                   builder.vertex(x + 1000, y + 1000, 0), builder.vertex(x, y + 1000, 0)});
  }
  builder.end_shell();
  return builder.solid(0.001);
}

Solid make(const std::string& name, std::size_t facets) {
  if (name == "sphere") return sphere(facets, 1e7, 1e-6);
  if (name == "dust") return sphere(facets, 1e7, 2e-11);
  if (name == "boxgrid") return box_grid(facets, 0);
  if (name == "bentgrid") return box_grid(facets, 4);
  if (name == "plate") return plate(facets);
  if (name == "cavities") return cavities(facets);
  if (name == "comb") return comb(facets);
  if (name == "soup") return soup(facets);
  std::fprintf(stderr, "unknown case: %s\n", name.c_str());
  std::exit(1);
}

/// The CPU time of this process, which uses one thread.
class Stopwatch {
 public:
  double lap() {
    const std::clock_t now = std::clock();
    const double seconds = static_cast<double>(now - start_) / CLOCKS_PER_SEC;
    start_ = now;
    return seconds;
  }

 private:
  std::clock_t start_ = std::clock();
};

void measure_case(const std::string& name, std::size_t facets) {
  const Solid solid = make(name, facets);
  const CancelPoll never = {};
  Stopwatch watch;
  validate::ExaminedSolid examined(solid, Tolerances{}, Limits{});
  std::printf("%-9s %8u %8.3f", name.c_str(), solid.facet_count(), watch.lap());
  const auto lap = [&] { std::printf(" %8.3f", watch.lap()); };
  validate::check_rings(examined);
  lap();
  validate::check_facets(examined);
  lap();
  const auto shells = validate::check_shells(examined);
  lap();
  const auto duplicates = validate::check_duplicate_shells(examined);
  const validate::ShellContacts contacts =
      validate::check_intersections(examined, duplicates, never, 1);
  lap();
  validate::check_diagonals(examined, contacts);
  lap();
  validate::check_solid(examined, shells, duplicates, contacts);
  lap();
  validate::check_vertices(examined, {});
  lap();
  CertifyOptions options;
  options.proof = Proof::boundary;
  const Report report = certify(solid, nullptr, options).report;
  std::printf(" %8.3f %s %zu\n", watch.lap(),
              std::string(validate::to_string(report.verdict)).c_str(),
              report.findings.size() + report.findings_omitted);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-9s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s verdict findings\n", "case", "facets",
              "triangul", "rings", "planar", "shells", "intersec", "diagonal", "solid", "vertices",
              "certify");
  if (argc < 3) {
    for (const char* name :
         {"sphere", "dust", "boxgrid", "bentgrid", "plate", "cavities", "comb", "soup"}) {
      measure_case(name, 100'000);
    }
    return 0;
  }
  for (int i = 1; i + 1 < argc; i += 2) {
    measure_case(argv[i], static_cast<std::size_t>(std::strtoull(argv[i + 1], nullptr, 10)));
  }
  return 0;
}
