// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/structure.h"

#include <algorithm>

#include "base/json_text.h"
#include "delaunay/canonical_delaunay.h"

namespace watertight::pipeline {
namespace {

template <std::size_t kCount>
void write_indices(JsonText& json, const std::array<Index, kCount>& indices) {
  json.open('[');
  for (const Index index : indices) json.value(std::uint32_t{index});
  json.close(']');
}

/// The faces of the boundary that the Delaunay tetrahedralization of all points lacks; none where
/// there is no such tetrahedralization.
std::vector<Triangle> unrecovered_faces(const delaunay::Tetrahedralization& cdt) {
  std::vector<Triangle> missing;
  const auto delaunay = delaunay::canonical_delaunay(cdt.points);
  if (!delaunay) return missing;
  for (const delaunay::ConstrainedFace& face : cdt.constrained) {
    Triangle sorted = face.vertices;
    std::sort(sorted.begin(), sorted.end());
    if (!std::binary_search(delaunay->faces.begin(), delaunay->faces.end(), sorted)) {
      missing.push_back(sorted);
    }
  }
  return missing;
}

void write_certificate(JsonText& json, const delaunay::Certificate& certificate,
                       const Lattice& lattice) {
  const delaunay::Tetrahedralization& cdt = certificate.tetrahedralization;
  json.key("rung").value(delaunay::to_string(certificate.rung));
  json.key("vertices").open('[');
  for (const Point& point : cdt.points) json.value(lattice.world(point));
  json.close(']');
  json.key("steinerVertices").value(std::uint64_t{cdt.points.size() - cdt.input_count});
  json.key("tetrahedra").open('[');
  for (std::size_t i = 0; i < cdt.tetrahedra.size(); ++i) {
    if (certificate.is_interior[i]) write_indices(json, cdt.tetrahedra[i]);
  }
  json.close(']');
  json.key("unrecoveredFaces").open('[');
  for (const Triangle& face : unrecovered_faces(cdt)) write_indices(json, face);
  json.close(']');
}

/// The bytes of the solids of a feature, in its page and in blobs.
std::uint64_t solid_bytes(const EncodedFeature& feature) {
  std::uint64_t bytes = feature.page.size();
  for (const StoredSolid& solid : feature.solids) bytes += solid.blob.size();
  return bytes;
}

}  // namespace

Result<std::string> structure_json(const EncodedFeature& feature, std::size_t text_bytes,
                                   delaunay::EngineWorkers* workers,
                                   const CertifyOptions& options) {
  const auto decoded = decode_solids(feature, options.limits);
  if (!decoded) return decoded.error();
  JsonText json;
  json.open('{').key("id").value(feature.id);
  json.key("bytes").open('{').key("solids").value(solid_bytes(feature));
  json.key("text").value(std::uint64_t{text_bytes}).close('}');
  json.key("solids").open('[');
  auto next = decoded->begin();
  for (const StoredSolid& solid : feature.solids) {
    if (!solid.is_proven) continue;
    const Decoded& one = *next++;
    json.open('{').key("object").value(solid.object_id);
    if (!solid.lod.empty()) json.key("lod").value(solid.lod);
    json.key("geometry").value(solid.geometry).key("ordinal").value(solid.ordinal);
    json.key("mode").value(codec::to_string(one.info.mode));
    json.key("parts").open('[');
    for (const codec::BlobInfo::Part& part : one.info.parts) {
      json.open('{').key("name").value(part.name).key("bytes").value(part.bytes).close('}');
    }
    json.close(']');
    CertifyOptions again = options;
    again.tolerances = one.info.acceptance.tolerances;
    again.proof = one.info.acceptance.proof;
    const Inspection inspection = certify(one.solid, workers, again);
    if (inspection.certified && inspection.certified->certificate) {
      write_certificate(json, *inspection.certified->certificate,
                        inspection.certified->solid.solid().lattice());
    }
    json.close('}');
  }
  json.close(']').close('}');
  return json.take();
}

}  // namespace watertight::pipeline
