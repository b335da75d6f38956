// SPDX-License-Identifier: GPL-3.0-or-later
#include "sql/bridge.h"

#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/blob.h"
#include "codec/page.h"
#include "formats/ewkb.h"
#include "geometry/lattice/moved_lattice.h"
#include "sql/info_json.h"
#include "sql/make_value.h"
#include "sql/reply.h"
#include "validate/certify.h"
#include "validate/groups.h"
#include "validate/report_json.h"

struct wt_engine {
  watertight::delaunay::EngineWorkers workers;
};

namespace watertight::sql {
namespace {

// The most findings that a detail names; wt_validate gives the whole report.
constexpr std::size_t kFindingsShown = 20;

struct Examined {
  SubmittedSolid submitted;
  Inspection inspection;
};

wt_rule_choice rules_of(const wt_job& job) {
  return job.rules == nullptr ? wt_default_rules() : *job.rules;
}

/// The rules of a job as options of the validator.
CertifyOptions options_of(const wt_job& job, const CallLimits& call) {
  CertifyOptions options;
  options.limits = call.of_input();
  const wt_rule_choice rules = rules_of(job);
  options.tolerances.planarity_metres = rules.planarity;
  options.tolerances.planarity_degrees = rules.planarity_angle;
  options.proof = rules.is_boundary_enough ? Proof::boundary : Proof::tetrahedralization;
  options.ladder.strict = rules.is_strict;
  options.ladder.cancel = call.poll();
  options.ladder.memory_in_engine = call.memory_bytes();
  return options;
}

/// Certifies a solid that was read. Nothing, and a failure of the reply, unless the verdict is
/// valid or invalid.
std::optional<Examined> certify_read(const wt_job& job, const CallLimits& call,
                                     Result<SubmittedSolid> submitted, wt_reply* reply) {
  if (!submitted) {
    fail(reply, call.of_reading(std::move(submitted).error()));
    return std::nullopt;
  }
  CertifyOptions options = options_of(job, call);
  options.rounded = submitted->rounded;
  Inspection inspection =
      certify(submitted->solid, job.engine == nullptr ? nullptr : &job.engine->workers, options);
  if (const Status in_time = call.check(); !in_time) {
    fail(reply, in_time.error());
    return std::nullopt;
  }
  if (inspection.report.verdict == Verdict::undecided) {
    fail(reply, WATERTIGHT_UNDECIDED,
         "the solid is undecided: " + inspection.report.undecided_reason);
    return std::nullopt;
  }
  return Examined{std::move(*submitted), std::move(inspection)};
}

/// Reads EWKB and certifies it by the rules of the job.
std::optional<Examined> examine(const wt_job& job, const CallLimits& call, wt_reply* reply) {
  return certify_read(job, call, formats::read_ewkb(bytes_of(job), call.of_input()), reply);
}

/// The errors of a report, one a line, the first ones only.
std::string errors_of(const Report& report) {
  std::string lines;
  std::size_t count = 0;
  for (const Finding& finding : report.findings) {
    if (finding.severity != Severity::error || ++count > kFindingsShown) continue;
    if (!lines.empty()) lines += '\n';
    lines += validate::finding_text(finding);
  }
  const std::uint64_t omitted =
      report.findings_omitted + (count > kFindingsShown ? count - kFindingsShown : 0);
  if (omitted > 0) lines += "\nand " + std::to_string(omitted) + " more";
  return lines;
}

void fail_invalid(const Report& report, wt_reply* reply) {
  fail(reply, "22023", "the solid is invalid", errors_of(report));
  reply->failure.is_invalid = true;
}

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
  const Result<Bytes> blob = encode(examined->inspection.certified->solid);
  if (!blob) return fail(reply, blob.error());
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
  if (!blob) return fail(reply, blob.error());
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
  value_into(call, solid.solid(), encode(solid), reply);
}

/// Whether this program can judge by the rules that a blob states.
Status check_acceptance(const Acceptance& acceptance) {
  const Tolerances& tolerances = acceptance.tolerances;
  const auto is_within = [](double value, double least, double most) {
    return value >= least && value <= most;
  };
  if (acceptance.rule_set != geometry::kRuleSet) {
    return Error{ErrorCode::unsupported,
                 "the blob states rule set " + std::to_string(acceptance.rule_set)};
  }
  if (!is_within(tolerances.planarity_metres, WATERTIGHT_LEAST_PLANARITY,
                 WATERTIGHT_MOST_PLANARITY) ||
      !is_within(tolerances.planarity_degrees, WATERTIGHT_LEAST_ANGLE, WATERTIGHT_MOST_ANGLE) ||
      tolerances.snap_metres != 0) {
    return Error{ErrorCode::invalid_argument, "the blob states tolerances outside their ranges"};
  }
  return Done{};
}

/// The solid of a blob, judged again: the exact tests run with the tolerances that the blob states;
/// its proof by tetrahedralization is believed. Nothing, and a failure of the reply, if it does not
/// pass.
std::optional<ValidSolid> judged(const wt_job& job, const CallLimits& call, const Decoded& decoded,
                                 wt_reply* reply) {
  const auto refused = [&](const Error& error) {
    fail(reply, error);
    return std::nullopt;
  };
  const Acceptance& acceptance = decoded.info.acceptance;
  if (const Status checked = check_acceptance(acceptance); !checked) {
    return refused(checked.error());
  }
  CertifyOptions options = options_of(job, call);
  options.tolerances = acceptance.tolerances;
  options.proof = Proof::boundary;
  options.ladder.strict = false;
  const Inspection inspection = certify(decoded.solid, nullptr, options);
  if (const Status in_time = call.check(); !in_time) return refused(in_time.error());
  if (!inspection.certified) {
    fail_invalid(inspection.report, reply);
    return std::nullopt;
  }
  const ValidSolid& solid = inspection.certified->solid;
  const auto order = compare(solid.solid(), decoded.solid);
  if (!order) return refused(order.error());
  if (*order == 0) return solid;
  return refused(
      {ErrorCode::not_encodable, "the blob has another solid than a valid one: it is inside out"});
}

/// Answers a blob with its value.
void solid_of_blob(const wt_job& job, const CallLimits& call, wt_reply* reply) {
  const Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  if (!judged(job, call, *decoded, reply)) return;
  value_into(call, decoded->solid, Bytes(job.bytes, job.bytes + job.size), reply);
}

/// How the solids of two blobs meet; "apart" after a failure of the reply.
wt_relation relation_of(const wt_job& job, ByteView other, wt_reply* reply) {
  const CallLimits call(job);
  std::vector<ValidSolid> solids;
  for (const ByteView blob : {bytes_of(job), other}) {
    const Result<Decoded> decoded = decode(blob, call.of_input());
    if (!decoded) return fail(reply, call.of_reading(decoded.error())), WT_APART;
    auto solid = judged(job, call, *decoded, reply);
    if (!solid) return WT_APART;
    solids.push_back(*std::move(solid));
  }
  const std::array<validate::GroupMember, 2> members{{{&solids[0]}, {&solids[1]}}};
  const std::array<Index, 2> cells{0, 1};
  std::array<validate::CellPair, 1> pair{{{0, 1}}};
  validate::GroupOptions options;
  options.do_steps_warn = false;
  options.limits = call.of_input();
  options.cancel = call.poll();
  const validate::GroupReport report = validate::check_cells(members, cells, pair, options);
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error()), WT_APART;
  if (!report.findings.empty()) return WT_OVERLAPPING;
  switch (pair[0].contact) {
    case validate::CellContact::area:
      return WT_TOUCHING_BY_AREA;
    case validate::CellContact::at_points:
      return WT_TOUCHING_AT_POINTS;
    case validate::CellContact::apart:
      return WT_APART;
    default:
      break;
  }
  fail(reply, "0A000", "the solids have no common grid on which they can be compared");
  return WT_APART;
}

