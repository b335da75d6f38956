// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cstdio>
#include <map>

#include "base/json_text.h"
#include "report/explanation.h"
#include "report/feature_report.h"
#include "report/finding_line.h"
#include "report/fingerprint.h"
#include "report/place.h"
#include "report/tally.h"
#include "validate/finding_kinds.h"

namespace watertight::report {
namespace {

/// Errors of the run itself, such as a file that cannot be opened.
constexpr int kOther = 999;

/// A path as a URI reference: bytes other than the unreserved ones of RFC 3986 and the slash are
/// percent-encoded; an absolute path becomes a file URI.
std::string uri_of(std::string_view path) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  constexpr std::string_view kKept = "-._~/";
  std::string uri = path.starts_with('/') ? "file://" : "";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (is_letter || (c >= '0' && c <= '9') || kKept.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      uri.append(1, '%').append(1, kHex[byte >> 4U]).append(1, kHex[byte & 15U]);
    }
  }
  return uri;
}

std::string hex_of(std::uint64_t number) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(number));
  return text.data();
}

void write_text(JsonText& json, std::string_view name, std::string_view text) {
  json.key(name).open('{').key("text").value(text).close('}');
}

void write_rule(JsonText& json, const validate::FindingKind& kind) {
  const auto explanation = explanation_of(kind.code);
  json.open('{').key("id").value(std::to_string(kind.code)).key("name").value(kind.name);
  write_text(json, "shortDescription", kind.summary);
  write_text(json, "fullDescription", explanation ? explanation->meaning : kind.summary);
  std::string help(kind.hint);
  if (explanation) {
    help = "Cause: " + explanation->cause + "\n\nRemedy: " + explanation->remedy;
  }
  write_text(json, "help", help);
  json.key("defaultConfiguration").open('{').key("level");
  json.value(validate::to_string(kind.severity)).close('}');
  json.key("properties").open('{').key("tags").open('[').value("geometry").close(']');
  json.key("isRepairable").value(kind.is_repairable).close('}').close('}');
}

/// A position in a file: a line or a byte offset, as far as one is known.
struct Region {
  std::uint64_t line = 0;  // from 1, 0 for none
  std::optional<std::uint64_t> byte_offset = {};
};

/// Writes physicalLocation.
void write_artifact(JsonText& json, const std::string& uri, const Region& region) {
  json.key("physicalLocation").open('{').key("artifactLocation").open('{');
  json.key("uri").value(uri).close('}');
  if (region.line > 0 || region.byte_offset) {
    json.key("region").open('{');
    if (region.line > 0) {
      json.key("startLine").value(region.line);
    } else {
      json.key("byteOffset").value(*region.byte_offset).key("byteLength").value(0);
    }
    json.close('}');
  }
  json.close('}');
}

/// Writes logicalLocations: the object, and the JSON Pointer of the place where there is one.
void write_logical(JsonText& json, const std::string& object, const std::string& pointer) {
  if (object.empty() && pointer.empty()) return;
  json.key("logicalLocations").open('[').open('{');
  if (!object.empty()) json.key("name").value(object);
  json.key("fullyQualifiedName").value(pointer.empty() ? object : pointer);
  json.key("kind").value("object").close('}').close(']');
}

std::string object_of(const pipeline::InspectedFeature& feature, Index solid) {
  return solid < feature.solids.size() ? feature.solids[solid].source.object_id
                                       : feature.feature.id;
}

class SarifReport final : public FeatureReport {
 public:
  SarifReport(TextSink sink, ReportHead head) : sink_(std::move(sink)), head_(std::move(head)) {}

  Status begin_document(const DocumentHead& document) override {
    file_ = document.file;
    uri_ = uri_of(plain_file_name(document.file));
    return is_open_ ? Status(Done{}) : sink_(opening());
  }

  Status add(const pipeline::ValidatedFeature& feature) override {
    const std::vector<PlacedFinding> findings = findings_of(feature.inspected);
    if (findings.empty()) return Done{};
    const std::vector<IdentifiedFinding> identified = identified_findings(file_, feature.inspected);
    const std::vector<FindingLine> lines = finding_lines(feature.inspected);
    for (std::size_t i = 0; i < findings.size(); ++i) {
      JsonText json;
      begin_result(json, findings[i].finding->code, findings[i].finding->severity, lines[i].text);
      write_places(json, feature, findings[i]);
      json.key("partialFingerprints").open('{').key("watertightFinding/v1");
      json.value(hex_of(identified[i].fingerprint)).close('}');
      write_properties(json, feature.inspected, findings[i]);
      Status status = sink_(separator() + json.close('}').take());
      if (!status) return status;
    }
    return Done{};
  }

