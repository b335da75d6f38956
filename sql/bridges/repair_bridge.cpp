// SPDX-License-Identifier: GPL-3.0-or-later
//
// The functions of the bridge that repair solids.
#include <optional>
#include <utility>

#include "formats/ewkb.h"
#include "repair/summary_json.h"
#include "sql/judge.h"
#include "sql/reply.h"

namespace watertight::sql {
namespace {

struct RepairedInput {
  Solid submitted;
  repair::Repaired repaired;
};

/// Repairs the solid of EWKB. Nothing, and a failure of the reply, if it cannot be read, is
/// undecided, or the call has to end.
std::optional<RepairedInput> repaired(const wt_job& job, const wt_repair_choice& choice,
                                      wt_reply* reply) {
  const CallLimits call(job);
  const auto refused = [&](const Error& error) {
    fail(reply, error);
    return std::nullopt;
  };
  auto remedies = repair::remedies_of(choice.remedies);
  if (!remedies) return refused(remedies.error());
  auto submitted = formats::read_ewkb(bytes_of(job), call.of_input());
  if (!submitted) return refused(call.of_reading(std::move(submitted).error()));
  repair::RepairOptions options;
  options.remedies = *std::move(remedies);
  options.weld_metres = choice.weld;
  options.certify = options_of(job, call);
  options.certify.rounded = submitted->rounded;
  repair::Repaired result = repair::repair(submitted->solid, workers_of(job), options);
  if (const Status in_time = call.check(); !in_time) return refused(in_time.error());
  const bool is_undecided =
      result.outcome == repair::Repaired::Outcome::not_repaired &&
      (result.before.verdict == Verdict::undecided || !result.undecided_reason.empty());
  if (is_undecided) {
    const std::string reason = result.undecided_reason.empty()
                                   ? "the solid is undecided: " + result.before.undecided_reason
                                   : "the mended solid is undecided: " + result.undecided_reason;
    fail(reply, WATERTIGHT_UNDECIDED, reason);
    return std::nullopt;
  }
  return RepairedInput{std::move(submitted->solid), std::move(result)};
}

void repair_into(const wt_job& job, const wt_repair_choice& choice, wt_reply* reply) {
  const auto input = repaired(job, choice, reply);
  if (!input) return;
  switch (input->repaired.outcome) {
    case repair::Repaired::Outcome::valid_as_read:
      return answer(reply, bytes_of(job));
    case repair::Repaired::Outcome::not_repaired:
      return fail_invalid(input->repaired.before, reply);
    case repair::Repaired::Outcome::repaired:
      return answer(reply, formats::write_ewkb(input->repaired.after->certified->solid.solid()));
  }
}

void repair_report_into(const wt_job& job, const wt_repair_choice& choice, wt_reply* reply) {
  const auto input = repaired(job, choice, reply);
  if (!input) return;
  const repair::RepairSummary summary = repair::summary_of(input->submitted, input->repaired);
  answer(reply, as_bytes(repair::summary_json(summary)));
}

}  // namespace
}  // namespace watertight::sql

using watertight::sql::guarded;

void wt_bridge_repair(const wt_job* job, const wt_repair_choice* choice, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::repair_into(*job, *choice, reply); });
}

void wt_bridge_repair_report(const wt_job* job, const wt_repair_choice* choice,
                             wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::repair_report_into(*job, *choice, reply); });
}
