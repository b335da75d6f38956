// SPDX-License-Identifier: GPL-3.0-or-later
//
// The functions of the bridge that write the solids of blobs for other programs.
#include <array>
#include <string>
#include <vector>

#include "codec/blob.h"
#include "codec/page.h"
#include "formats/city_json/city_json.h"
#include "formats/document.h"
#include "formats/ewkb.h"
#include "sql/judge.h"
#include "sql/model.h"
#include "sql/reply.h"
#include "tessellate/without_holes.h"
#include "tiles/glb.h"

namespace watertight::sql {
namespace {

/// Answers a blob with what `write` makes of its solid.
template <class Write>
void written_into(const wt_job& job, wt_reply* reply, const Write& write) {
  const CallLimits call(job);
  Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  const Result<Bytes> bytes = write(std::move(decoded->solid));
  if (!bytes) return fail(reply, bytes.error());
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  answer(reply, *bytes);
}

Bytes bytes_of_text(const std::string& text) {
  const ByteView view = as_bytes(text);
  return Bytes(view.begin(), view.end());
}

/// A document of one solid.
Document document_of(Solid solid, std::string id) {
  Document document;
  document.format = Format::obj;
  Feature& feature = document.features.emplace_back();
  feature.id = std::move(id);
  feature.srid = solid.srid();
  feature.solids.push_back({std::move(solid), {}});
  return document;
}

Result<Bytes> obj_of(const Solid& solid) {
  auto simple = tessellate::without_holes(solid);
  if (!simple) return simple.error();
  return formats::write_document(document_of(*std::move(simple), {}), Format::obj);
}

Result<Bytes> glb_of(const Solid& solid) {
  const Result<tiles::FeatureMesh> mesh = model_of(solid);
  if (!mesh) return mesh.error();
  const std::array<const tiles::FeatureMesh*, 1> meshes{&*mesh};
  return tiles::write_glb(meshes, {}, tiles::Compression::none);
}

void city_json_into(const wt_job& job, const wt_named_blobs& solids, wt_reply* reply) {
  const CallLimits call(job);
  Document document;
  document.format = Format::obj;
  for (std::size_t i = 0; i < solids.count; ++i) {
    const ByteView blob(solids.blobs[i].bytes, solids.blobs[i].size);
    Result<Decoded> decoded = decode(blob, call.of_input());
    if (!decoded) return fail(reply, call.of_reading(decoded.error()));
    Document one = document_of(std::move(decoded->solid), solids.names[i]);
    document.features.push_back(std::move(one.features[0]));
    if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  }
  const auto model = formats::as_city_model(document);
  if (!model) return fail(reply, model.error());
  const auto text = formats::write_document(*model, Format::city_json);
  if (!text) return fail(reply, text.error());
  answer(reply, *text);
}

/// Answers a page of the solids of blobs; without bytes where there is no page.
void page_into(const wt_job& job, const wt_blob_view* blobs, std::size_t count, wt_reply* reply) {
  const CallLimits call(job);
  std::vector<ByteView> views;
  for (std::size_t i = 0; i < count; ++i) views.emplace_back(blobs[i].bytes, blobs[i].size);
  const auto page = codec::page_of_blobs(views);
  if (!page) return fail(reply, call.of_reading(page.error()));
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  if (*page) answer(reply, **page);
}

void tetrahedra_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  CertifyOptions options = options_of(job, call);
  options.tolerances = decoded->info.acceptance.tolerances;
  options.proof = Proof::tetrahedralization;
  options.ladder.strict = false;
  const Inspection inspection = certify(decoded->solid, workers_of(job), options);
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  if (!inspection.certified || !inspection.certified->certificate) {
    return fail(reply, WATERTIGHT_UNDECIDED,
                "the tetrahedralization of the solid was not found again: " +
                    inspection.report.undecided_reason);
  }
  const delaunay::Certificate& certificate = *inspection.certified->certificate;
  const delaunay::Tetrahedralization& cdt = certificate.tetrahedralization;
  const Lattice& lattice = inspection.certified->solid.solid().lattice();
  std::vector<wt_tetrahedron> tetrahedra;
  for (std::size_t i = 0; i < cdt.tetrahedra.size(); ++i) {
    if (!certificate.is_interior[i]) continue;
    wt_tetrahedron& tetrahedron = tetrahedra.emplace_back();
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const auto place = lattice.world(cdt.points[cdt.tetrahedra[i][corner]]);
      std::ranges::copy(place, tetrahedron.corners[corner]);
    }
  }
  answer(reply, {reinterpret_cast<const std::uint8_t*>(tetrahedra.data()),
                 tetrahedra.size() * sizeof(wt_tetrahedron)});
}

}  // namespace
}  // namespace watertight::sql

using watertight::Bytes;
using watertight::Result;
using watertight::Solid;
using watertight::sql::guarded;

void wt_bridge_wkt(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] {
    watertight::sql::written_into(*job, reply, [](const Solid& solid) -> Result<Bytes> {
      return watertight::sql::bytes_of_text(watertight::formats::write_wkt(solid));
    });
  });
}

void wt_bridge_obj(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::written_into(*job, reply, watertight::sql::obj_of); });
}

void wt_bridge_glb(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::written_into(*job, reply, watertight::sql::glb_of); });
}

void wt_bridge_boundary(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] {
    watertight::sql::written_into(*job, reply, [](const Solid& solid) -> Result<Bytes> {
      return watertight::formats::write_ewkb_of_boundary(solid);
    });
  });
}

void wt_bridge_city_json(const wt_job* job, const wt_named_blobs* solids,
                         wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::city_json_into(*job, *solids, reply); });
}

void wt_bridge_page(const wt_job* job, const wt_blob_view* blobs, size_t count,
                    wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::page_into(*job, blobs, count, reply); });
}

void wt_bridge_tetrahedra(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::tetrahedra_into(*job, reply); });
}
