// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangulates random trimmed regions of the plane, beside CGAL's constrained Delaunay
// triangulation and, where Debian's package libtess2-tulip-5.4 is installed, libtess2. One thread.
//
//   regions shape       least angles, strips, and edges at a vertex, for grids and loops
//   regions speed       million triangles a second, for loops with holes
//   regions loops N H   the regions of `speed` with N vertices and H holes, a loop a line, for
//                       earcut.py
//   regions update      microseconds of an update, and its share of a fresh run
//   regions check N     N regions, one in fifty with a moved point: the verdict is compared with an
//                       exact test of all pairs of edges, and of how loops contain each other
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/mark_domain_in_triangulation.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "geometry/predicates/predicates.h"
#include "tessellate/few_vertices.h"
#include "tessellate/strips.h"
#include "tessellate/trimmed/grid.h"
#include "tessellate/trimmed/trimmed_mesh.h"

using namespace watertight;
using tessellate::PlaneEdge;
using tessellate::PlaneGrid;
using tessellate::Region;

namespace {

constexpr double kTurn = 6.283185307179586;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void add_loop(Region& region, const std::vector<Point>& loop) {
  const auto first = static_cast<Index>(region.points.size());
  const auto count = static_cast<Index>(loop.size());
  for (Index i = 0; i < count; ++i) region.edges.push_back({first + i, first + (i + 1) % count});
  region.points.insert(region.points.end(), loop.begin(), loop.end());
}

// A loop around a middle whose radius goes up and down; holes turn right.
std::vector<Point> wavy_loop(std::mt19937& random, std::size_t count, const Point& middle,
                             double radius, bool is_hole) {
  const double waves = 2 + static_cast<double>(random() % 4);
  std::uniform_real_distribution<double> share(0, 1);
  const double begin = share(random) * kTurn;
  std::vector<Point> loop;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle =
        kTurn * (static_cast<double>(i) + 0.1 * share(random)) / static_cast<double>(count);
    const double at = radius * (0.8 + 0.2 * std::sin(waves * angle + begin));
    loop.push_back({middle.x + at * std::cos(angle), middle.y + at * std::sin(angle), 0});
  }
  if (is_hole) std::reverse(loop.begin(), loop.end());
  return loop;
}

// A region in the unit square with holes in a ring around its middle.
Region random_region(std::mt19937& random, std::size_t count, std::size_t holes) {
  Region region;
  const std::size_t of_hole = holes == 0 ? 0 : std::max<std::size_t>(4, count / (2 * holes + 2));
  const std::size_t outer = count > holes * of_hole + 3 ? count - holes * of_hole : 4;
  add_loop(region, wavy_loop(random, outer, {0.5, 0.5, 0}, 0.5, false));
  for (std::size_t i = 0; i < holes; ++i) {
    const double angle = kTurn * static_cast<double>(i) / static_cast<double>(holes);
    const double radius = 0.3 / static_cast<double>(std::max<std::size_t>(holes, 3));
    const Point middle{0.5 + 0.18 * std::cos(angle), 0.5 + 0.18 * std::sin(angle), 0};
    add_loop(region, wavy_loop(random, of_hole, middle, radius, true));
  }
  return region;
}

PlaneGrid grid_of(std::size_t lines) {
  PlaneGrid grid;
  for (std::size_t i = 0; i < lines; ++i) {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(lines);
    grid.us.push_back(at);
    grid.vs.push_back(at);
  }
  return grid;
}

double least_angle(const Point& a, const Point& b, const Point& c) {
  const auto angle = [](const Point& p, const Point& q, const Point& r) {
    const double x = (q.x - p.x) * (r.x - p.x) + (q.y - p.y) * (r.y - p.y);
    const double y = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    return std::abs(std::atan2(y, x)) * 360 / kTurn;
  };
  return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
}

double mean_least_angle(std::span<const Point> points, std::span<const Triangle> triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += least_angle(points[t[0]], points[t[1]], points[t[2]]);
  return sum / static_cast<double>(triangles.size());
}

