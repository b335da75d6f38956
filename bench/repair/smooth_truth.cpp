// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cuts discs out of closed smooth meshes and closes the holes three times: with flat triangles on
// old vertices (`fill`), with smooth patches (`smooth`), and by CGAL's
// triangulate_refine_and_fair_hole. The surface that was cut out is the truth.
//
//   smooth_truth DISCS [--density D] [--chord M] [--collar N] [--crease DEG] [--cgal-density D]
//   [--details 1]
//     FILE...
//
// DISCS are cut out of each mesh, of 20 to 400 facets, as many at once as keep apart. Prints for
// each mesh and all together: the verdict of the exact tests, holes without a smooth patch by
// reason, the mean distance from what was cut out (both ways, in square roots of its area), the
// mean turn across edges of the border, vertices added, and seconds.
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bench/input.h"
#include "repair/repair.h"
#include "tests/random.h"
#include "validate/finding_kinds.h"

using namespace watertight;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits_3<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;
using Place = Kernel::Point_3;
using Corners = std::array<Place, 3>;
namespace processing = CGAL::Polygon_mesh_processing;

struct Disc {
  std::vector<Triangle> cut;
  std::set<std::pair<Index, Index>> border;  // as the cut triangles run
};

Place place_of(const repair::EditedSolid& solid, Index vertex) {
  const auto p = solid.lattice.world(solid.vertices[vertex]);
  return {p[0], p[1], p[2]};
}

/// Discs of triangles that keep a way from each other.
class Cutter {
 public:
  Cutter(const repair::EditedSolid& mesh, test::Random& random) : mesh_(mesh), random_(random) {
    const auto& facets = mesh.shells[0];
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const repair::Ring& ring = facets[i].rings[0];
      for (std::size_t j = 0; j < 3; ++j) facet_of_[{ring[j], ring[(j + 1) % 3]}] = i;
    }
    stars_.resize(mesh.vertices.size());
    for (std::size_t i = 0; i < facets.size(); ++i)
      for (const Index vertex : facets[i].rings[0]) stars_[vertex].push_back(i);
  }

  std::vector<Disc> cut(std::size_t most) {
    std::vector<Disc> discs;
    std::set<Index> taken;
    for (int attempt = 0; attempt < 400 && discs.size() < most; ++attempt) {
      if (auto disc = disc_at(random_.below(mesh_.shells[0].size()), taken))
        discs.push_back(*std::move(disc));
    }
    return discs;
  }

 private:
  Triangle corners(std::size_t facet) const {
    const repair::Ring& ring = mesh_.shells[0][facet].rings[0];
    return {ring[0], ring[1], ring[2]};
  }

  /// Grows from a facet by whole stars of vertices, breadth first, to 20 to 400 facets.
  std::optional<Disc> disc_at(std::size_t start, std::set<Index>& taken) {
    const std::size_t size = 20 + random_.below(381);
    std::vector<std::size_t> order{start};
    std::set<std::size_t> own{start};
    for (std::size_t at = 0; at < order.size() && own.size() < size; ++at) {
      for (std::size_t j = 0; j < 3; ++j) {
        const Triangle t = corners(order[at]);
        const std::size_t next = facet_of_.at({t[(j + 1) % 3], t[j]});
        if (own.insert(next).second) order.push_back(next);
      }
    }
    close_gaps(own);
    Disc disc;
    std::map<Index, int> passes;
    for (const std::size_t facet : own) {
      const Triangle t = corners(facet);
      disc.cut.push_back(t);
      for (std::size_t j = 0; j < 3; ++j) {
        if (own.contains(facet_of_.at({t[(j + 1) % 3], t[j]}))) continue;
        disc.border.emplace(t[j], t[(j + 1) % 3]);
        if (++passes[t[j]] > 1) return std::nullopt;
      }
    }
    if (!is_one_loop(disc)) return std::nullopt;
    return is_apart(own, taken) ? std::optional(std::move(disc)) : std::nullopt;
  }

  /// Adds facets that have two neighbours in the disc, so that its border is not jagged.
  void close_gaps(std::set<std::size_t>& own) const {
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      std::map<std::size_t, int> around;
      for (const std::size_t facet : own) {
        const Triangle t = corners(facet);
        for (std::size_t j = 0; j < 3; ++j) {
          const std::size_t next = facet_of_.at({t[(j + 1) % 3], t[j]});
          if (!own.contains(next)) ++around[next];
        }
      }
      for (const auto& [facet, count] : around) {
        if (count < 2) continue;
        own.insert(facet);
        has_changed = true;
      }
    }
  }

  static bool is_one_loop(const Disc& disc) {
    std::map<Index, Index> next(disc.border.begin(), disc.border.end());
    if (next.empty() || next.size() != disc.border.size()) return false;
    std::size_t steps = 0;
    Index at = next.begin()->first;
    do {
      at = next.at(at);
      ++steps;
    } while (at != next.begin()->first && steps <= next.size());
    return steps == next.size();
  }

  /// Whether no vertex within four rings is another disc's; takes them.
  bool is_apart(const std::set<std::size_t>& own, std::set<Index>& taken) const {
    std::set<Index> vertices;
    for (const std::size_t facet : own) {
      for (const Index vertex : corners(facet)) vertices.insert(vertex);
    }
    for (int ring = 0; ring < 4; ++ring) {
      std::set<Index> more = vertices;
      for (const Index vertex : vertices) {
        for (const std::size_t facet : stars_[vertex]) {
          for (const Index other : corners(facet)) more.insert(other);
        }
      }
      vertices = std::move(more);
    }
    if (std::ranges::any_of(vertices, [&](Index vertex) { return taken.contains(vertex); }))
      return false;
    taken.insert(vertices.begin(), vertices.end());
    return true;
  }

  const repair::EditedSolid& mesh_;
  test::Random& random_;
  std::map<std::pair<Index, Index>, std::size_t> facet_of_;
  std::vector<std::vector<std::size_t>> stars_;
};

