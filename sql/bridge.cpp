// SPDX-License-Identifier: GPL-3.0-or-later
#include "sql/bridge.h"

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/blob.h"
#include "codec/page.h"
#include "formats/ewkb.h"
#include "sql/info_json.h"
#include "sql/judge.h"
#include "sql/make_value.h"
#include "sql/reply.h"
#include "validate/report_json.h"

namespace watertight::sql {
namespace {

void validate_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const auto examined = examine(job, call, reply);
  if (!examined) return;
  // The report of an immutable function must not say how the verdict was reached, as a helper can
  // crash once.
  Report report = examined->inspection.report;
  report.attempts.clear();
  report.rung = delaunay::Rung::none;
  report.refilled_facets.clear();
  validate::ReportJsonOptions options;
  options.include_times = false;
  options.is_strict = rules_of(job).is_strict;
  answer(reply, as_bytes(validate::report_json(report, examined->submitted.solid, options)));
}

void is_valid_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const auto examined = examine(job, call, reply);
  if (!examined) return;
  reply->truth = examined->inspection.report.verdict == Verdict::valid;
}

void encode_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const auto examined = examine(job, call, reply);
  if (!examined) return;
  if (!examined->inspection.certified) return fail_invalid(examined->inspection.report, reply);
  const Result<Bytes> blob =
      encode(examined->inspection.certified->solid, {.cancel = &call.poll()});
  if (!blob) return fail(reply, call.of_reading(blob.error()));
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  answer(reply, *blob);
}

void decode_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  answer(reply, formats::write_ewkb(decoded->solid));
}

void blob_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const auto solids = codec::decode_page(bytes_of(job), call.of_input());
  if (!solids) return fail(reply, call.of_reading(solids.error()));
  if (job.slot < 0 || static_cast<std::size_t>(job.slot) >= solids->size()) {
    return fail(reply, "22023", "the page has no solid of this number",
                "It has " + std::to_string(solids->size()) + ", counted from 0.");
  }
  const Result<Bytes> blob = codec::blob_of((*solids)[static_cast<std::size_t>(job.slot)]);
  if (!blob) return fail(reply, blob.error());
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  answer(reply, *blob);
}

void info_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const Result<codec::BlobInfo> info = codec::describe(bytes_of(job), call.of_input());
  if (!info) return fail(reply, call.of_reading(info.error()));
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  answer(reply, as_bytes(info_json(*info, job.size)));
}

void rules_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const Result<codec::BlobInfo> info = codec::describe(bytes_of(job), call.of_input());
  if (!info) return fail(reply, call.of_reading(info.error()));
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  answer(reply, as_bytes(rules_json(info->acceptance)));
}

/// Answers with the value of a solid and its blob.
void value_into(const CallLimits& call, const Solid& solid, const Result<Bytes>& blob,
                wt_reply* reply) {
  if (!blob) return fail(reply, call.of_reading(blob.error()));
  const Result<Bytes> value = make_value(solid, *blob);
  if (!value) return fail(reply, value.error());
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  answer(reply, *value);
}

/// Answers a solid that was read with its value.
void solid_of_read(const wt_job& job, const CallLimits& call, Result<SubmittedSolid> submitted,
                   wt_reply* reply) {
  const auto examined = certify_read(job, call, std::move(submitted), reply);
  if (!examined) return;
  if (!examined->inspection.certified) return fail_invalid(examined->inspection.report, reply);
  const ValidSolid& solid = examined->inspection.certified->solid;
  value_into(call, solid.solid(), encode(solid, {.cancel = &call.poll()}), reply);
}

/// Answers a blob with its value.
void solid_of_blob(const wt_job& job, const CallLimits& call, wt_reply* reply) {
  const Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  if (!judged(job, call, *decoded, reply)) return;
  value_into(call, decoded->solid, Bytes(job.bytes, job.bytes + job.size), reply);
}

void solid_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const bool is_blob = job.size >= 2 && job.bytes[0] == 'W' && job.bytes[1] == 'T';
  if (is_blob) return solid_of_blob(job, call, reply);
  solid_of_read(job, call, formats::read_ewkb(bytes_of(job), call.of_input()), reply);
}

void solid_of_wkt_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  solid_of_read(job, call, formats::read_wkt(as_text(bytes_of(job)), call.of_input()), reply);
}

}  // namespace
}  // namespace watertight::sql

using watertight::sql::guarded;

void wt_reply_clear(wt_reply* reply) noexcept {
  std::free(reply->bytes);           // NOLINT: memory that C owns
  std::free(reply->failure.detail);  // NOLINT
  *reply = wt_reply{};
}

wt_engine* wt_engine_make(const char* libexec) noexcept {
  wt_reply ignored{};
  wt_engine* engine = nullptr;
  guarded(&ignored, [&] {
    watertight::delaunay::EngineWorkers::Options options;
    options.processes = 1;
    if (libexec != nullptr && *libexec != '\0') {
      options.cgal_executable = std::string(libexec) + "/watertight-worker";
      options.tetgen_executable = std::string(libexec) + "/watertight-tetgen";
    }
    // The pointer is plain, because C owns the engine until wt_engine_end().
    engine = std::make_unique<wt_engine>(wt_engine{watertight::delaunay::EngineWorkers(options)})
                 .release();
  });
  wt_reply_clear(&ignored);
  return engine;
}

void wt_engine_end(wt_engine* engine) noexcept { const std::unique_ptr<wt_engine> owned(engine); }

void wt_bridge_validate(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::validate_into(*job, reply); });
}

void wt_bridge_is_valid(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::is_valid_into(*job, reply); });
}

void wt_bridge_encode(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::encode_into(*job, reply); });
}

void wt_bridge_decode(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::decode_into(*job, reply); });
}

void wt_bridge_blob(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::blob_into(*job, reply); });
}

void wt_bridge_info(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::info_into(*job, reply); });
}

void wt_bridge_rules_of(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::rules_into(*job, reply); });
}

void wt_bridge_solid(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::solid_into(*job, reply); });
}

void wt_bridge_solid_of_wkt(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::solid_of_wkt_into(*job, reply); });
}

wt_rule_choice wt_default_rules() noexcept {
  const watertight::Tolerances tolerances;
  return {tolerances.planarity_metres, tolerances.planarity_degrees, false, false};
}

uint32_t wt_rule_set() noexcept { return watertight::geometry::kRuleSet; }

const char* wt_bridge_version() noexcept { return WATERTIGHT_VERSION; }
