// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rules of requests that judge documents, and the refusal of documents that break them.
// Internal to server/.
#pragma once

#include <string_view>

#include "pipeline/pipeline.h"
#include "repair/repair.h"
#include "server/handlers.h"

namespace watertight::server {

/// The limits of the service, with the threads of a request and a poll.
pipeline::IngestOptions ingest_options(const Service& service, const CancelPoll& is_cancelled);

/// Reads how a document is stored: policy, rules, surfaces. Errors: invalid_argument.
Status read_submit_rules(const Target& target, pipeline::IngestOptions& options);

/// The options of a request that stores features: collection, policy, rules, surfaces, condition.
/// Errors: invalid_argument.
Result<pipeline::IngestOptions> submit_options(const RoutedRequest& request);

/// Reads the rules by which solids are judged: planarity, planarity-angle, overlap, exact-overlaps,
/// proof, strict. Errors: invalid_argument.
Status read_rules(const Target& target, pipeline::IngestOptions& options);

/// Reads how solids are repaired: the remedies in the parameter `list`, weld, islands, and
/// for smooth patches density, regularity, collar, crease, chord. Errors: invalid_argument.
Status read_remedies(const Target& target, std::string_view list, repair::RepairOptions& options);

/// The rule for surfaces that are kept: as they came, or closed ones as solids. Errors:
/// invalid_argument.
Result<formats::Surfaces> stored_surfaces(const Target& target);

/// How curved solids become polyhedra: chord, lattice. Errors: invalid_argument.
Result<formats::CurvedReading> curved_reading_of(const Target& target);

/// The rule for surfaces that are judged; its name is "" for the default.
struct JudgedSurfaces : pipeline::SurfaceRule {
  std::string name;
};
/// Errors: invalid_argument.
Result<JudgedSurfaces> judged_surfaces(const Target& target);

/// The answer 422 to a document that is not valid, or undecided; the report in it says why, and
/// `consequence` what did not happen ("nothing was stored").
Response refused_document(const pipeline::IngestOutcome& outcome, std::string_view consequence);

}  // namespace watertight::server