  Status add_error(const Error& error) override {
    const int code = code_of(error);
    has_failed_ = has_failed_ || code == kOther;
    JsonText json;
    begin_result(json, code, Severity::error, to_string(error));
    json.key("locations").open('[').open('{');
    write_artifact(json, uri_, {0, error.byte_offset});
    write_logical(json, {}, error.pointer);
    json.close('}').close(']');
    return sink_(separator() + json.close('}').take());
  }

  Status end_document(const DocumentEnd& /*end*/) override { return Done{}; }

  Status finish() override {
    std::string text = is_open_ ? std::string() : opening();
    JsonText json;
    json.open('{').key("executionSuccessful").value(!has_failed_);
    if (!head_.time.empty()) json.key("startTimeUtc").value(head_.time);
    text += "\n],\"invocations\":[" + json.close('}').take() + "]}]}\n";
    return sink_(text);
  }

 private:
  /// The text before the first result: the program and its rules.
  std::string opening() {
    is_open_ = true;
    JsonText json;
    json.open('{').key("$schema").value("https://json.schemastore.org/sarif-2.1.0.json");
    json.key("version").value("2.1.0").key("runs").open('[').open('{');
    json.key("tool").open('{').key("driver").open('{').key("name").value("Watertight");
    json.key("semanticVersion").value(head_.program_version).key("rules").open('[');
    for (const validate::FindingKind& kind : validate::finding_kinds()) {
      rules_.emplace(kind.code, static_cast<int>(rules_.size()));
      write_rule(json, kind);
    }
    rules_.emplace(kOther, static_cast<int>(rules_.size()));
    write_rule(json, {kOther, name_of(kOther), Severity::error,
                      "a file could not be read, and the fault is not in its content",
                      "See the message.", false});
    json.close(']').close('}').close('}');
    json.key("columnKind").value("unicodeCodePoints").key("results").open('[');
    return json.take();
  }

  /// Opens a result and writes its rule, level and message.
  void begin_result(JsonText& json, int code, Severity severity, const std::string& message) const {
    json.open('{').key("ruleId").value(std::to_string(code));
    const auto rule = rules_.find(code);
    if (rule != rules_.end()) json.key("ruleIndex").value(rule->second);
    json.key("level").value(validate::to_string(severity));
    write_text(json, "message", message);
  }

  void write_places(JsonText& json, const pipeline::ValidatedFeature& feature,
                    const PlacedFinding& placed) const {
    const Finding& finding = *placed.finding;
    const Region region{feature.place.line, {}};
    const auto write = [&](Index solid, const Place& place) {
      json.open('{');
      write_artifact(json, uri_, region);
      write_logical(json, object_of(feature.inspected, solid),
                    pointer_of(feature.inspected, solid, place));
      json.close('}');
    };
    json.key("locations").open('[');
    write(placed.solid, finding.place);
    json.close(']');
    if (!finding.other) return;
    json.key("relatedLocations").open('[');
    write(placed.other_solid, *finding.other);
    json.close(']');
  }

  static void write_properties(JsonText& json, const pipeline::InspectedFeature& feature,
                               const PlacedFinding& placed) {
    const Finding& finding = *placed.finding;
    json.key("properties").open('{').key("feature").value(feature.feature.id);
    if (placed.solid < feature.solids.size()) {
      json.key("lod").value(feature.solids[placed.solid].source.lod);
    }
    const auto point = point_of(feature, placed);
    if (point) json.key("coordinates").value(*point);
    if (finding.measured) json.key("measured").value(*finding.measured);
    if (finding.limit) json.key("limit").value(*finding.limit);
    if (!finding.unit.empty()) json.key("unit").value(finding.unit);
    json.key("uncertain").value(finding.uncertain).close('}');
  }

  std::string separator() {
    const std::string text = has_results_ ? ",\n" : "\n";
    has_results_ = true;
    return text;
  }

  TextSink sink_;
  ReportHead head_;
  std::map<int, int> rules_;  // the index of each code's rule
  std::string file_;
  std::string uri_;
  bool is_open_ = false;
  bool has_results_ = false;
  bool has_failed_ = false;
};

}  // namespace

std::unique_ptr<FeatureReport> sarif_report(TextSink sink, ReportHead head) {
  return std::make_unique<SarifReport>(std::move(sink), std::move(head));
}

}  // namespace watertight::report
