// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/documents/rules.h"

#include <array>
#include <span>
#include <string>
#include <utility>

#include "pipeline/collections/collection_rules.h"
#include "pipeline/outcome_json.h"
#include "server/items/preconditions.h"

namespace watertight::server {
pipeline::IngestOptions ingest_options(const Service& service, const CancelPoll& is_cancelled) {
  pipeline::IngestOptions options;
  options.threads = service.options.threads_per_request;
  options.certify.limits = service.options.limits;
  options.certify.limits.findings = service.options.largest_findings;
  options.certify.ladder.cancel = is_cancelled;
  options.is_cancelled = is_cancelled;
  return options;
}

Result<formats::Surfaces> stored_surfaces(const Target& target) {
  const std::string* text = target.parameter("surfaces");
  if (text == nullptr || *text == "ignore") return formats::Surfaces::ignore;
  if (*text == "as-solids") return formats::Surfaces::as_solids;
  return Error{ErrorCode::invalid_argument,
               "surfaces is ignore or as-solids where they are stored"};
}

Result<formats::CurvedReading> curved_reading_of(const Target& target) {
  constexpr double kMostChord = 1000;
  formats::CurvedReading reading = pipeline::curved_reading();
  if (const std::string* text = target.parameter("chord")) {
    const Status read = pipeline::read_number("chord", *text, false, kMostChord, reading.chord);
    if (!read) return read.error();
  }
  if (const std::string* text = target.parameter("lattice")) {
    const auto exponent = pipeline::lattice_exponent_of(*text);
    if (!exponent) return exponent.error();
    reading.lattice_exponent = *exponent;
  }
  return reading;
}

Status read_rules(const Target& target, pipeline::IngestOptions& options) {
  for (const std::string_view name : pipeline::kRuleNames) {
    const std::string* value = target.parameter(name);
    if (value == nullptr) continue;
    if (Status read = pipeline::apply_rule(name, *value, options); !read) return read;
  }
  return Done{};
}

namespace {

/// A number that a parameter sets, from `least` to `most`.
struct NumberParameter {
  const char* name;
  double least;
  double most;
  double* number;
};

Status read_numbers(const Target& target, std::span<const NumberParameter> parameters) {
  for (const auto& [name, least, most, number] : parameters) {
    const std::string* text = target.parameter(name);
    if (text == nullptr) continue;
    if (Status read = pipeline::read_number(name, *text, least == 0, most, *number); !read)
      return read;
    if (*number >= least) continue;
    return Error{ErrorCode::invalid_argument,
                 std::string(name) + " is less than " + std::to_string(least)};
  }
  return Done{};
}

Status read_smooth(const Target& target, repair::SmoothOptions& smooth) {
  constexpr double kMostDegrees = 180;
  constexpr double kMostChord = 1000;
  auto rings = static_cast<double>(smooth.collar.rings);
  const std::array<NumberParameter, 5> parameters{
      {{"density", repair::kLeastDensity, repair::kMostDensity, &smooth.density},
       {"regularity", repair::kLeastDensity, repair::kMostDensity, &smooth.regularity},
       {"collar", 1, repair::kMostRings, &rings},
       {"crease", 0, kMostDegrees, &smooth.collar.crease_degrees},
       {"chord", 0, kMostChord, &smooth.chord_metres}}};
  if (Status read = read_numbers(target, parameters); !read) return read;
  smooth.collar.rings = static_cast<int>(rings);
  return Done{};
}

}  // namespace

Status read_remedies(const Target& target, std::string_view list, repair::RepairOptions& options) {
  if (const std::string* names = target.parameter(list)) {
    auto remedies = repair::remedies_of(*names);
    if (!remedies) return std::move(remedies).error();
    options.remedies = *std::move(remedies);
  }
  constexpr double kMostMetres = 1000;
  constexpr double kMostIslands = 5;
  auto islands = static_cast<double>(options.most_islands);
  const std::array<NumberParameter, 2> parameters{
      {{"weld", 0, kMostMetres, &options.weld_metres}, {"islands", 0, kMostIslands, &islands}}};
  if (Status read = read_numbers(target, parameters); !read) return read;
  options.most_islands = static_cast<std::size_t>(islands);
  return read_smooth(target, options.smooth);
}

Status read_submit_rules(const Target& target, pipeline::IngestOptions& options) {
  if (const std::string* named = target.parameter("invalid")) {
    const auto invalid = pipeline::policy_named(*named);
    if (!invalid) return invalid.error();
    options.policy = *invalid;
  }
  if (Status rules = read_rules(target, options); !rules) return rules;
  const auto surfaces = stored_surfaces(target);
  if (!surfaces) return surfaces.error();
  options.surfaces = *surfaces;
  return Done{};
}

Result<pipeline::IngestOptions> submit_options(const RoutedRequest& request) {
  pipeline::IngestOptions options = ingest_options(request.service, request.is_cancelled);
  options.collection = request.target.segments[1];
  const Status own = pipeline::apply_rules_of(*request.service.store, options);
  if (!own) return own.error();
  if (Status rules = read_submit_rules(request.target, options); !rules) {
    return std::move(rules).error();
  }
  if (request.target.parameter("repair") != nullptr) {
    options.repair.emplace();
    const Status remedies = read_remedies(request.target, "repair", *options.repair);
    if (!remedies) return remedies.error();
  } else {
    for (const char* name : {"weld", "islands", "density", "regularity", "collar", "crease"}) {
      if (request.target.parameter(name) == nullptr) continue;
      return Error{ErrorCode::invalid_argument, std::string(name) + " needs remedies in repair="};
    }
  }
  auto condition = write_condition(request.request);
  if (!condition) return std::move(condition).error();
  options.condition = *std::move(condition);
  return options;
}

Result<JudgedSurfaces> judged_surfaces(const Target& target) {
  const std::string* named = target.parameter("surfaces");
  const std::string name = named == nullptr ? "check" : *named;
  const auto rule = pipeline::surface_rule_named(name);
  if (!rule) return rule.error();
  return JudgedSurfaces{*rule, name == "check" ? std::string() : name};
}

Response refused_document(const pipeline::IngestOutcome& outcome, std::string_view consequence) {
  Problem problem;
  problem.status = 422;
  problem.extension = "{\"report\":" + pipeline::outcome_json(outcome) + "}";
  if (outcome.verdict == Verdict::invalid) {
    problem.kind = "invalid-solids";
    problem.detail = "the document has solids that are not valid; ";
    problem.detail += consequence;
  } else {
    problem.kind = "undecided-solids";
    problem.detail = "no engine could decide whether all solids are valid; ";
    problem.detail.append(consequence).append(", trying again can help");
    problem.headers.push_back({"Retry-After", "60"});
  }
  return to_response(problem);
}

}  // namespace watertight::server
