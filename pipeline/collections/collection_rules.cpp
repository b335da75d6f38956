// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/collections/collection_rules.h"

#include <algorithm>
#include <charconv>

namespace watertight::pipeline {
namespace {

constexpr double kWidestMetres = 1000;
constexpr double kWidestDegrees = 90;

Status read_truth(std::string_view name, std::string_view value, bool& truth) {
  truth = value == "true";
  if (truth || value == "false") return Done{};
  return Error{ErrorCode::invalid_argument, std::string(name).append(" is true or false")};
}

}  // namespace

Status read_number(std::string_view name, std::string_view value, bool can_be_zero, double limit,
                   double& number) {
  double read = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), read);
  const bool is_number = error == std::errc{} && end == value.data() + value.size();
  if (is_number && read <= limit && (read > 0 || (can_be_zero && read == 0))) {
    number = read;
    return Done{};
  }
  std::string message(name);
  message.append(can_be_zero ? " is a number from 0" : " is a number above 0");
  return Error{ErrorCode::invalid_argument,
               message.append(", at most ").append(std::to_string(static_cast<int>(limit)))};
}

Status apply_rule(std::string_view name, std::string_view value, IngestOptions& options) {
  Tolerances& tolerances = options.certify.tolerances;
  if (name == "planarity") {
    return read_number(name, value, false, kWidestMetres, tolerances.planarity_metres);
  }
  if (name == "planarity-angle") {
    return read_number(name, value, false, kWidestDegrees, tolerances.planarity_degrees);
  }
  if (name == "overlap") {
    return read_number(name, value, true, kWidestMetres, options.groups.overlap_metres);
  }
  if (name == "strict") return read_truth(name, value, options.certify.ladder.strict);
  if (name == "exact-overlaps") {
    bool is_exact = false;
    if (Status read = read_truth(name, value, is_exact); !read) return read;
    options.groups.do_steps_warn = !is_exact;
    return Done{};
  }
  if (name != "proof") {
    return Error{ErrorCode::invalid_argument, std::string("'").append(name).append("' is no rule")};
  }
  if (value != "tetrahedralization" && value != "boundary") {
    return Error{ErrorCode::invalid_argument, "proof is tetrahedralization or boundary"};
  }
  options.certify.proof = value == "boundary" ? Proof::boundary : Proof::tetrahedralization;
  return Done{};
}

std::string rules_text(Rules rules) {
  std::sort(rules.begin(), rules.end());
  std::string text;
  for (const auto& [name, value] : rules) text.append(name).append("=").append(value).append("\n");
  return text;
}

Rules rules_in(std::string_view text) {
  Rules rules;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t sign = line.find('=');
    if (sign == std::string_view::npos) continue;
    rules.emplace_back(line.substr(0, sign), line.substr(sign + 1));
  }
  return rules;
}

Status apply_rules(std::string_view text, IngestOptions& options) {
  for (const auto& [name, value] : rules_in(text)) {
    if (Status applied = apply_rule(name, value, options); !applied) return applied;
  }
  return Done{};
}

Status apply_rules_of(SolidStore& store, IngestOptions& options) {
  const auto found = store.collection(options.collection);
  if (found) return apply_rules(found->rules, options);
  return found.error().code == ErrorCode::not_found ? Status(Done{}) : found.error();
}

}  // namespace watertight::pipeline