// CGAL's triangulation, with the faces inside the loops marked.
class Peer {
 public:
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Faces = CGAL::Delaunay_mesh_face_base_2<Kernel>;
  using Structure =
      CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>, Faces>;
  using Triangulation =
      CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                                 CGAL::No_constraint_intersection_tag>;

  Peer(std::span<const Point> points, const Region& loops) {
    std::vector<Triangulation::Vertex_handle> handles;
    Triangulation::Face_handle hint;
    for (const Point& p : points) {
      handles.push_back(all_.insert(Kernel::Point_2(p.x, p.y), hint));
      hint = handles.back()->face();
    }
    for (const auto& [from, to] : loops.edges) all_.insert_constraint(handles[from], handles[to]);
    CGAL::mark_domain_in_triangulation(all_);
  }

  double mean_least_angle() const {
    double sum = 0;
    std::size_t count = 0;
    for (const auto face : all_.finite_face_handles()) {
      if (!face->is_in_domain()) continue;
      const auto corner = [&](int k) {
        return Point{face->vertex(k)->point().x(), face->vertex(k)->point().y(), 0};
      };
      sum += least_angle(corner(0), corner(1), corner(2));
      ++count;
    }
    return sum / static_cast<double>(count);
  }

 private:
  Triangulation all_;
};

// libtess2, loaded when the program runs. It has single precision, and no verdict on the loops.
class Tess {
 public:
  Tess() {
    void* library = dlopen("libtess2-tulip-5.4.so", RTLD_NOW);
    if (library == nullptr) return;
    const auto load = [&](auto& function, const char* name) {
      function =
          reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    };
    load(make_, "tessNewTess");
    load(add_, "tessAddContour");
    load(run_, "tessTesselate");
    load(count_, "tessGetElementCount");
    load(free_, "tessDeleteTess");
  }
  bool is_there() const { return make_ != nullptr; }

  int triangulate(const std::vector<std::vector<Point>>& loops) const {
    void* tess = make_(nullptr);
    std::vector<float> flat;
    for (const auto& loop : loops) {
      flat.clear();
      for (const Point& p : loop) {
        flat.push_back(static_cast<float>(p.x));
        flat.push_back(static_cast<float>(p.y));
      }
      add_(tess, 2, flat.data(), 2 * sizeof(float), static_cast<int>(loop.size()));
    }
    constexpr int kOddWinding = 0;
    constexpr int kPolygons = 0;
    run_(tess, kOddWinding, kPolygons, 3, 2, nullptr);
    const int made = count_(tess);
    free_(tess);
    return made;
  }

 private:
  void* (*make_)(void*) = nullptr;
  void (*add_)(void*, int, const void*, int, int) = nullptr;
  int (*run_)(void*, int, int, int, int, const float*) = nullptr;
  int (*count_)(void*) = nullptr;
  void (*free_)(void*) = nullptr;
};

// The loops of a region, whose edges follow each other.
std::vector<std::vector<Point>> loops_of(const Region& region) {
  std::vector<std::vector<Point>> loops;
  Index begin = kNone;
  for (const auto& [from, to] : region.edges) {
    if (begin == kNone) {
      begin = from;
      loops.emplace_back();
    }
    loops.back().push_back(region.points[from]);
    if (to == begin) begin = kNone;
  }
  return loops;
}

// Least seconds of five runs.
double least_seconds_of(const std::function<void()>& work) {
  double least = seconds_of(work);
  for (int i = 0; i < 4; ++i) least = std::min(least, seconds_of(work));
  return least;
}

