// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/rung.h"

namespace watertight::delaunay {

std::string_view to_string(Rung rung) {
  switch (rung) {
    case Rung::none:
      return "none";
    case Rung::delaunay:
      return "delaunay";
    case Rung::recovered:
      return "recovered";
    case Rung::patch:
      return "patch";
    case Rung::patch_scaled:
      return "patch-scaled";
    case Rung::triangles_scaled:
      return "triangles-scaled";
    case Rung::tetgen:
      return "tetgen";
  }
  return "";
}

std::string_view to_string(CertificateRefusal refusal) {
  switch (refusal) {
    case CertificateRefusal::none:
      return "none";
    case CertificateRefusal::not_a_complex:
      return "not-a-complex";
    case CertificateRefusal::not_convex:
      return "not-convex";
    case CertificateRefusal::vertex_missing:
      return "vertex-missing";
    case CertificateRefusal::not_a_boundary:
      return "not-a-boundary";
    case CertificateRefusal::interior_disconnected:
      return "interior-disconnected";
    case CertificateRefusal::cavity_mismatch:
      return "cavity-mismatch";
    case CertificateRefusal::facet_not_conforming:
      return "facet-not-conforming";
    case CertificateRefusal::not_a_manifold:
      return "not-a-manifold";
    case CertificateRefusal::foreign_face:
      return "foreign-face";
    case CertificateRefusal::wrong_orientation:
      return "wrong-orientation";
    case CertificateRefusal::volume_mismatch:
      return "volume-mismatch";
    case CertificateRefusal::cancelled:
      return "cancelled";
  }
  return "";
}

std::string_view to_string(RungOutcome outcome) {
  switch (outcome) {
    case RungOutcome::accepted:
      return "accepted";
    case RungOutcome::refused_by_certificate:
      return "refused-by-certificate";
    case RungOutcome::not_delaunay:
      return "not-delaunay";
    case RungOutcome::engine_error:
      return "engine-error";
    case RungOutcome::crashed:
      return "crashed";
    case RungOutcome::timed_out:
      return "timed-out";
    case RungOutcome::memory_limit:
      return "memory-limit";
    case RungOutcome::garbage:
      return "garbage";
    case RungOutcome::cancelled:
      return "cancelled";
    case RungOutcome::not_started:
      return "not-started";
  }
  return "";
}

}  // namespace watertight::delaunay
