// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Verbree & Si 2008, section 3.1; the order of rungs from this project's measurements on
// 2,795 clean solids.
//
// Engines get vertices sorted by coordinates and facets in the order of their triangles, so that
// an answer does not depend on the numbering of the input.
#include "delaunay/ladder.h"

#include <time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "delaunay/cdt_frames.h"
#include "delaunay/cdt_statistics.h"
#include "delaunay/constrained/merge_facets.h"
#include "delaunay/own_rungs.h"
#include "tessellate/flatness.h"
#include "workers/worker_pool.h"

namespace watertight::delaunay {
namespace {

using Clock = std::chrono::steady_clock;

/// A solid whose extents on two axes differ by more than this factor goes to the scaled rungs at
/// once: engines work with distances, and boxes in degrees and metres look flat to them.
constexpr double kAnisotropy = 1024;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// CPU time of this thread, in seconds.
double thread_seconds() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

RungOutcome outcome_of(workers::JobOutcome outcome) {
  switch (outcome) {
    case workers::JobOutcome::failed:
      return RungOutcome::engine_error;
    case workers::JobOutcome::crashed:
      return RungOutcome::crashed;
    case workers::JobOutcome::timed_out:
      return RungOutcome::timed_out;
    case workers::JobOutcome::out_of_memory:
      return RungOutcome::memory_limit;
    case workers::JobOutcome::cancelled:
      return RungOutcome::cancelled;
    case workers::JobOutcome::not_started:
      return RungOutcome::not_started;
    case workers::JobOutcome::garbage:
    case workers::JobOutcome::ok:
      break;
  }
  return RungOutcome::garbage;
}

/// The complex in the engines' order, and the vertices and facets of the solid that it stands for.
struct EngineInput {
  PiecewiseLinearComplex complex;
  std::vector<Index> vertex_at;  // engine's vertex -> vertex of the solid
  std::vector<Index> facet_at;   // engine's facet -> facet of the solid
};

std::vector<Index> sorted_vertices(std::span<const Point> vertices) {
  std::vector<Index> order(vertices.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return vertices[a] < vertices[b]; });
  return order;
}

/// Makes the input of the engines. A facet for which `is_taken_apart` is true is given triangle by
/// triangle, all others as patches.
EngineInput engine_input(const Solid& solid, const tessellate::FacetTriangles& canonical,
                         const std::vector<bool>& is_taken_apart) {
  EngineInput input;
  input.vertex_at = sorted_vertices(solid.vertices());
  std::vector<Index> rank(input.vertex_at.size());
  for (Index i = 0; i < rank.size(); ++i) {
    rank[input.vertex_at[i]] = i;
    input.complex.vertices.push_back(solid.vertices()[input.vertex_at[i]]);
  }
  std::vector<std::pair<std::vector<Triangle>, Index>> facets(solid.facet_count());
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    facets[facet].second = facet;
    for (Index t = canonical.first[facet]; t < canonical.first[facet + 1]; ++t) {
      const auto& [a, b, c] = canonical.triangles[t];
      Triangle triangle{rank[a], rank[b], rank[c]};
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                  triangle.end());
      facets[facet].first.push_back(triangle);
    }
    std::sort(facets[facet].first.begin(), facets[facet].first.end());
  }
  std::sort(facets.begin(), facets.end());
  for (const auto& [triangles, facet] : facets) {
    const bool is_apart = !is_taken_apart.empty() && is_taken_apart[facet];
    for (const Triangle& triangle : triangles) {
      if (is_apart || &triangle == &triangles.front()) input.facet_at.push_back(facet);
      input.complex.triangles.push_back(triangle);
      input.complex.facet_of.push_back(static_cast<Index>(input.facet_at.size() - 1));
    }
  }
  return input;
}

/// Powers of two that bring the extent of each axis into [0.5, 1); 1 where scaling is not exact.
std::array<double, 3> unit_scale(std::span<const Point> vertices) {
  const Box box = geometry::box_of(vertices);
  std::array<double, 3> scale{1, 1, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = box.max[axis] - box.min[axis];
    if (!(extent > 0) || !std::isfinite(extent)) continue;
    const double factor = std::ldexp(1.0, -std::ilogb(extent) - 1);
    const bool is_exact = std::isfinite(factor) && factor > 0 &&
                          std::all_of(vertices.begin(), vertices.end(), [&](const Point& p) {
                            return (p[axis] * factor) / factor == p[axis];
                          });
    if (is_exact) scale[static_cast<std::size_t>(axis)] = factor;
  }
  return scale;
}