void show_shapes() {
  std::printf(
      "grid  loop  triangles  mean least angle: ours  CGAL  sweep  edges at a vertex  indices a "
      "triangle  ns a triangle: made  strips\n");
  std::mt19937 random(1);
  for (const auto& [lines, count] : {std::pair<std::size_t, std::size_t>{4, 12},
                                     {10, 30},
                                     {20, 60},
                                     {32, 100},
                                     {50, 150},
                                     {100, 300}}) {
    double ours = 0;
    double peer = 0;
    double swept = 0;
    double edges = 0;
    double indices = 0;
    double making = 0;
    double stripping = 0;
    std::size_t triangles = 0;
    constexpr int kRounds = 20;
    for (int round = 0; round < kRounds; ++round) {
      const Region loops = random_region(random, count, 0);
      const tessellate::Clearance clearance{0.25, {}};
      const auto mesh = tessellate::triangulate_trimmed(loops, grid_of(lines), clearance);
      ours += mean_least_angle(mesh.points, mesh.triangles) / kRounds;
      peer += Peer(mesh.points, loops).mean_least_angle() / kRounds;
      // Without flips: the plain triangulation of monotone pieces, of the same points.
      const Region same{mesh.points, loops.edges};
      swept += mean_least_angle(same.points, tessellate::sweep_region(same).triangles) / kRounds;
      const double all = (3.0 * static_cast<double>(mesh.triangles.size()) +
                          static_cast<double>(loops.edges.size())) /
                         2;
      edges += (all - static_cast<double>(loops.edges.size())) /
               static_cast<double>(mesh.points.size()) / kRounds;
      std::size_t length = 0;
      for (const auto& strip : tessellate::strips_of(mesh.triangles, mesh.points.size())) {
        length += strip.size();
      }
      indices += static_cast<double>(length) / static_cast<double>(mesh.triangles.size()) / kRounds;
      triangles += mesh.triangles.size();
      making += least_seconds_of(
          [&] { tessellate::triangulate_trimmed(loops, grid_of(lines), clearance); });
      stripping +=
          least_seconds_of([&] { tessellate::strips_of(mesh.triangles, mesh.points.size()); });
    }
    const auto each = static_cast<double>(triangles) / 1e9;
    std::printf("%4zu  %4zu  %9zu  %22.1f  %4.1f  %5.1f  %17.2f  %18.2f  %20.0f  %6.0f\n", lines,
                count, triangles / kRounds, ours, peer, swept, edges, indices, making / each,
                stripping / each);
  }
}

