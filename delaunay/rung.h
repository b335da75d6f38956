// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rungs of the CDT ladder and the outcomes of attempts: plain data for reports and statistics,
// without the ladder (delaunay/ladder.h) and its processes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace watertight::delaunay {

/// The rungs of the ladder.
enum class Rung : std::uint8_t {
  none = 255,
  delaunay = 0,      // the canonical DT itself
  recovered = 1,     // the canonical DT, changed where triangles of the boundary are missing
  patch = 2,         // CGAL, facets as patches
  patch_scaled = 3,  // as patch, after scaling by a power of two on each axis
  triangles_scaled = 4,
  tetgen = 5
};
std::string_view to_string(Rung rung);

/// The first item of the certificate that a tetrahedralization fails.
enum class CertificateRefusal : std::uint8_t {
  none,
  not_a_complex,          // tetrahedra do not pair into a manifold, or one is not positive
  not_convex,             // the outer surface is not the convex hull
  vertex_missing,         // an input vertex is absent, moved or doubled
  not_a_boundary,         // a constrained face has one region on both sides, or parity conflicts
  interior_disconnected,  // more than one interior region (a property of the solid)
  cavity_mismatch,        // cavities and declared inner shells differ (a property of the solid)
  facet_not_conforming,   // a facet's faces do not form a disc with its rings as boundary
  not_a_manifold,         // faces of one shell meet at more edges or vertices than neighbours do
  foreign_face,           // a constrained face that belongs to no facet
  wrong_orientation,      // a declared normal points inward (a property of the solid)
  volume_mismatch,
  cancelled  // the caller stopped the check: nothing is known
};
std::string_view to_string(CertificateRefusal refusal);

/// The outcome of one rung's attempt: the classes that statistics count.
enum class RungOutcome : std::uint8_t {
  accepted,                // the certificate accepts the result: the solid is decided
  refused_by_certificate,  // RungAttempt::refusal names the reason
  not_delaunay,            // rungs 0 and 1: facets are not unions of faces
  engine_error,            // the engine said that it has no answer
  crashed,                 // the worker process ended by itself
  timed_out,
  memory_limit,
  garbage,  // bytes that are no answer
  cancelled,
  not_started  // no engine executable, no process, or no time left
};
inline constexpr std::size_t kRungOutcomes = 10;
std::string_view to_string(RungOutcome outcome);

/// One rung's attempt, for the report and for statistics.
struct RungAttempt {
  Rung rung = Rung::none;
  std::string outcome;  // for people: "accepted", "refused: ...", "crashed: ...", "timed-out", ...
  double seconds = 0;   // wall-clock time
  RungOutcome result = RungOutcome::not_started;
  CertificateRefusal refusal = CertificateRefusal::none;  // if refused_by_certificate
  /// CPU times: of the calling thread, of the worker process, and of the engine's own call within
  /// that process (0 if the engine did not answer).
  double cpu_seconds = 0;
  double worker_seconds = 0;
  double engine_seconds = 0;
};

}  // namespace watertight::delaunay