void solid_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const bool is_blob = job.size >= 2 && job.bytes[0] == 'W' && job.bytes[1] == 'T';
  if (is_blob) return solid_of_blob(job, call, reply);
  solid_of_read(job, call, formats::read_ewkb(bytes_of(job), call.of_input()), reply);
}

void translate_into(const wt_job& job, const double* way, wt_reply* reply) {
  const CallLimits call(job);
  Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  const Solid& solid = decoded->solid;
  const auto lattice = geometry::moved_lattice(solid.lattice(), {way[0], way[1], way[2]});
  if (!lattice) return fail(reply, lattice.error());
  auto moved = Solid::make(solid.arrays(), *lattice, solid.srid());
  if (!moved) return fail(reply, moved.error());
  decoded->solid = *std::move(moved);
  const Result<Bytes> blob = codec::blob_of(*decoded);
  if (!blob) return fail(reply, blob.error());
  wt_job again = job;
  again.bytes = blob->data();
  again.size = blob->size();
  solid_of_blob(again, call, reply);
}

void solid_of_wkt_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  solid_of_read(job, call, formats::read_wkt(as_text(bytes_of(job)), call.of_input()), reply);
}

void wkt_into(const wt_job& job, wt_reply* reply) {
  const CallLimits call(job);
  const Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  const std::string text = formats::write_wkt(decoded->solid);
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  answer(reply, as_bytes(text));
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

void wt_bridge_translate(const wt_job* job, const double way[3], wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::translate_into(*job, way, reply); });
}

wt_relation wt_bridge_relation(const wt_job* job, const uint8_t* other, size_t other_size,
                               wt_reply* reply) noexcept {
  wt_relation relation = WT_APART;
  guarded(reply, [&] {
    relation = watertight::sql::relation_of(*job, {other, other_size}, reply);
  });
  return relation;
}

void wt_bridge_wkt(const wt_job* job, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::wkt_into(*job, reply); });
}

wt_rule_choice wt_default_rules() noexcept {
  const watertight::Tolerances tolerances;
  return {tolerances.planarity_metres, tolerances.planarity_degrees, false, false};
}

uint32_t wt_rule_set() noexcept { return watertight::geometry::kRuleSet; }

const char* wt_bridge_version() noexcept { return WATERTIGHT_VERSION; }