/// A patch as triangles in space, with the turn across the border of the hole.
struct Patch {
  std::vector<Corners> triangles;
  double mean_turn = 0;
};

double degrees_between(const Kernel::Vector_3& a, const Kernel::Vector_3& b) {
  const double size = std::sqrt(a.squared_length() * b.squared_length());
  return size > 0 ? std::acos(std::clamp(a * b / size, -1.0, 1.0)) * 180 / 3.14159265358979 : 0;
}

Kernel::Vector_3 normal_of(const Corners& t) { return CGAL::normal(t[0], t[1], t[2]); }

double distance_from(const std::vector<Corners>& from, const std::vector<Corners>& to) {
  Mesh mesh;
  for (const Corners& t : to) {
    mesh.add_face(mesh.add_vertex(t[0]), mesh.add_vertex(t[1]), mesh.add_vertex(t[2]));
  }
  Tree tree(faces(mesh).begin(), faces(mesh).end(), mesh);
  tree.accelerate_distance_queries();
  double sum = 0;
  double area = 0;
  for (const auto& [a, b, c] : from) {
    const double own = std::sqrt(CGAL::squared_area(a, b, c));
    constexpr int kSteps = 3;  // places at (i + 1/3, j + 1/3) of a grid of this size
    int count = 0;
    double own_sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; i + j < kSteps; ++j) {
        const double s = (i + 1.0 / 3) / kSteps;
        const double t = (j + 1.0 / 3) / kSteps;
        own_sum += std::sqrt(tree.squared_distance(a + s * (b - a) + t * (c - a)));
        ++count;
      }
    }
    sum += own * own_sum / count;
    area += own;
  }
  return area > 0 ? sum / area : 0;
}

double area_of(const std::vector<Corners>& triangles) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) area += std::sqrt(CGAL::squared_area(a, b, c));
  return area;
}

struct Sums {
  std::size_t discs = 0;
  std::vector<double> of_discs;  // distances
  double distance = 0;
  double turn = 0;
  double seconds = 0;
  std::size_t vertices = 0;

  void add(const Patch& patch, const std::vector<Corners>& truth, std::size_t disc) {
    ++discs;
    of_discs.resize(std::max(of_discs.size(), disc + 1));
    of_discs[disc] =

        (distance_from(patch.triangles, truth) + distance_from(truth, patch.triangles)) /
        (2 * std::sqrt(area_of(truth)));
    distance += of_discs[disc];
    turn += patch.mean_turn;
  }
  void add(const Sums& other) {
    discs += other.discs;
    distance += other.distance;
    turn += other.turn;
    seconds += other.seconds;
    vertices += other.vertices;
  }
  void print(const char* name) const {
    const double count = discs > 0 ? static_cast<double>(discs) : 1;
    std::printf("  %-7s distance %.5f  turn %6.2f  vertices %7zu  %.3f s\n", name, distance / count,
                turn / count, vertices, seconds);
  }
};

struct Outcome {
  bool has_details = false;
  double cgal_density = 1.4142135623730951;  // CGAL's own default; more gives more vertices
  std::vector<double> areas;
  Sums cut, fill, smooth, cgal;
  std::map<std::string, std::size_t> refusals;
  std::map<std::string, std::size_t> verdicts;

