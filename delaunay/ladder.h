// SPDX-License-Identifier: GPL-3.0-or-later
//
// The CDT ladder (docs/robustness.md, "Engines prove nothing"): rungs 0 and 1 in this process, the
// engines in worker processes, each rung's result accepted only by the certificate.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "delaunay/certificate.h"
#include "delaunay/rung.h"
#include "delaunay/shell_contacts.h"

namespace watertight::workers {
class WorkerPool;
}  // namespace watertight::workers

namespace watertight::delaunay {

/// The engine that is asked first; automatic: none before the canonical DT.
enum class Engine : std::uint8_t { automatic, cgal, tetgen };

/// The processes that a ladder may use. One object for each process of ours; thread-safe.
class EngineWorkers {
 public:
  struct Options {
    std::string cgal_executable;    // "" = find_helper("watertight-worker")
    std::string tetgen_executable;  // "" = find_helper("watertight-tetgen")
    std::size_t processes = 2;
  };
  explicit EngineWorkers(const Options& options);
  EngineWorkers();
  ~EngineWorkers();
  EngineWorkers(EngineWorkers&&) noexcept;
  EngineWorkers& operator=(EngineWorkers&&) noexcept;
  workers::WorkerPool* cgal();    // null when the executable does not exist
  workers::WorkerPool* tetgen();  // null when the executable does not exist
  /// Reaps processes that ended from idleness.
  void reap();

 private:
  std::unique_ptr<workers::WorkerPool> cgal_;
  std::unique_ptr<workers::WorkerPool> tetgen_;
};

struct LadderOptions {
  Engine engine = Engine::automatic;
  bool strict = false;  // true: constraints are triangles only; the CDT must hold the canonical
                        // triangles
  Rung first_rung = Rung::delaunay;  // the paper's table and tests leave out the rungs before it
  Rung last_rung = Rung::tetgen;
  double seconds_per_rung = 0;  // CPU time of an engine on one rung; 0: by size (2 s and more)
  /// CPU time of all engines on one solid together; 0: by size (20 s and more, see
  /// default_ladder_seconds()). A rung gets the time that those before it left.
  double seconds_in_all = 0;
  /// The most bytes of address space of an engine; 0: by size only (0.5 GiB and 16 KiB a triangle).
  std::uint64_t memory_in_engine = 0;
  CancelPoll cancel = {};
  /// True: each facet is a union of faces. False: neighbouring facets in one plane need only be so
  /// together, which is the same surface (Certificate::has_merged_facets).
  bool keeps_facets = false;
  /// The result of divide_at_contacts() for the solid, or null: the ladder calls it.
  const ContactTriangles* contacts = nullptr;
  /// True if the exact tests have shown one interior: a refusal that calls the solid wrong does not
  /// end the climb, and counts as a property only if no rung is accepted.
  bool is_interior_known = false;
};

/// CPU seconds of engines that a solid with this many boundary triangles may cost by default:
/// 20 s and 2.5 ms a triangle. That is the sum of the rungs' own limits, in which TetGen's share
/// cannot be used up by CGAL's; the time in this process (the Delaunay tetrahedralization and the
/// certificates) is near linear and not counted. Wall-clock time is at most twenty times that and
/// 10 s a rung, and a worker that uses no CPU time is ended after WorkerLimits::sleep_seconds.
double default_ladder_seconds(std::size_t triangles);

struct LadderResult {
  std::optional<Certificate> certificate;  // the accepted certificate
  /// A refusal that is a property of the solid (interior_disconnected, cavity_mismatch,
  /// wrong_orientation): the solid is invalid, whatever the engine.
  CertificateRefusal property = CertificateRefusal::none;
  std::string detail;
  Index facet = kNone;
  /// The reason why engines hardly find an answer (edges of shells that cross in no vertex), or
  /// empty.
  std::string obstacle;
  std::vector<RungAttempt> attempts;
};

/// Requires a solid that passed the exact tests, with rings that are divided as the triangles are
/// (FacetTriangles::divided_solid). If neither `certificate` nor `property` is set, the solid is
/// undecided. `workers` may be null: rungs 0 and 1 only.
LadderResult climb_ladder(const Solid& solid, const tessellate::FacetTriangles& facets,
                          EngineWorkers* workers, const LadderOptions& options);

}  // namespace watertight::delaunay