std::vector<Region> regions_for_speed(std::size_t count, std::size_t holes) {
  std::mt19937 random(2);
  std::vector<Region> regions;
  for (std::size_t i = 0; i < std::max<std::size_t>(4, 200'000 / count); ++i) {
    regions.push_back(random_region(random, count, holes));
  }
  return regions;
}

void show_loops(std::size_t count, std::size_t holes) {
  for (const Region& region : regions_for_speed(count, holes)) {
    for (const auto& loop : loops_of(region)) {
      for (const Point& p : loop) std::printf("%.17g %.17g ", p.x, p.y);
      std::printf("\n");
    }
    std::printf("\n");
  }
}

// Seconds that facets of one ring of few vertices take; infinite for other regions.
double seconds_of_few(const std::vector<std::vector<std::vector<Point>>>& regions) {
  std::vector<std::vector<tessellate::FewVertices::PlanePoint>> rings;
  for (const auto& loops : regions) {
    if (loops.size() > 1 || loops[0].size() > tessellate::FewVertices::kMost) {
      return std::numeric_limits<double>::infinity();
    }
    rings.emplace_back();
    for (const Point& p : loops[0]) rings.back().push_back({p.x, p.y});
  }
  tessellate::FewVertices few;
  return least_seconds_of([&] {
    for (const auto& ring : rings) few.triangulate(ring);
  });
}

void show_speed() {
  std::printf(
      "vertices  holes  million triangles a second, Delaunay: sweep and flips  few vertices  CGAL  "
      "times  any: sweep  libtess2  times\n");
  const Tess tess;
  for (const auto& [count, holes] :
       {std::pair<std::size_t, std::size_t>{8, 0}, {20, 0}, {100, 3}, {1'000, 8}, {10'000, 20}}) {
    const std::vector<Region> regions = regions_for_speed(count, holes);
    std::vector<std::vector<std::vector<Point>>> loops;
    std::transform(regions.begin(), regions.end(), std::back_inserter(loops), loops_of);
    std::size_t triangles = 0;
    const double any = least_seconds_of([&] {
      triangles = 0;
      for (const Region& region : regions) {
        triangles += tessellate::sweep_region(region).triangles.size();
      }
    });
    const double ours = least_seconds_of([&] {
      for (const Region& region : regions) {
        auto made = tessellate::sweep_region(region);
        tessellate::flip_to_delaunay(region.points, made.triangles);
      }
    });
    const double few = seconds_of_few(loops);
    const double cgal = least_seconds_of([&] {
      for (const Region& region : regions) Peer(region.points, region);
    });
    int tessellated = 0;
    const double libtess2 = !tess.is_there() ? 0 : least_seconds_of([&] {
      tessellated = 0;
      for (const auto& region : loops) tessellated += tess.triangulate(region);
    });
    const double size = static_cast<double>(triangles) / 1e6;
    std::printf("%8zu  %5zu  %53.2f  %12.2f  %4.2f  %5.1f  %10.2f  %8.2f  %5.1f\n", count, holes,
                size / ours, size / few, size / cgal, cgal / std::min(ours, few), size / any,
                tessellated / 1e6 / libtess2, libtess2 / any);
  }
}

void show_updates() {
  std::printf(
      "triangles  fresh run, us  sample in, us  out, us  line in, us  out, us  samples' share  "
      "lines' share\n");
  std::mt19937 random(3);
  for (const auto& [lines, count] :
       {std::pair<std::size_t, std::size_t>{8, 30}, {10, 40}, {20, 80}, {40, 100}, {100, 300}}) {
    const Region loops = random_region(random, count, 0);
    const PlaneGrid grid = grid_of(lines);
    tessellate::TrimmedMesh mesh(loops, grid);
    constexpr int kRounds = 200;
    const double fresh = seconds_of([&] {
                           for (int i = 0; i < kRounds; ++i)
                             tessellate::triangulate_trimmed(loops, grid);
                         }) /
                         kRounds;
    std::array<double, 4> spent{};
    for (int i = 0; i < kRounds; ++i) {
      const auto at = static_cast<Index>(random() % count);
      const Index after = mesh.next(at);
      const Point& a = mesh.points()[at];
      const Point& b = mesh.points()[after];
      const Point middle{(a.x + b.x) / 2 + (b.y - a.y) / 8, (a.y + b.y) / 2 - (b.x - a.x) / 8, 0};
      spent[0] += seconds_of([&] { mesh.insert_sample(at, middle); });
      const Index made = mesh.next(at);
      if (made != after) spent[1] += seconds_of([&] { mesh.remove_sample(made); });
      const double line = static_cast<double>(random() % 1'000'000) / 1'000'000;
      const std::size_t axis = random() % 2;
      bool is_new = false;
      spent[2] += seconds_of([&] { is_new = mesh.add_grid_line(axis, line); });
      if (is_new) spent[3] += seconds_of([&] { mesh.remove_grid_line(axis, line); });
    }
    for (double& time : spent) time /= kRounds;
    std::printf("%9zu  %13.0f  %13.1f  %7.1f  %11.1f  %7.1f  %13.0f%%  %11.0f%%\n",
                mesh.triangles().size(), 1e6 * fresh, 1e6 * spent[0], 1e6 * spent[1],
                1e6 * spent[2], 1e6 * spent[3], 50 * (spent[0] + spent[1]) / fresh,
                50 * (spent[2] + spent[3]) / fresh);
  }
}

bool edges_meet(const Region& region, const PlaneEdge& one, const PlaneEdge& other) {
  const auto& p = region.points;
  const auto [a, b] = one;
  const auto [c, d] = other;
  const auto on = [&](Index x, Index y, Index z) {
    return geometry::is_on_segment(p[x], p[y], p[z]);
  };
  if (b == c) return on(a, b, d) || on(c, d, a);
  if (d == a) return on(c, d, b) || on(a, b, c);
  const auto side = [&](Index x, Index y, Index z) {
    return geometry::orient2d(p[x], p[y], p[z], 2);
  };
  if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
  return on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b);
}