Point scaled(const Point& p, const std::array<double, 3>& scale) {
  return {p.x * scale[0], p.y * scale[1], p.z * scale[2]};
}

Point unscaled(const Point& p, const std::array<double, 3>& scale) {
  return {p.x / scale[0], p.y / scale[1], p.z / scale[2]};
}

/// Returns the answer of an engine in the solid's coordinates and numbering.
Tetrahedralization restore(Tetrahedralization answer, const EngineInput& input,
                           const std::array<double, 3>& scale, const Solid& solid) {
  std::vector<Index> number(answer.points.size());
  std::iota(number.begin(), number.end(), Index{0});
  std::copy(input.vertex_at.begin(), input.vertex_at.end(), number.begin());
  for (Index i = 0; i < answer.points.size(); ++i) {
    answer.points[i] =
        i < answer.input_count ? solid.vertices()[i] : unscaled(answer.points[i], scale);
  }
  for (geometry::Tetrahedron& t : answer.tetrahedra) {
    for (Index& vertex : t) vertex = number[vertex];
  }
  for (ConstrainedFace& face : answer.constrained) {
    for (Index& vertex : face.vertices) vertex = number[vertex];
    std::sort(face.vertices.begin(), face.vertices.end());
    face.facet = input.facet_at[face.facet];
  }
  std::sort(answer.constrained.begin(), answer.constrained.end());
  return answer;
}

/// The order in which rungs are tried: those of the engine that is asked for come first. No engine
/// decides: where it has no answer, the others are asked, so that a verdict does not depend on the
/// choice.
std::array<Rung, kRungs> order_of_rungs(Engine engine) {
  using enum Rung;
  if (engine == Engine::cgal) {
    return {patch, patch_scaled, triangles_scaled, delaunay, recovered, tetgen};
  }
  if (engine == Engine::tetgen) {
    return {tetgen, delaunay, recovered, patch, patch_scaled, triangles_scaled};
  }
  return {delaunay, recovered, patch, patch_scaled, triangles_scaled, tetgen};
}

class Climb {
 public:
  Climb(const Solid& solid, const tessellate::FacetTriangles& canonical, EngineWorkers* workers,
        const LadderOptions& options)
      : solid_(solid), canonical_(canonical), workers_(workers), options_(options) {}

  LadderResult run() {
    if (options_.contacts != nullptr) {
      contacts_ = *options_.contacts;
    } else {
      Result<ContactTriangles> contacts = divide_at_contacts(solid_, canonical_, options_.cancel);
      if (!contacts) {
        result_.obstacle = "contacts of shells: " + to_string(contacts.error());
        return std::move(result_);
      }
      contacts_ = *std::move(contacts);
    }
    result_.obstacle = contacts_.obstacle;
    if (solid_.shell_count() > 1 || options_.strict) keep_canonical();
    first_of_constraints_ = 0;
    for (const Rung rung : order_of_rungs(options_.engine)) {
      if (rung < options_.first_rung || rung > options_.last_rung || !applies(rung)) continue;
      if (options_.cancel && options_.cancel()) break;
      attempt_ = RungAttempt{};
      attempt_.rung = rung;
      const Clock::time_point start = Clock::now();
      const double cpu_start = thread_seconds();
      const bool is_own = rung == Rung::delaunay || rung == Rung::recovered;
      is_own ? try_own(rung) : try_engine(rung);
      attempt_.seconds = seconds_since(start);
      attempt_.cpu_seconds = thread_seconds() - cpu_start;
      result_.attempts.push_back(std::move(attempt_));
      if (result_.certificate) result_.property = CertificateRefusal::none;
      if (result_.certificate) break;
      if (result_.property != CertificateRefusal::none && !options_.is_interior_known) break;
      if (result_.attempts.back().result == RungOutcome::cancelled) break;
    }
    return std::move(result_);
  }

 private:
  /// The triangles of which the constraints are made.
  const tessellate::FacetTriangles& triangles() const {
    return contacts_.has_contacts() ? contacts_.triangles : canonical_;
  }

