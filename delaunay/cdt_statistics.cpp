// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/cdt_statistics.h"

namespace watertight::delaunay {

void CdtStatistics::add(std::span<const RungAttempt> attempts_of_solid) {
  if (attempts_of_solid.empty()) return;
  ++solids;
  for (const RungAttempt& attempt : attempts_of_solid) {
    const auto rung = static_cast<std::size_t>(attempt.rung);
    if (rung < kRungs) ++attempts[rung][static_cast<std::size_t>(attempt.result)];
    seconds += attempt.seconds;
    cpu_seconds += attempt.cpu_seconds;
    worker_seconds += attempt.worker_seconds;
    engine_seconds += attempt.engine_seconds;
  }
  const RungAttempt& last = attempts_of_solid.back();
  if (last.result == RungOutcome::accepted) {
    ++accepted;
  } else if (last.result == RungOutcome::refused_by_certificate &&
             is_property_of_solid(last.refusal)) {
    ++refuted;
  } else {
    ++undecided;
  }
}

CdtStatistics& CdtStatistics::operator+=(const CdtStatistics& other) {
  solids += other.solids;
  accepted += other.accepted;
  refuted += other.refuted;
  undecided += other.undecided;
  for (std::size_t rung = 0; rung < kRungs; ++rung) {
    for (std::size_t outcome = 0; outcome < kRungOutcomes; ++outcome) {
      attempts[rung][outcome] += other.attempts[rung][outcome];
    }
  }
  seconds += other.seconds;
  cpu_seconds += other.cpu_seconds;
  worker_seconds += other.worker_seconds;
  engine_seconds += other.engine_seconds;
  return *this;
}

std::uint64_t CdtStatistics::count(Rung rung, RungOutcome outcome) const {
  const auto place = static_cast<std::size_t>(rung);
  return place < kRungs ? attempts[place][static_cast<std::size_t>(outcome)] : 0;
}

bool is_property_of_solid(CertificateRefusal refusal) {
  return refusal == CertificateRefusal::interior_disconnected ||
         refusal == CertificateRefusal::cavity_mismatch ||
         refusal == CertificateRefusal::wrong_orientation;
}

}  // namespace watertight::delaunay
