// SPDX-License-Identifier: GPL-3.0-or-later
//
// The handler that judges the features of a collection again, and reports.
#include <memory>
#include <optional>

#include "base/checksum.h"
#include "pipeline/export.h"
#include "server/documents/report_answer.h"
#include "server/documents/rules.h"
#include "server/documents/submission.h"
#include "server/features/filters.h"
#include "server/items/preconditions.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

/// The bytes of an export, which must outlive the source.
ByteSource source_of_export(pipeline::CollectionExport& exported, const CancelPoll& is_cancelled) {
  return [&exported, &is_cancelled, part = Bytes(),
          at = std::size_t{0}](std::span<std::uint8_t> bytes) mutable -> Result<std::size_t> {
    while (at == part.size() && !exported.is_at_end()) {
      auto next = exported.next(is_cancelled);
      if (!next) return std::move(next).error();
      part = *std::move(next);
      at = 0;
    }
    const std::size_t count = std::min(bytes.size(), part.size() - at);
    std::copy_n(part.begin() + static_cast<std::ptrdiff_t>(at), count, bytes.begin());
    at += count;
    return count;
  };
}

/// The kind of report that a request wants; nothing if there is none such.
std::optional<ReportForm> wanted_kind(const RoutedRequest& request) {
  const std::string* named = request.target.parameter("f");
  return named != nullptr ? report_kind_named(*named)
                          : report_kind(request.request.header("accept"));
}

Result<pipeline::ExportScope> wanted_scope(const Target& target) {
  const auto proven = proof_of_request(target);
  if (!proven) return proven.error();
  if (!*proven) return pipeline::ExportScope::all;
  return **proven ? pipeline::ExportScope::proven : pipeline::ExportScope::unproven;
}

/// Judges the features of one sequence of a collection.
Status judge_sequence(const RoutedRequest& request, pipeline::CollectionExport sequence,
                      formats::Surfaces surfaces, ReportAnswer& answer) {
  formats::ReadOptions reading;
  reading.limits = request.service.options.limits;
  reading.keep_text = surfaces != formats::Surfaces::as_solids;
  reading.surfaces = surfaces;
  auto reader = formats::FeatureReader::open(source_of_export(sequence, request.is_cancelled),
                                             ".jsonl", reading);
  if (!reader) return std::move(reader).error();
  return answer.judge(*reader, request.target.segments[1]);
}

}  // namespace

Response get_report(const RoutedRequest& request) {
  pipeline::IngestOptions options = ingest_options(request.service, request.is_cancelled);
  if (Status rules = read_rules(request.target, options); !rules) {
    return to_response(to_problem(rules.error()));
  }
  const auto kind = wanted_kind(request);
  if (!kind) return refuse_report_kinds();
  const auto surfaces = judged_surfaces(request.target);
  if (!surfaces) return to_response(to_problem(surfaces.error()));
  options.certify.severity_of_surfaces = surfaces->severity;
  const auto scope = wanted_scope(request.target);
  if (!scope) return to_response(to_problem(scope.error()));
  SolidStore& store = *request.service.store;
  const auto collection = store.collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  const auto filter = selection_of_request(request.target, *collection);
  if (!filter) return to_response(to_problem(filter.error()));
  std::string form(name_of(*kind));
  form.append("-").append(std::to_string(content_hash(as_bytes(request.request.target))));
  const std::string etag = etag_of_state(collection->state, form);
  if (auto unneeded = unless_needed(request.request, etag)) return *std::move(unneeded);
  auto made = pipeline::SequencePlan::make(store, collection->id);
  if (!made) return to_response(to_problem(made.error()));
  const auto plan = std::make_shared<const pipeline::SequencePlan>(*std::move(made));
  ReportAnswer answer(request.service, *kind, options, surfaces->name);
  for (std::size_t i = 0; i < plan->sequences().size(); ++i) {
    auto sequence =
        pipeline::CollectionExport::start_sequence(store, collection->id, plan, i, *scope, *filter);
    if (!sequence) return to_response(to_problem(sequence.error()));
    const Status judged = judge_sequence(request, *std::move(sequence), surfaces->reading, answer);
    if (!judged) return to_response(to_problem(judged.error()));
  }
  Response response = std::move(answer).finish();
  response.headers.push_back({"ETag", etag});
  response.headers.push_back({"Vary", "Accept"});
  return response;
}

}  // namespace watertight::server