  /// Makes facets that are not flat follow their canonical triangles from now on. For a solid of
  /// one shell that is not needed: the exact tests prove that it has one interior (Jordan-Brouwer),
  /// so that an accepted certificate may fill such facets otherwise, which engines find more
  /// easily.
  void keep_canonical() {
    is_kept_.resize(solid_.facet_count());
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      const bool is_one_triangle = canonical_.first[facet + 1] - canonical_.first[facet] == 1;
      is_kept_[facet] = !is_one_triangle && !tessellate::is_flat(solid_, facet);
    }
    input_ = EngineInput{};
    // The attempt under way still had the former constraints.
    first_of_constraints_ = static_cast<std::ptrdiff_t>(result_.attempts.size()) + 1;
  }

  /// The facets that engines get triangle by triangle: facets that hold vertices or edges of other
  /// shells, as engines do not expect constraints inside a patch, and facets that must follow their
  /// canonical triangles.
  std::vector<bool> taken_apart() const {
    if (is_kept_.empty()) return contacts_.is_touched;
    std::vector<bool> result = is_kept_;
    for (std::size_t i = 0; i < contacts_.is_touched.size(); ++i) {
      result[i] = result[i] || contacts_.is_touched[i];
    }
    return result;
  }

  bool applies(Rung rung) {
    switch (rung) {
      case Rung::patch:
        return !options_.strict && !is_anisotropic();
      case Rung::patch_scaled:
        return !options_.strict && is_new(rung);
      case Rung::triangles_scaled:
        return is_new(rung);
      case Rung::delaunay:
      case Rung::recovered:
      case Rung::tetgen:
        return true;
      case Rung::none:
        break;
    }
    return false;
  }

  static Constraints constraints_of(Rung rung) {
    return rung == Rung::patch || rung == Rung::patch_scaled ? Constraints::patches
                                                             : Constraints::triangles;
  }

  /// Scaling changes the angles that decide where Steiner points go: rungs scale only where needed.
  std::array<double, 3> scale_of(Rung rung) const {
    const bool keeps_coordinates =
        rung == Rung::patch || (rung == Rung::tetgen && !is_anisotropic());
    if (keeps_coordinates) return {1, 1, 1};
    return unit_scale(solid_.vertices());
  }

  /// False if CGAL had the same task on an earlier rung: the same constraints (or every facet is
  /// one triangle), and the same points up to one power of two for all axes.
  bool is_new(Rung rung) const {
    const auto same = [&](const RungAttempt& attempt) {
      const bool is_of_cgal = attempt.rung != Rung::delaunay && attempt.rung != Rung::tetgen;
      if (!is_of_cgal) return false;
      const bool has_same_constraints = constraints_of(attempt.rung) == constraints_of(rung) ||
                                        canonical_.triangles.size() == solid_.facet_count();
      const std::array<double, 3> a = scale_of(attempt.rung);
      const std::array<double, 3> b = scale_of(rung);
      return has_same_constraints && a[1] / a[0] == b[1] / b[0] && a[2] / a[0] == b[2] / b[0];
    };
    // Attempts before keep_canonical() had other constraints.
    return std::none_of(result_.attempts.begin() + first_of_constraints_, result_.attempts.end(),
                        same);
  }

  bool is_anisotropic() const {
    const Box box = solid_.box();
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) {
      least = std::min(least, box.max[axis] - box.min[axis]);
      most = std::max(most, box.max[axis] - box.min[axis]);
    }
    return most > kAnisotropy * least;
  }

  void conclude(RungOutcome outcome, std::string text) {
    attempt_.result = outcome;
    attempt_.outcome = std::move(text);
  }

  /// Proves the solid by one of the same surface that has fewer facets, and so fewer edges that a
  /// tetrahedralization must have. False if that proves nothing.
  bool try_merged() {
    std::optional<MergedFacets> merged = merge_flat_facets(solid_, canonical_);
    if (!merged) return false;
    const tessellate::FacetTriangles facets = tessellate::triangulate_facets(merged->solid);
    LadderOptions options;
    options.last_rung = Rung::recovered;
    options.cancel = options_.cancel;
    options.keeps_facets = true;
    LadderResult proven =
        Climb(facets.divided_solid(merged->solid), facets, nullptr, options).run();
    if (!proven.certificate) return false;
    Certificate certificate = *std::move(proven.certificate);
    certificate.rung = Rung::recovered;
    certificate.has_merged_facets = true;
    for (Index& facet : certificate.refilled_facets) facet = merged->source[facet];
    result_.certificate = std::move(certificate);
    attempt_.refusal = CertificateRefusal::none;
    conclude(RungOutcome::accepted, "accepted");
    return true;
  }

  void try_own(Rung rung) {
    const bool may_merge = rung == Rung::recovered && !options_.keeps_facets && !options_.strict;
    // With more facets than vertices most facets are triangles, and many of these in one plane.
    const bool is_merged_first = may_merge && solid_.facet_count() > solid_.vertex_count();
    if (is_merged_first && try_merged()) return;
    try_facets(rung);
    if (may_merge && !is_merged_first && !result_.certificate) try_merged();
  }

  void try_facets(Rung rung) {
    if (!own_) own_.emplace(solid_, triangles(), contacts_.has_contacts(), options_.cancel);
    RungResult result =
        rung == Rung::delaunay ? own_->delaunay(is_kept_) : own_->recovered(taken_apart());
    if (!result.made) return conclude(result.outcome, std::move(result.text));
    judge(*std::move(result.made), rung);
  }

  void try_engine(Rung rung) {
    workers::WorkerPool* pool = nullptr;
    if (workers_ != nullptr) pool = rung == Rung::tetgen ? workers_->tetgen() : workers_->cgal();
    if (pool == nullptr) {
      return conclude(RungOutcome::not_started, "not-started: no engine executable");
    }
    const workers::WorkerLimits limits = this->limits(rung);
    if (!(limits.cpu_seconds > 0)) {
      return conclude(RungOutcome::not_started, "not-started: the rungs before took all the time");
    }
    if (input_.facet_at.empty()) input_ = engine_input(solid_, triangles(), taken_apart());
    const std::array<double, 3> scale = scale_of(rung);
    CdtJob job;
    job.constraints = constraints_of(rung);
    job.complex = input_.complex;
    for (Point& p : job.complex.vertices) p = scaled(p, scale);
    const workers::JobResult reply = pool->run(write_job(job), limits, options_.cancel);
    attempt_.worker_seconds = reply.cpu_seconds;
    engines_seconds_ += reply.cpu_seconds;
    if (reply.outcome != workers::JobOutcome::ok) {
      return conclude(outcome_of(reply.outcome),
                      std::string(workers::to_string(reply.outcome)) + ": " + reply.detail);
    }
    Result<CdtAnswer> answer =
        read_answer(reply.reply, job.complex.vertices, static_cast<Index>(input_.facet_at.size()));
    if (!answer) {
      return conclude(RungOutcome::garbage, "garbage: " + to_string(answer.error()));
    }
    attempt_.engine_seconds = answer->engine_seconds;
    if (!answer->tetrahedralization) {
      return conclude(RungOutcome::engine_error, "refused: " + answer->refusal);
    }
    judge(restore(std::move(*answer->tetrahedralization), input_, scale, solid_), rung);
  }

  /// An engine takes about 0.1 ms a triangle on ordinary solids and up to 10 ms on hard ones. CPU
  /// time decides, so that a busy machine does not change a verdict; the wall clock only ends a
  /// worker that sleeps.
  workers::WorkerLimits limits(Rung rung) const {
    const double triangles = static_cast<double>(canonical_.triangles.size());
    double seconds = rung == Rung::patch ? 2 : 6;
    seconds += triangles * (rung == Rung::tetgen ? 1e-3 : 0.5e-3);
    if (options_.seconds_per_rung > 0) seconds = options_.seconds_per_rung;
    const double in_all = options_.seconds_in_all > 0
                              ? options_.seconds_in_all
                              : default_ladder_seconds(canonical_.triangles.size());
    seconds = std::min(seconds, in_all - engines_seconds_);
    workers::WorkerLimits limits;
    limits.cpu_seconds = seconds;
    limits.wall_seconds = options_.seconds_per_rung > 0 ? seconds : 20 * seconds + 10;
    limits.memory_bytes = (std::uint64_t{512} << 20) + canonical_.triangles.size() * (16U << 10);
    if (options_.memory_in_engine > 0) {
      limits.memory_bytes = std::min(limits.memory_bytes, options_.memory_in_engine);
    }
    return limits;
  }

  void judge(Tetrahedralization tetrahedralization, Rung rung) {
    CertificateResult checked =
        check_certificate(solid_, canonical_, std::move(tetrahedralization), rung, options_.cancel);
    attempt_.refusal = checked.refusal;
    if (checked.refusal == CertificateRefusal::cancelled) {
      return conclude(RungOutcome::cancelled, "cancelled: cancelled by the caller");
    }
    const bool is_canonical = checked.refilled_facets.empty();
    if (checked.refusal == CertificateRefusal::none && !is_canonical && !is_kept_.empty()) {
      attempt_.refusal = CertificateRefusal::facet_not_conforming;
      return conclude(RungOutcome::refused_by_certificate,
                      "refused: a facet that is not planar is filled otherwise than its canonical "
                      "triangles");
    }
    if (checked.refusal != CertificateRefusal::none) {
      if (!is_canonical) {
        keep_canonical();
        if (is_property_of_solid(checked.refusal)) {
          attempt_.refusal = CertificateRefusal::facet_not_conforming;
        }
      } else if (is_property_of_solid(checked.refusal)) {
        result_.property = checked.refusal;
        result_.detail = checked.detail;
        result_.facet = checked.facet;
      }
      return conclude(
          RungOutcome::refused_by_certificate,
          "refused: " + std::string(to_string(checked.refusal)) + ": " + checked.detail);
    }
    result_.certificate = std::move(checked.certificate);
    conclude(RungOutcome::accepted, "accepted");
  }

  const Solid& solid_;
  const tessellate::FacetTriangles& canonical_;
  EngineWorkers* workers_;
  const LadderOptions& options_;
  ContactTriangles contacts_;
  std::vector<bool> is_kept_;  // facet -> its canonical triangles must be kept; empty if none
  std::ptrdiff_t first_of_constraints_ = 0;  // the first attempt with the present constraints
  std::optional<OwnRungs> own_;
  EngineInput input_;
  RungAttempt attempt_;
  double engines_seconds_ = 0;  // CPU time of workers so far
  LadderResult result_;
};