bool is_simple(const Region& region) {
  const auto& p = region.points;
  for (std::size_t i = 0; i < region.edges.size(); ++i) {
    const auto [a, b] = region.edges[i];
    const auto [left, right] = std::minmax(p[a].x, p[b].x);
    for (std::size_t k = i + 1; k < region.edges.size(); ++k) {
      const auto [c, d] = region.edges[k];
      if (std::max(p[c].x, p[d].x) < left || std::min(p[c].x, p[d].x) > right) continue;
      if (edges_meet(region, region.edges[i], region.edges[k])) return false;
    }
  }
  return true;
}

// Whether a point is inside the loops but for those edges from `first` to `last`.
bool is_inside_others(const Region& region, const Point& p, std::size_t first, std::size_t last) {
  bool is_inside = false;
  for (std::size_t i = 0; i < region.edges.size(); ++i) {
    if (i >= first && i < last) continue;
    const Point* low = &region.points[region.edges[i][0]];
    const Point* high = &region.points[region.edges[i][1]];
    if (low->y > high->y) std::swap(low, high);
    if (low->y > p.y || high->y <= p.y) continue;
    if (geometry::orient2d(*low, *high, p, 2) > 0) is_inside = !is_inside;
  }
  return is_inside;
}

// Whether simple loops have the region on their left: those inside an even number of others turn
// left. The edges of a loop follow each other.
bool is_on_left(const Region& region) {
  for (std::size_t first = 0; first < region.edges.size();) {
    std::size_t last = first + 1;
    while (region.edges[last - 1][1] != region.edges[first][0]) ++last;
    double area = 0;
    const Point& origin = region.points[region.edges[first][0]];
    for (std::size_t i = first; i < last; ++i) {
      const Point& a = region.points[region.edges[i][0]];
      const Point& b = region.points[region.edges[i][1]];
      area += (a.x - origin.x) * (b.y - origin.y) - (b.x - origin.x) * (a.y - origin.y);
    }
    if ((area > 0) == is_inside_others(region, origin, first, last)) return false;
    first = last;
  }
  return true;
}

int check(std::size_t rounds) {
  std::size_t refused = 0;
  std::size_t wrong = 0;
  std::size_t triangles = 0;
  for (std::size_t round = 0; round < rounds; ++round) {
    std::mt19937 random(static_cast<unsigned>(round));
    Region region = random_region(random, 5 + random() % 96, random() % 3);
    // Points on grid lines and on grid points are as frequent as those beside them.
    if (random() % 2 == 0) {
      for (Point& p : region.points)
        p = {std::round(256 * p.x) / 256, std::round(256 * p.y) / 256, 0};
    }
    if (random() % 50 == 0) {
      std::swap(region.points[random() % region.points.size()],
                region.points[random() % region.points.size()]);
    }
    const auto mesh = tessellate::triangulate_trimmed(region, grid_of(4 + random() % 29));
    triangles += mesh.triangles.size();
    refused += mesh.conflict ? 1U : 0U;
    if (mesh.conflict.has_value() == (is_simple(region) && is_on_left(region))) {
      ++wrong;
      std::printf("region %zu: %s, but the exact tests say otherwise\n", round,
                  mesh.conflict ? "refused" : "triangulated");
    }
  }
  std::printf("%zu regions, %zu triangles, %zu refused, %zu wrong verdicts\n", rounds, triangles,
              refused, wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view mode = argc > 1 ? argv[1] : "";
  if (mode == "shape") {
    show_shapes();
  } else if (mode == "speed") {
    show_speed();
  } else if (mode == "loops" && argc > 3) {
    show_loops(std::strtoull(argv[2], nullptr, 10), std::strtoull(argv[3], nullptr, 10));
  } else if (mode == "update") {
    show_updates();
  } else if (mode == "check" && argc > 2) {
    return check(std::strtoull(argv[2], nullptr, 10));
  } else {
    std::printf("usage: regions shape | speed | loops N H | update | check N\n");
    return 2;
  }
  return 0;
}
