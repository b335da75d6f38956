// SPDX-License-Identifier: GPL-3.0-or-later
//
// The function of the bridge that makes polyhedra of curved solids.
#include <utility>

#include "formats/document.h"
#include "formats/ewkb.h"
#include "sql/judge.h"
#include "sql/reply.h"

namespace watertight::sql {
namespace {

/// The only solid of a document. Errors: unsupported for none or several; why it was not read.
Result<SubmittedSolid> only_solid(Document document) {
  std::size_t solids = 0;
  for (const Feature& feature : document.features) solids += formats::solid_count(feature);
  if (solids != 1) {
    return Error{ErrorCode::unsupported,
                 "the document has " + std::to_string(solids) + " solids instead of one"};
  }
  Feature& feature = document.features.front();
  if (!feature.unreadable.empty()) return std::move(feature.unreadable.front().error);
  SubmittedSolid solid = std::move(feature.solids.front());
  if (solid.tessellation->left_out.empty()) return solid;
  const auto& face = solid.tessellation->left_out.front();
  return Error{ErrorCode::unsupported, face.face + " cannot be tessellated: " + face.reason};
}

void tessellate_into(const wt_job& job, double chord, wt_reply* reply) {
  const CallLimits call(job);
  formats::ReadOptions reading;
  reading.limits = call.of_input();
  reading.curved.chord = chord;
  reading.curved.has_crossing = validate::has_crossing_facets;
  auto document = formats::read_document(bytes_of(job), Format::brep, reading);
  if (!document) return fail(reply, call.of_reading(std::move(document).error()));
  const auto examined = certify_read(job, call, only_solid(*std::move(document)), reply);
  if (!examined) return;
  if (!examined->inspection.certified) return fail_invalid(examined->inspection.report, reply);
  answer(reply, formats::write_ewkb(examined->submitted.solid));
}

}  // namespace
}  // namespace watertight::sql

void wt_bridge_tessellate(const wt_job* job, double chord, wt_reply* reply) noexcept {
  watertight::sql::guarded(reply, [=] { watertight::sql::tessellate_into(*job, chord, reply); });
}
