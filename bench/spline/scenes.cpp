// SPDX-License-Identifier: GPL-3.0-or-later
//
// The four scenes of the paper on triangular B-splines (tests/unit/spline/scenes.h) in numbers:
// scenes [FOLDER]. Prints a row for each hole, those of the cone cap with 128 edges last, and
// writes the closed solids as OBJ files into FOLDER (draw_scenes.py makes pictures of them).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "tests/unit/spline/scenes.h"
#include "validate/certify.h"

using namespace watertight;
using samples::Point;

namespace {

/// How many of 100 surfaces with moved coefficients have less energy than a hole.
int count_of_lower(const samples::Scene& scene, const samples::FilledHole& hole) {
  const auto domain = scene.domain();
  const std::size_t functions = domain->functions_per_triangle();
  const double least = spline::thin_plate_energy(*domain, hole.triangles, scene.coefficients());
  std::mt19937_64 engine(7);
  int lower = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<Point> moved = scene.coefficients();
    for (const samples::Index t : hole.triangles) {
      Point& c = moved[t * functions + engine() % functions];
      c.z += (static_cast<double>(engine() >> 11U) / 9007199254740992.0 - 0.5) * 1e-3;
    }
    if (thin_plate_energy(*domain, hole.triangles, moved) < least) ++lower;
  }
  return lower;
}

void write_obj(const Solid& solid, const std::string& path) {
  std::ofstream file(path);
  for (const Point& p : solid.vertices()) {
    file << "v";
    for (int axis = 0; axis < 3; ++axis) file << ' ' << solid.lattice().world_text(p[axis], axis);
    file << '\n';
  }
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const IndexRange rings = solid.rings_of(facet);
    if (rings.size() > 1) continue;  // OBJ has no holes
    file << 'f';
    for (const Index vertex : solid.ring(rings.begin)) file << ' ' << vertex + 1;
    file << '\n';
  }
}

/// The Gaussian curvature in the middle of triangles.
std::vector<double> curvatures_in(const samples::Scene& scene,
                                  std::span<const samples::Index> triangles) {
  const auto domain = scene.domain();
  spline::BasisEvaluator evaluator(*domain);
  std::vector<double> curvatures;
  for (const samples::Index t : triangles) {
    Point middle;
    for (const samples::Index v : scene.arrays().triangles[t]) {
      middle.x += scene.arrays().vertices[v].x / 3;
      middle.y += scene.arrays().vertices[v].y / 3;
    }
    curvatures.push_back(spline::gaussian_curvature(
        spline::sum_of(evaluator.in_triangle(t, middle, 2), scene.coefficients())));
  }
  return curvatures;
}

/// The least, mean and largest of some values.
std::array<double, 3> extent_of(std::span<const double> values) {
  const auto [least, largest] = std::ranges::minmax(values);
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {least, sum / static_cast<double>(values.size()), largest};
}

void print_old_curvature(const samples::Scene& scene) {
  std::vector<samples::Index> old(scene.old_triangles());
  std::iota(old.begin(), old.end(), samples::Index{0});
  std::vector<double> curvatures = curvatures_in(scene, old);
  const auto [least, mean, largest] = extent_of(curvatures);
  for (double& value : curvatures) value = std::abs(value);
  const auto [least_size, mean_size, largest_size] = extent_of(curvatures);
  std::printf(
      "  old surfaces: curvature %.4f %.5f %.4f, without signs %.5f in the mean, %.4f at most\n",
      least, mean, largest, mean_size, largest_size);
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-16s %5s %8s %5s %10s %9s %8s %8s %6s %24s\n", "scene", "fit", "unknowns", "old",
              "energy", "condition", "jump", "slopes", "lower", "curvature of the hole");
  int number = 0;
  for (const auto& made : {samples::cone_cap(), samples::five_sided_hole(), samples::tee_joint(),
                           samples::junction(), samples::cone_cap(128)}) {
    ++number;
    if (!made) {
      std::printf("%s\n", to_string(made.error()).c_str());
      return 1;
    }
    const samples::Scene& scene = made->scene;
    const auto jumps = samples::jumps_of(scene);
    for (const samples::FilledHole& hole : scene.holes()) {
      const auto [least, mean, largest] = extent_of(curvatures_in(scene, hole.triangles));
      std::printf("%-16s %5.3f %8zu %5zu %10.4f %9.1e %8.1e %8.1e %6d %8.3f %7.3f %7.3f\n",
                  made->name.c_str(), scene.largest_fit_distance(), hole.plate.unknowns,
                  hole.plate.old_functions, hole.plate.energy, hole.plate.condition, jumps.value,
                  jumps.derivative, count_of_lower(scene, hole), least, mean, largest);
    }
    print_old_curvature(scene);
    const auto solid = samples::solid_of(*made);
    if (!solid) return 1;
    CertifyOptions rules;
    rules.proof = Proof::boundary;
    const Inspection inspection = certify(*solid, nullptr, rules);
    std::printf("  closed: %zu facets, %s\n", static_cast<std::size_t>(solid->facet_count()),
                std::string(validate::to_string(inspection.report.verdict)).c_str());
    if (argc > 1)
      write_obj(*solid, std::string(argv[1]) + "/scene-" + std::to_string(number) + ".obj");
  }
  return 0;
}