  void add(const Outcome& other) {
    cut.add(other.cut);
    fill.add(other.fill);
    smooth.add(other.smooth);
    cgal.add(other.cgal);
    for (const auto& [name, count] : other.refusals) refusals[name] += count;
    for (const auto& [name, count] : other.verdicts) verdicts[name] += count;
  }
  void print(const char* name) const {
    std::printf("%s: %zu discs\n", name, fill.discs);
    cut.print("cut out");
    fill.print("fill");
    smooth.print("smooth");
    cgal.print("CGAL");
    for (const auto& [verdict, count] : verdicts)
      std::printf("  %zu times %s\n", count, verdict.c_str());
    for (const auto& [reason, count] : refusals)
      std::printf("  %zu discs without smooth patch: %s\n", count, reason.c_str());
  }
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A mesh with its discs cut out.
class Trial {
 public:
  Trial(const repair::EditedSolid& whole, std::vector<Disc> discs, std::size_t first)
      : discs_(std::move(discs)), first_(first), open_(whole) {
    std::set<Triangle> gone;
    for (const Disc& disc : discs_) gone.insert(disc.cut.begin(), disc.cut.end());
    std::erase_if(open_.shells[0], [&](const repair::EditedFacet& facet) {
      const repair::Ring& ring = facet.rings[0];
      return gone.contains({ring[0], ring[1], ring[2]});
    });
    for (std::size_t i = 0; i < discs_.size(); ++i) {
      std::vector<Corners>& truth = truth_.emplace_back();
      for (const auto& [a, b, c] : discs_[i].cut)
        truth.push_back({place_of(whole, a), place_of(whole, b), place_of(whole, c)});
      for (const auto& edge : discs_[i].border) disc_of_[edge.first] = i;
    }
    for (const repair::EditedFacet& facet : open_.shells[0]) {
      const repair::Ring& ring = facet.rings[0];
      for (std::size_t j = 0; j < 3; ++j)
        third_of_[{ring[j], ring[(j + 1) % 3]}] = ring[(j + 2) % 3];
    }
  }

  /// By fill_holes(), smooth or not.
  void by_us(const std::optional<repair::SmoothOptions>& smooth, Outcome& outcome) const {
    repair::EditedSolid closed = open_;
    repair::FillHolesOptions options;
    options.tolerances.planarity_metres = 0;  // no hole becomes one facet
    options.smooth = smooth;
    const auto start = std::chrono::steady_clock::now();
    const auto holes = repair::fill_holes(closed, options);
    Sums& sums = smooth ? outcome.smooth : outcome.fill;
    sums.seconds += seconds_since(start);
    sums.vertices += closed.vertices.size() - open_.vertices.size();
    auto facet = closed.shells[0].begin() + static_cast<std::ptrdiff_t>(open_.shells[0].size());
    for (const repair::HoleFill& hole : holes) {
      if (!hole.smooth_refusal.empty()) {
        if (outcome.has_details)
          std::printf("  hole of %zu edges (%s): %s: %s\n", hole.vertices, hole.method.c_str(),
                      hole.smooth_refusal.c_str(), hole.smooth_detail.c_str());
        ++outcome.refusals[hole.smooth_refusal];
      }
      std::vector<Triangle> triangles;
      for (std::size_t i = 0; i < hole.facets; ++i, ++facet) {
        const repair::Ring& ring = facet->rings[0];
        triangles.push_back({ring[0], ring[1], ring[2]});
      }
      add(
          triangles, [&](Index vertex) { return place_of(closed, vertex); }, sums);
    }
    if (!smooth) return;
    CertifyOptions rules;
    rules.proof = Proof::boundary;
    const auto solid = repair::solid_of(closed);
    ++outcome.verdicts[solid ? verdict_of(certify(*solid, nullptr, rules)) : "no solid"];
  }

  /// The surface that was cut out itself.
  void as_cut(const repair::EditedSolid& whole, Outcome& outcome) const {
    for (const auto& truth : truth_) outcome.areas.push_back(area_of(truth));
    for (const Disc& disc : discs_) {
      add(
          disc.cut, [&](Index vertex) { return place_of(whole, vertex); }, outcome.cut);
    }
  }

  void by_cgal(Outcome& outcome) const {
    Mesh mesh;
    for (Index vertex = 0; vertex < open_.vertices.size(); ++vertex)
      mesh.add_vertex(place_of(open_, vertex));
    for (const repair::EditedFacet& facet : open_.shells[0]) {
      const repair::Ring& ring = facet.rings[0];
      mesh.add_face(Mesh::Vertex_index(ring[0]), Mesh::Vertex_index(ring[1]),
                    Mesh::Vertex_index(ring[2]));
    }
    for (const Disc& disc : discs_) {
      const auto& [from, to] = *disc.border.begin();
      // The halfedge of the border runs as the facets of the disc did.
      const auto border = mesh.halfedge(Mesh::Vertex_index(from), Mesh::Vertex_index(to));
      std::vector<Mesh::Face_index> made;
      std::vector<Mesh::Vertex_index> added;
      const auto start = std::chrono::steady_clock::now();
      processing::triangulate_refine_and_fair_hole(
          mesh, border,
          CGAL::parameters::face_output_iterator(std::back_inserter(made))
              .vertex_output_iterator(std::back_inserter(added))
              .density_control_factor(outcome.cgal_density));
      outcome.cgal.seconds += seconds_since(start);
      outcome.cgal.vertices += added.size();
      std::vector<Triangle> triangles;
      for (const auto face : made) {
        Triangle& t = triangles.emplace_back();
        std::size_t j = 0;
        for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
          t[j++] = static_cast<Index>(vertex);
      }
      add(
          triangles, [&](Index vertex) { return mesh.point(Mesh::Vertex_index(vertex)); },
          outcome.cgal);
    }
  }

