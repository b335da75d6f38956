// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers that validate: POST items (and store), POST /validate.
#include <memory>
#include <optional>

#include "pipeline/outcome_json.h"
#include "pipeline/stored/collection_header.h"
#include "pipeline/streaming/ingestion.h"
#include "server/documents/report_answer.h"
#include "server/documents/rules.h"
#include "server/documents/submission.h"
#include "server/handlers.h"
#include "server/items/preconditions.h"
#include "server/metrics/metrics.h"

namespace watertight::server {
namespace {

void count(Metrics* metrics, const pipeline::FeatureOutcome& feature) {
  if (metrics == nullptr) return;
  for (const pipeline::SolidOutcome& solid : feature.solids) metrics->count(solid.report);
  for (const pipeline::InspectedGroup& group : feature.groups)
    metrics->count(group.report.findings);
}

/// The header of the collection if the body is a bare feature, which needs one; else "". Errors:
/// conflict when its features have several headers, as the feature would be read wrongly.
Result<std::string> header_for(const RoutedRequest& request) {
  if (!is_bare_feature(request)) return std::string();
  return pipeline::collection_header(*request.service.store, request.target.segments[1]);
}

/// The most features of which the answer has the outcomes, valid or not.
constexpr std::size_t kMostOutcomes = 1000;
/// The most bytes of their reports; a feature with longer ones is in the answer if it is the only.
constexpr std::uint64_t kMostOutcomeBytes = 64ULL << 20U;

Response answer_of(const pipeline::IngestOutcome& outcome, const std::string& collection) {
  // With invalid=skip some features may be stored; the report says which.
  Response response{outcome.stored > 0 ? 201U : 200U,
                    std::string(kJson),
                    pipeline::outcome_json(outcome) + "\n",
                    {}};
  if (outcome.total == 1 && outcome.stored == 1) {
    response.headers.push_back({"Location", item_path(collection, outcome.features.front().id)});
  }
  return response;
}

/// Passes the documents of the body to the ingestion. Returns the problem with them, if any.
std::optional<Problem> read_into(pipeline::Ingestion& ingestion, const RoutedRequest& request,
                                 formats::Surfaces surfaces) {
  if (is_container_body(request)) {
    const Submission memory = container_submission(request);
    if (memory.problem) return memory.problem;
    const Status added =
        ingestion.add_container(as_bytes(request.request.body), request.service.options.limits);
    return added ? std::nullopt : std::optional(problem_of_body(added.error()));
  }
  const auto header = header_for(request);
  if (!header) return to_problem(header.error());
  Submission submission = read_submission(request, AcceptedFormats::city_models, *header, surfaces);
  if (submission.problem) return submission.problem;
  const Status added = ingestion.add(*submission.reader);
  return added ? std::nullopt : std::optional(problem_of_body(added.error()));
}

}  // namespace

Response post_items(const RoutedRequest& request) {
  if (auto refusal = unless_conditional(request)) return *std::move(refusal);
  pipeline::IngestOptions options = ingest_options(request);
  options.collection = request.target.segments[1];
  if (const std::string* named = request.target.parameter("invalid")) {
    const auto invalid = pipeline::policy_named(*named);
    if (!invalid) return to_response(to_problem(invalid.error()));
    options.policy = *invalid;
  }
  if (Status rules = read_rules(request.target, options); !rules) {
    return to_response(to_problem(rules.error()));
  }
  const auto surfaces = stored_surfaces(request.target);
  if (!surfaces) return to_response(to_problem(surfaces.error()));
  options.surfaces = *surfaces;
  auto condition = write_condition(request.request);
  if (!condition) return to_response(to_problem(condition.error()));
  options.condition = *std::move(condition);
  pipeline::OutcomeKeeper keeper(kMostOutcomes, kMostOutcomeBytes);
  pipeline::Ingestion ingestion(*request.service.store, request.service.workers, options,
                                [&](pipeline::FeatureOutcome&& feature) -> Status {
                                  count(request.service.metrics, feature);
                                  keeper.add(std::move(feature));
                                  return Done{};
                                });
  if (const auto problem = read_into(ingestion, request, *surfaces)) return to_response(*problem);
  const auto counts = ingestion.finish();
  if (!counts) return to_response(to_problem(counts.error()));
  const auto outcome = std::move(keeper).outcome(*counts, ingestion.versions());
  return ingestion.is_refused() ? refused_document(outcome, "nothing was stored")
                                : answer_of(outcome, options.collection);
}

Response post_validate(const RoutedRequest& request) {
  pipeline::IngestOptions options = ingest_options(request);
  const Status status = read_rules(request.target, options);
  if (!status) return to_response(to_problem(status.error()));
  const auto kind = report_kind(request.request.header("accept"));
  if (!kind) return refuse_report_kinds();
  const auto surfaces = judged_surfaces(request.target);
  if (!surfaces) return to_response(to_problem(surfaces.error()));
  options.certify.severity_of_surfaces = surfaces->severity;
  Submission submission = read_submission(request, AcceptedFormats::all, "", surfaces->reading);
  if (submission.problem) return to_response(*submission.problem);
  ReportAnswer answer(request.service, *kind, options, surfaces->name);
  const Status judged = answer.judge(*submission.reader, "request body");
  if (!judged) return to_response(problem_of_body(judged.error()));
  return std::move(answer).finish();
}

}  // namespace watertight::server