std::unique_ptr<workers::WorkerPool> make_pool(const std::string& executable,
                                               const std::string& name,
                                               const EngineWorkers::Options& engines,
                                               std::size_t jobs_per_process) {
  workers::WorkerPool::Options options;
  options.executable = executable;
  if (executable.empty()) {
    const Result<std::string> found = workers::find_helper(name);
    if (!found) return nullptr;
    options.executable = *found;
  }
  options.size = engines.processes;
  options.jobs_per_process = jobs_per_process;
  return std::make_unique<workers::WorkerPool>(std::move(options));
}

}  // namespace

double default_ladder_seconds(std::size_t triangles) {
  return 20 + static_cast<double>(triangles) * 2.5e-3;
}

EngineWorkers::EngineWorkers(const Options& options)
    : cgal_(make_pool(options.cgal_executable, "watertight-worker", options, 500)),
      // TetGen keeps tables in globals and frees twice on errors: a process runs one job.
      tetgen_(make_pool(options.tetgen_executable, "watertight-tetgen", options, 1)) {}

EngineWorkers::EngineWorkers() : EngineWorkers(Options{}) {}

EngineWorkers::~EngineWorkers() = default;
EngineWorkers::EngineWorkers(EngineWorkers&&) noexcept = default;
EngineWorkers& EngineWorkers::operator=(EngineWorkers&&) noexcept = default;

workers::WorkerPool* EngineWorkers::cgal() { return cgal_.get(); }

workers::WorkerPool* EngineWorkers::tetgen() { return tetgen_.get(); }

void EngineWorkers::reap() {
  for (workers::WorkerPool* pool : {cgal(), tetgen()}) {
    if (pool != nullptr) pool->reap();
  }
}

LadderResult climb_ladder(const Solid& solid, const tessellate::FacetTriangles& facets,
                          EngineWorkers* workers, const LadderOptions& options) {
  return Climb(solid, facets, workers, options).run();
}

}  // namespace watertight::delaunay
