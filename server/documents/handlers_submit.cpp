// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers that validate: POST items (and store), POST /validate.
#include <memory>
#include <optional>

#include "pipeline/outcome_json.h"
#include "pipeline/streaming/ingestion.h"
#include "server/documents/report_answer.h"
#include "server/documents/rules.h"
#include "server/documents/submission.h"
#include "server/features/links.h"
#include "server/handlers.h"
#include "server/items/preconditions.h"
#include "server/metrics/metrics.h"

namespace watertight::server {
namespace {

/// The most features of which the answer has the outcomes, valid or not.
constexpr std::size_t kMostOutcomes = 1000;
/// The most bytes of their reports; a feature with longer ones is in the answer if it is the only.
constexpr std::uint64_t kMostOutcomeBytes = 64ULL << 20U;

Response answer_of(const RoutedRequest& request, const pipeline::IngestOutcome& outcome) {
  // With invalid=skip some features may be stored; the report says which.
  Response response{outcome.stored > 0 ? 201U : 200U,
                    std::string(kJson),
                    pipeline::outcome_json(outcome) + "\n",
                    {}};
  if (outcome.total == 1 && outcome.stored == 1) {
    const std::string path = item_path(request.target.segments[1], outcome.features.front().id);
    response.headers.push_back({"Location", base_url(request) + path});
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
  Submission submission = read_submission(request, AcceptedFormats::with_ids, *header, surfaces);
  if (submission.problem) return submission.problem;
  const Status added = ingestion.add(*submission.reader);
  return added ? std::nullopt : std::optional(problem_of_body(added.error()));
}

}  // namespace

Response post_items(const RoutedRequest& request) {
  if (auto refusal = unless_conditional(request)) return *std::move(refusal);
  const auto options = submit_options(request);
  if (!options) return to_response(to_problem(options.error()));
  pipeline::OutcomeKeeper keeper(kMostOutcomes, kMostOutcomeBytes);
  pipeline::Ingestion ingestion(*request.service.store, request.service.workers, *options,
                                [&](pipeline::FeatureOutcome&& feature) -> Status {
                                  if (Metrics* metrics = request.service.metrics) {
                                    metrics->count(feature);
                                  }
                                  keeper.add(std::move(feature));
                                  return Done{};
                                });
  if (const auto problem = read_into(ingestion, request, options->surfaces))
    return to_response(*problem);
  const auto counts = ingestion.finish();
  if (!counts) return to_response(to_problem(counts.error()));
  const auto outcome = std::move(keeper).outcome(*counts, ingestion);
  return ingestion.is_refused() ? refused_document(outcome, "nothing was stored")
                                : answer_of(request, outcome);
}

Response post_validate(const RoutedRequest& request) {
  pipeline::IngestOptions options = ingest_options(request.service, request.is_cancelled);
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
