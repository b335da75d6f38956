// SPDX-License-Identifier: GPL-3.0-or-later
//
// The handler that sums up what a collection has: solids and volumes by level of detail, findings
// by code, bytes.
#include <map>
#include <optional>

#include "pipeline/pipeline.h"
#include "pipeline/stored/stored_reports.h"
#include "report/stored_findings.h"
#include "server/items/kept_answer.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

constexpr std::uint64_t kBatch = 100;
constexpr std::uint64_t kBytesOfVertex = 24;     // three doubles
constexpr std::uint64_t kBytesOfRingVertex = 4;  // an index

/// The solids of one level of detail. Volume and area are those of proven solids.
struct LevelCount {
  std::uint64_t solids = 0;
  std::uint64_t proven = 0;
  double volume = 0;
  double area = 0;
};

struct FindingCount {
  std::string name;
  std::string severity;
  std::uint64_t count = 0;
};

/// The sums over the features that were added.
class Statistics {
 public:
  /// Errors: those of unpack() and decode_solids().
  Status add(StoredFeature stored, const Limits& limits) {
    text_bytes_ += stored.skeleton.bytes.size();
    solid_bytes_ += stored.page.size();
    const auto feature =
        pipeline::unpack(std::move(stored), limits, pipeline::Reports::of_unproven);
    if (!feature) return feature.error();
    const auto decoded = pipeline::decode_solids(*feature, limits);
    if (!decoded) return decoded.error();
    auto next = decoded->begin();
    for (const StoredSolid& solid : feature->solids) {
      LevelCount& level = levels_[solid.lod];
      ++level.solids;
      solid_bytes_ += solid.blob.size();
      if (solid.is_proven && next != decoded->end()) add_proven((next++)->solid, level);
    }
    for (report::StoredFinding& finding : report::findings_of(*feature)) {
      FindingCount& found = findings_[finding.code];
      found.name = std::move(finding.name);
      found.severity = std::move(finding.severity);
      ++found.count;
    }
    return Done{};
  }

  /// The members of the answer.
  Json json() const {
    Json json{{"levels", Json::array()}, {"findings", Json::array()}};
    for (const auto& [lod, level] : levels_) {
      json["levels"].push_back({{"lod", lod},
                                {"solids", level.solids},
                                {"proven", level.proven},
                                {"volume", level.volume},
                                {"area", level.area}});
    }
    for (const auto& [code, found] : findings_) {
      json["findings"].push_back({{"code", code},
                                  {"name", found.name},
                                  {"severity", found.severity},
                                  {"count", found.count}});
    }
    json["bytes"] = {{"solids", solid_bytes_}, {"texts", text_bytes_}, {"arrays", array_bytes_}};
    if (solid_bytes_ > 0) {
      json["ratio"] = static_cast<double>(array_bytes_) / static_cast<double>(solid_bytes_);
    }
    return json;
  }

 private:
  void add_proven(const Solid& solid, LevelCount& level) {
    ++level.proven;
    array_bytes_ += kBytesOfVertex * solid.vertex_count();
    for (Index ring = 0; ring < solid.ring_count(); ++ring) {
      array_bytes_ += kBytesOfRingVertex * solid.ring(ring).size();
    }
    const auto measures = pipeline::measures_of(solid);
    if (!measures) return;
    level.volume += measures->volume;
    level.area += measures->area;
  }

  std::map<std::string, LevelCount> levels_;  // by level of detail
  std::map<int, FindingCount> findings_;      // by code
  std::uint64_t solid_bytes_ = 0;             // blobs and pages
  std::uint64_t text_bytes_ = 0;              // packed
  std::uint64_t array_bytes_ = 0;             // of the proven solids as plain arrays
};

/// The statistics of a collection. Reads and decodes all its features. Errors: those of
/// Statistics::add() and of the store; cancelled.
Result<Json> statistics_of(const RoutedRequest& request,
                           const store::StoredCollection& collection) {
  Statistics statistics;
  std::string after;
  do {
    auto batch = request.service.store->walk(collection.id, kBatch, after);
    if (!batch) return std::move(batch).error();
    for (StoredFeature& feature : batch->features) {
      if (request.is_cancelled && request.is_cancelled()) {
        return Error{ErrorCode::cancelled, "the statistics were not finished in time"};
      }
      const Status added = statistics.add(std::move(feature), request.service.options.limits);
      if (!added) return added.error();
    }
    after = std::move(batch->next);
  } while (!after.empty());
  Json json{
      {"collection", collection.id},
      {"features", collection.features},
      {"solids", collection.solids},
      {"unproven", {{"features", collection.unproven_features}, {"solids", collection.unproven}}}};
  json.update(statistics.json());
  return json;
}

}  // namespace

Response get_statistics(const RoutedRequest& request) {
  if (auto refusal = json_only(request)) return *std::move(refusal);
  const auto collection = request.service.store->collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  return kept_or_made(request, *collection, "statistics", kJson, [&]() -> Result<std::string> {
    const auto json = statistics_of(request, *collection);
    if (!json) return json.error();
    return json->dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  });
}

}  // namespace watertight::server
