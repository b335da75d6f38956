// SPDX-License-Identifier: GPL-3.0-or-later
//
// How the bridge judges solids: those that come in, and those of blobs.
#pragma once

#include <optional>

#include "codec/blob.h"
#include "formats/document.h"
#include "sql/bridge.h"
#include "sql/reply.h"
#include "validate/certify.h"

struct wt_engine {
  watertight::delaunay::EngineWorkers workers;
};

namespace watertight::sql {

struct Examined {
  SubmittedSolid submitted;
  Inspection inspection;
};

/// The rules of a job, or the default ones.
wt_rule_choice rules_of(const wt_job& job);
/// The rules of a job as options of the validator.
CertifyOptions options_of(const wt_job& job, const CallLimits& call);
/// The helpers of a job; null without.
inline delaunay::EngineWorkers* workers_of(const wt_job& job) {
  return job.engine == nullptr ? nullptr : &job.engine->workers;
}

/// Certifies a solid that was read. Nothing, and a failure of the reply, unless the verdict is
/// valid or invalid.
std::optional<Examined> certify_read(const wt_job& job, const CallLimits& call,
                                     Result<SubmittedSolid> submitted, wt_reply* reply);
/// Reads EWKB and certifies it by the rules of the job.
std::optional<Examined> examine(const wt_job& job, const CallLimits& call, wt_reply* reply);

/// Makes the reply a failure whose detail has the first findings of a report.
void fail_invalid(const Report& report, wt_reply* reply);

/// The solid of a blob, judged again: the exact tests run with the tolerances that the blob states;
/// its proof by tetrahedralization is believed. Nothing, and a failure of the reply, if it does not
/// pass.
std::optional<ValidSolid> judged(const wt_job& job, const CallLimits& call, const Decoded& decoded,
                                 wt_reply* reply);

}  // namespace watertight::sql
