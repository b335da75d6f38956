// SPDX-License-Identifier: GPL-3.0-or-later
//
// portable_prover <BLOB: decodes standard input, tetrahedralizes the solid by rungs 0 and 1 and
// lets the certificate judge. The program is the proof alone, as a build without an operating
// system would have it: see portable.sh.
#include <cstdio>
#include <optional>
#include <vector>

#include "codec/blob.h"
#include "delaunay/certificate.h"
#include "delaunay/own_rungs.h"
#include "delaunay/shell_contacts.h"
#include "tessellate/facets.h"

using namespace watertight;

namespace {

/// The certificate's answer to what a rung made; nothing if it made nothing.
std::optional<delaunay::CertificateResult> judge(const Solid& solid,
                                                 const tessellate::FacetTriangles& canonical,
                                                 delaunay::RungResult& result,
                                                 delaunay::Rung rung) {
  if (!result.made) return std::nullopt;
  return check_certificate(solid, canonical, *std::move(result.made), rung);
}

}  // namespace

int main() {
  Bytes bytes(std::size_t{1} << 20);
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), stdin));
  const auto decoded = decode(bytes);
  if (!decoded) {
    std::printf("%s\n", to_string(decoded.error()).c_str());
    return 1;
  }
  const Solid& solid = decoded->solid;
  const auto canonical = tessellate::triangulate_facets(solid);
  const auto contacts = delaunay::divide_at_contacts(solid, canonical, {});
  if (!contacts) {
    std::printf("%s\n", to_string(contacts.error()).c_str());
    return 1;
  }
  const CancelPoll never;
  const auto& triangles = contacts->has_contacts() ? contacts->triangles : canonical;
  delaunay::OwnRungs rungs(solid, triangles, contacts->has_contacts(), never);
  delaunay::RungResult result = rungs.delaunay({});
  auto judged = judge(solid, canonical, result, delaunay::Rung::delaunay);
  if (!judged) {
    result = rungs.recovered(contacts->is_touched);
    judged = judge(solid, canonical, result, delaunay::Rung::recovered);
  }
  if (!judged) {
    std::printf("%s\n", result.text.c_str());
    return 1;
  }
  // Some golden blobs hold solids that are not valid.
  const bool is_proven = judged->refusal == delaunay::CertificateRefusal::none;
  std::printf("%s\n", is_proven ? "proven" : delaunay::to_string(judged->refusal).data());
  return 0;
}
