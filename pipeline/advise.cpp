// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/advise.h"

#include <algorithm>
#include <utility>

#include "geometry/parallel.h"

namespace watertight::pipeline {
namespace {

using Integers = std::vector<std::array<std::int64_t, 3>>;

/// The most decimals that are tried: finer grids do not fit into 64 bits for places on Earth.
constexpr int kMostDecimals = 12;

/// A valid solid as integers of 10^-decimals.
struct GridSolid {
  const SubmittedSolid* submitted = nullptr;
  Integers vertices;
  std::size_t blob_bytes = 0;  // as it is
};

geometry::Transform grid_of(int decimals) {
  geometry::Transform transform;
  transform.scale.fill(geometry::GridNumber{1, -decimals});
  return transform;
}

/// The fewest decimals that the coordinates need; nothing if they are on no decimal grid.
std::optional<int> decimals_of(const geometry::Lattice& lattice) {
  if (lattice.kind != geometry::LatticeKind::decimal) return std::nullopt;
  int decimals = 0;
  for (const auto& numbers : {lattice.step, lattice.origin}) {
    for (const geometry::GridNumber& number : numbers) {
      if (number.mantissa != 0) decimals = std::max(decimals, -number.exponent);
    }
  }
  return decimals <= kMostDecimals ? std::optional(decimals) : std::nullopt;
}

/// `value` divided by a power of ten, to the nearest integer, half away from zero.
std::int64_t rounded(std::int64_t value, std::int64_t power) {
  const std::int64_t quotient = value / power;
  const std::int64_t rest = value % power;
  const std::int64_t size = rest < 0 ? -rest : rest;
  if (size < power - size) return quotient;
  return quotient + (value < 0 ? -1 : 1);
}

std::int64_t power_of_ten(int exponent) {
  std::int64_t power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

/// The solid with coordinates of `from` decimals rounded to `to`.
Result<Solid> rounded_solid(const GridSolid& grid, int from, int to) {
  const std::int64_t power = power_of_ten(from - to);
  Integers vertices = grid.vertices;
  for (auto& vertex : vertices) {
    for (std::int64_t& value : vertex) value = rounded(value, power);
  }
  const Solid& source = grid.submitted->solid;
  auto lattice = geometry::lattice_of_integers(vertices, grid_of(to));
  if (!lattice) return std::move(lattice).error();
  SolidArrays arrays = source.arrays();
  arrays.vertices = std::move(lattice->points);
  return Solid::make(std::move(arrays), lattice->lattice, source.srid());
}

/// The bytes of the blob of a valid solid; an error code instead when it is not valid.
struct Judged {
  std::size_t blob_bytes = 0;
  int code = 0;
};

int first_error(const Report& report) {
  int code = 0;
  for (const Finding& finding : report.findings) {
    if (finding.severity == Severity::warning) continue;
    if (code == 0 || finding.code < code) code = finding.code;
  }
  return code;
}

Result<Judged> judge(const Solid& solid, delaunay::EngineWorkers* workers,
                     const CertifyOptions& options) {
  const Inspection inspection = certify(solid, workers, options);
  if (!inspection.certified) return Judged{0, first_error(inspection.report)};
  const auto blob = encode(inspection.certified->solid);
  if (!blob) return blob.error();
  return Judged{blob->size(), 0};
}

class Adviser {
 public:
  Adviser(std::span<const SubmittedSolid> solids, delaunay::EngineWorkers* workers,
          const AdviceOptions& options)
      : solids_(solids), workers_(workers), options_(options) {
    advice_.solids = solids.size();
  }

  Result<Advice> run() {
    if (Status found = find_valid(); !found) return found.error();
    if (grid_.empty()) return std::move(advice_);
    for (int decimals = decimals_; decimals >= std::min(options_.fewest, decimals_); --decimals) {
      auto level = decimals == decimals_ ? Result<RoundedSolids>(as_they_are()) : round(decimals);
      if (!level) return std::move(level).error();
      advice_.levels.push_back(*std::move(level));
      if (advice_.levels.back().valid == 0) break;
    }
    return std::move(advice_);
  }

 private:
  Result<std::vector<Judged>> judge_all(std::size_t count,
                                        const std::function<Result<Judged>(std::size_t)>& work) {
    std::vector<std::optional<Result<Judged>>> judged(count);
    geometry::for_each_piece(count, static_cast<unsigned>(options_.threads),
                             [&](std::size_t i, bool) { judged[i] = work(i); });
    std::vector<Judged> all;
    for (auto& one : judged) {
      if (!*one) return std::move(*one).error();
      all.push_back(**std::move(one));
    }
    return all;
  }

  /// Keeps the valid solids as integers of the decimals that all of them need.
  Status find_valid() {
    auto judged = judge_all(solids_.size(), [this](std::size_t i) {
      return judge(solids_[i].solid, workers_, options_for(solids_[i], options_.certify));
    });
    if (!judged) return std::move(judged).error();
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      if ((*judged)[i].blob_bytes == 0) continue;
      ++advice_.valid;
      const auto decimals = decimals_of(solids_[i].solid.lattice());
      if (!decimals) {
        ++advice_.off_grid;
        continue;
      }
      decimals_ = std::max(decimals_, *decimals);
      grid_.push_back({&solids_[i], {}, (*judged)[i].blob_bytes});
    }
    for (GridSolid& grid : grid_) {
      const Solid& solid = grid.submitted->solid;
      auto vertices = integers_under(solid.lattice(), solid.vertices(), grid_of(decimals_));
      if (!vertices) return std::move(vertices).error();
      grid.vertices = *std::move(vertices);
    }
    return Done{};
  }

  RoundedSolids as_they_are() const {
    RoundedSolids level;
    level.decimals = decimals_;
    level.valid = grid_.size();
    for (const GridSolid& grid : grid_) level.blob_bytes += grid.blob_bytes;
    return level;
  }

  Result<RoundedSolids> round(int decimals) {
    auto judged = judge_all(grid_.size(), [&](std::size_t i) -> Result<Judged> {
      const auto solid = rounded_solid(grid_[i], decimals_, decimals);
      if (!solid) return solid.error();
      return judge(*solid, workers_, options_.certify);
    });
    if (!judged) return std::move(judged).error();
    RoundedSolids level;
    level.decimals = decimals;
    for (std::size_t i = 0; i < judged->size(); ++i) {
      const Judged& one = (*judged)[i];
      level.blob_bytes += one.blob_bytes;
      ++(one.blob_bytes > 0 ? level.valid : level.broken);
      if (one.blob_bytes > 0 || level.first_broken) continue;
      level.first_broken = {grid_[i].submitted->source, one.code};
    }
    return level;
  }

  std::span<const SubmittedSolid> solids_;
  delaunay::EngineWorkers* workers_;
  const AdviceOptions& options_;
  Advice advice_;
  std::vector<GridSolid> grid_;
  int decimals_ = 0;  // the most that a valid solid needs
};

}  // namespace

Result<Advice> advise(std::span<const SubmittedSolid> solids, delaunay::EngineWorkers* workers,
                      const AdviceOptions& options) {
  return Adviser(solids, workers, options).run();
}

}  // namespace watertight::pipeline