 private:
  static std::string verdict_of(const Inspection& inspection) {
    std::string text(validate::to_string(inspection.report.verdict));
    for (const int code : validate::error_codes(inspection.report.findings))
      text += ' ' + std::to_string(code);
    return text;
  }

  template <class PlaceOf>
  void add(const std::vector<Triangle>& triangles, const PlaceOf& place, Sums& sums) const {
    Patch patch;
    std::optional<std::size_t> disc;
    std::size_t edges = 0;
    for (const Triangle& t : triangles) {
      const Corners corners{place(t[0]), place(t[1]), place(t[2])};
      patch.triangles.push_back(corners);
      for (std::size_t j = 0; j < 3; ++j) {
        const auto found = disc_of_.find(t[j]);
        if (found == disc_of_.end()) continue;
        disc = found->second;
        const Index to = t[(j + 1) % 3];
        if (!discs_[*disc].border.contains({t[j], to})) continue;
        const Index behind = third_of_.at({to, t[j]});
        patch.mean_turn +=
            degrees_between(normal_of(corners), normal_of({place(to), place(t[j]), place(behind)}));
        ++edges;
      }
    }
    if (!disc) return;
    if (edges > 0) patch.mean_turn /= static_cast<double>(edges);
    sums.add(patch, truth_[*disc], first_ + *disc);
  }

  std::vector<Disc> discs_;
  std::size_t first_;  // the number of the first disc among all of the mesh
  repair::EditedSolid open_;
  std::vector<std::vector<Corners>> truth_;
  std::map<Index, std::size_t> disc_of_;  // by vertex of the border
  std::map<std::pair<Index, Index>, Index> third_of_;
};

std::optional<repair::EditedSolid> mesh_in(const char* file) {
  const auto document = bench::read_file(file);
  if (!document || document->features.empty()) return std::nullopt;
  const repair::EditedSolid solid = repair::edited(document->features[0].solids[0].solid);
  // As triangles.
  repair::EditedSolid mesh{solid.vertices, {{}}, solid.lattice, solid.srid};
  for (const repair::EditedFacet& facet : solid.shells[0]) {
    const repair::Ring& ring = facet.rings[0];
    for (std::size_t i = 2; i < ring.size(); ++i)
      mesh.shells[0].push_back({{{ring[0], ring[i - 1], ring[i]}}, facet.source});
  }
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::size_t discs = std::stoul(argv[1]);
  repair::SmoothOptions smooth;
  Outcome settings;
  int first = 2;
  for (; first + 1 < argc && argv[first][0] == '-'; first += 2) {
    const std::string name = argv[first];
    if (name == "--density") smooth.density = std::stod(argv[first + 1]);
    if (name == "--chord") smooth.chord_metres = std::stod(argv[first + 1]);
    if (name == "--collar") smooth.collar.rings = std::stoi(argv[first + 1]);
    if (name == "--details") settings.has_details = true;
    if (name == "--cgal-density") settings.cgal_density = std::stod(argv[first + 1]);
    if (name == "--crease") smooth.collar.crease_degrees = std::stod(argv[first + 1]);
  }
  Outcome all;
  for (int i = first; i < argc; ++i) {
    const auto mesh = mesh_in(argv[i]);
    if (!mesh) return 1;
    test::Random random(71);
    Cutter cutter(*mesh, random);
    Outcome own = settings;
    while (own.fill.discs < discs) {
      const Trial trial(*mesh, cutter.cut(discs - own.fill.discs), own.fill.discs);
      const std::size_t before = own.fill.discs;
      trial.as_cut(*mesh, own);
      trial.by_us(std::nullopt, own);
      trial.by_us(smooth, own);
      trial.by_cgal(own);
      if (own.fill.discs == before) break;
    }
    own.print(argv[i]);
    for (std::size_t disc = 0; own.has_details && disc < own.smooth.of_discs.size(); ++disc) {
      std::printf("  disc %3zu (area %.5f): fill %.5f smooth %.5f CGAL %.5f\n", disc,
                  own.areas[disc], own.fill.of_discs[disc], own.smooth.of_discs[disc],
                  own.cgal.of_discs[disc]);
    }
    all.add(own);
  }
  all.print("all");
  return 0;
}
