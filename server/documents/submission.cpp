// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/documents/submission.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "formats/city_json/city_json.h"
#include "pipeline/collections/collection_header.h"
#include "pipeline/container.h"
#include "server/documents/rules.h"

namespace watertight::server {
namespace {

/// Finds the top-level "type" of a JSON text, and stops as soon as it has seen it.
class TypeFinder : public nlohmann::json_sax<nlohmann::json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool string(string_t& value) override {
    if (depth_ != 1 || !is_type_) return true;
    type_ = value;
    return false;
  }
  bool key(string_t& name) override {
    is_type_ = depth_ == 1 && name == "type";
    return true;
  }
  bool start_object(std::size_t) override { return ++depth_ < kDeepest; }
  bool end_object() override {
    --depth_;
    return depth_ > 0;
  }
  bool start_array(std::size_t) override { return ++depth_ < kDeepest; }
  bool end_array() override {
    --depth_;
    return depth_ > 0;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }
  std::string take() { return std::move(type_); }

 private:
  static constexpr int kDeepest = 64;
  std::string type_;
  int depth_ = 0;
  bool is_type_ = false;
};

struct FormatName {
  std::string_view parameter;  // value of f=
  std::string_view type;       // media type, "" without any
  Format format;
};

constexpr auto kNames = std::to_array<FormatName>({
    {"cityjson", kCityJson, Format::city_json},
    {"json", kJson, Format::city_json},
    {"cityjsonseq", kCityJsonSeq, Format::city_json_seq},
    {"cityjsonseq", "application/x-ndjson", Format::city_json_seq},
    {"obj", kObj, Format::obj},
    {"off", "model/vnd.off", Format::off},
    {"wkt", "text/wkt", Format::wkt},
    {"wkb", "application/wkb", Format::ewkb},
    {"ewkb", "application/ewkb", Format::ewkb},
    {"gml", "application/gml+xml", Format::gml},
    {"gml", "application/xml", Format::gml},
    {"gml", "text/xml", Format::gml},
    {"jsonfg", "application/vnd.ogc.fg+json", Format::json_fg},
    {"jsonfg", "application/geo+json", Format::json_fg},
    {"stl", "model/stl", Format::stl},
    {"ply", "model/x-ply", Format::ply},
    {"poly", "", Format::poly},
    {"ifc", "application/x-step", Format::ifc},
    {"step", "model/step", Format::step},
    {"brep", "application/vnd.watertight.brep+json", Format::brep},
    {"bpt", "", Format::bpt},
});

bool is_allowed(Format format, AcceptedFormats accepted) {
  constexpr std::array kWithIds = {Format::city_json, Format::city_json_seq, Format::gml,
                                   Format::json_fg,   Format::ifc,           Format::step,
                                   Format::brep};
  return accepted == AcceptedFormats::all ||
         std::find(kWithIds.begin(), kWithIds.end(), format) != kWithIds.end();
}

/// The media types of bodies that are taken, with commas between them, and what names formats that
/// have none.
std::string types_of(AcceptedFormats accepted) {
  std::string known;
  std::string without_type;
  for (const FormatName& name : kNames) {
    if (!is_allowed(name.format, accepted)) continue;
    if (name.type.empty()) {
      without_type.append(without_type.empty() ? "" : ", ").append("f=").append(name.parameter);
    } else {
      known.append(known.empty() ? "" : ", ").append(name.type);
    }
  }
  if (accepted == AcceptedFormats::with_ids) known.append(", ").append(kContainer);
  return without_type.empty() ? known
                              : known + "; or name its format in the address: " + without_type;
}

Problem unsupported_type(AcceptedFormats accepted) {
  return Problem{
      415, "unsupported", "send a body of one of these types: " + types_of(accepted), {}, {}, {},
      {}};
}

/// The media type that a request states for its body; "" when it leaves that to the content, as
/// curl does, which calls each body a form unless it is told otherwise.
std::string stated_type(const RoutedRequest& request) {
  const std::string* content_type = request.request.header("content-type");
  std::string type = content_type == nullptr ? "" : media_type(*content_type);
  const bool is_any =
      type == "application/octet-stream" || type == "application/x-www-form-urlencoded";
  return is_any ? "" : type;
}

/// The format of a body; nullopt when f= and Content-Type name no accepted format. Without both,
/// the body's first bytes decide.
std::optional<Format> stated_format(const RoutedRequest& request, AcceptedFormats accepted) {
  const std::string* parameter = request.target.parameter("f");
  const std::string type = stated_type(request);
  for (const FormatName& name : kNames) {
    const bool is_named =
        parameter != nullptr ? name.parameter == *parameter : !type.empty() && name.type == type;
    if (is_named && is_allowed(name.format, accepted)) return name.format;
  }
  if (parameter != nullptr || !type.empty()) return std::nullopt;
  const auto detected = formats::detect_format("", as_bytes(request.request.body));
  if (!detected || !is_allowed(*detected, accepted)) return std::nullopt;
  return *detected;
}

std::string_view first_line(std::string_view text) { return text.substr(0, text.find('\n')); }

/// A sequence sent as JSON: its first line is a whole CityJSON object and more lines follow.
bool is_sequence(std::string_view body) {
  const std::string_view line = first_line(body);
  return line.size() < body.size() && top_level_type(line) == "CityJSON" &&
         body.find_first_not_of(" \t\r\n", line.size()) != std::string_view::npos &&
         nlohmann::json::accept(line);
}

/// The format of a body that is said to have `stated`: JSON can be a sequence, and a sequence a
/// feature alone.
Format format_of_content(Format stated, std::string_view body) {
  if (stated == Format::city_json && is_sequence(body)) return Format::city_json_seq;
  if (stated == Format::city_json_seq && formats::is_lone_feature(body)) return Format::city_json;
  return stated;
}

std::uint64_t longest_line(std::string_view text) {
  std::size_t longest = 0;
  while (!text.empty()) {
    const std::size_t line = first_line(text).size();
    longest = std::max(longest, line);
    text.remove_prefix(std::min(text.size(), line + 1));
  }
  return longest;
}

Result<Document> read_bare_feature(std::string body, const std::string& header,
                                   const formats::ReadOptions& options) {
  if (header.empty()) {
    return Error{ErrorCode::malformed,
                 "a CityJSONFeature needs the transform of its document, and there is no "
                 "collection with one: "
                 "send a CityJSONSeq whose first line is the CityJSON header"};
  }
  return formats::read_lone_feature(std::move(body), header, options);
}

/// A source of the bytes of a text, which must outlive it.
formats::ByteSource source_of(std::string_view text) {
  return [text](std::span<std::uint8_t> bytes) mutable -> Result<std::size_t> {
    const std::size_t count = std::min(text.size(), bytes.size());
    std::copy_n(text.begin(), count, bytes.begin());
    text.remove_prefix(count);
    return count;
  };
}

/// The memory that a document takes while it is read whole, at most, by the bytes of its text. The
/// most that was measured is 36.8, for an attribute that is an array of empty texts; files of
/// cities take 8 to 10.
constexpr std::uint64_t kMemoryOfText = 40;

/// Takes the memory for so many bytes of text that are values at one time. Returns the problem if
/// there is not so much.
std::optional<Problem> take_memory(const RoutedRequest& request, std::uint64_t text_bytes,
                                   std::unique_ptr<BudgetShare>& memory) {
  Budget* budget = request.service.document_memory;
  if (budget == nullptr) return std::nullopt;
  const std::uint64_t bytes = text_bytes * kMemoryOfText;
  const char* advice = "; a CityJSONSeq is read line by line and takes little";
  if (bytes > budget->total()) {
    const std::string most = std::to_string(budget->total() / kMemoryOfText);
    return Problem{413, "limit-exceeded",
                   "a document that is read whole has at most " + most + " bytes" + advice};
  }
  memory = std::make_unique<BudgetShare>(*budget, bytes);
  if (memory->is_granted()) return std::nullopt;
  Problem problem{503, "busy", std::string("too many large documents are being read") + advice};
  problem.headers.push_back({"Retry-After", "5"});
  return problem;
}

Result<formats::FeatureReader> open_body(const RoutedRequest& request, Format format,
                                         const std::string& header, bool is_stored,
                                         const formats::ReadOptions& options) {
  const std::string& body = request.request.body;
  if (format == Format::city_json_seq) {
    return formats::FeatureReader::open(source_of(body), ".jsonl", options);
  }
  const bool needs_header = is_stored && is_bare_feature(request);
  auto document = needs_header ? read_bare_feature(body, header, options)
                               : formats::read_document(as_bytes(body), format, options);
  if (!document) return std::move(document).error();
  return formats::FeatureReader::of(*std::move(document));
}

}  // namespace

std::string top_level_type(std::string_view json) {
  TypeFinder finder;
  nlohmann::json::sax_parse(json.begin(), json.end(), &finder);
  return finder.take();
}

bool is_bare_feature(const RoutedRequest& request) {
  const auto format = stated_format(request, AcceptedFormats::with_ids);
  const std::string& body = request.request.body;
  if (format == Format::city_json_seq) return formats::is_lone_feature(body);
  return format == Format::city_json && top_level_type(body) == "CityJSONFeature";
}

bool is_container_body(const RoutedRequest& request) {
  if (const std::string* parameter = request.target.parameter("f")) return *parameter == "wt";
  const std::string type = stated_type(request);
  if (!type.empty()) return type == kContainer;
  return pipeline::is_container(as_bytes(request.request.body));
}

Submission container_submission(const RoutedRequest& request) {
  const Limits& limits = request.service.options.limits;
  Submission submission;
  submission.problem = take_memory(
      request, std::min(limits.expanded_from(request.request.body.size()), limits.feature_bytes),
      submission.memory);
  return submission;
}

std::string storable_types() { return types_of(AcceptedFormats::with_ids); }

Problem problem_of_body(const Error& error) {
  Problem problem = to_problem(error);
  // An accepted format whose content the reader does not support is the body's fault.
  if (error.code == ErrorCode::unsupported) problem.status = 422;
  return problem;
}

Submission read_submission(const RoutedRequest& request, AcceptedFormats accepted,
                           const std::string& header, formats::Surfaces surfaces) {
  Submission submission;
  auto format = stated_format(request, accepted);
  if (!format) {
    submission.problem = unsupported_type(accepted);
    return submission;
  }
  const std::string& body = request.request.body;
  formats::ReadOptions options;
  options.limits = request.service.options.limits;
  const bool is_stored = accepted == AcceptedFormats::with_ids;
  options.keep_text = is_stored || surfaces != formats::Surfaces::as_solids;
  options.surfaces = surfaces;
  const auto curved = curved_reading_of(request.target);
  if (!curved) {
    submission.problem = to_problem(curved.error());
    return submission;
  }
  options.curved = *curved;
  format = format_of_content(*format, body);
  const bool is_sequence_body = *format == Format::city_json_seq;
  submission.problem =
      take_memory(request, is_sequence_body ? longest_line(body) : body.size(), submission.memory);
  if (submission.problem) return submission;
  auto reader = open_body(request, *format, header, is_stored, options);
  if (reader) {
    submission.reader = *std::move(reader);
  } else {
    submission.problem = problem_of_body(reader.error());
  }
  return submission;
}

std::string_view media_type_of(Format format) {
  for (const FormatName& name : kNames) {
    if (name.format == format && !name.type.empty() && name.type != kJson) return name.type;
  }
  return "application/octet-stream";
}

BodyFormat body_format(const RoutedRequest& request) {
  BodyFormat body;
  const auto stated = stated_format(request, AcceptedFormats::all);
  if (!stated) {
    body.problem = unsupported_type(AcceptedFormats::all);
    return body;
  }
  body.problem = take_memory(request, request.request.body.size(), body.memory);
  if (!body.problem) body.format = format_of_content(*stated, request.request.body);
  return body;
}

Conversion read_conversion(const RoutedRequest& request, std::optional<Format> to,
                           formats::Surfaces surfaces) {
  BodyFormat body = body_format(request);
  Conversion conversion{std::move(body.memory), {}, std::move(body.problem)};
  if (conversion.problem) return conversion;
  formats::ReadOptions options;
  options.limits = request.service.options.limits;
  options.split_features = false;
  options.surfaces = surfaces;
  options.keep_text = !to;
  const auto curved = curved_reading_of(request.target);
  if (!curved) {
    conversion.problem = to_problem(curved.error());
    return conversion;
  }
  options.curved = *curved;
  const ByteView bytes = as_bytes(request.request.body);
  auto document = to ? pipeline::read_to_convert(bytes, body.format, *to, options)
                     : formats::read_document(bytes, body.format, options);
  if (document) {
    conversion.document = *std::move(document);
  } else {
    conversion.problem = problem_of_body(document.error());
  }
  return conversion;
}

Result<std::string> header_for(const RoutedRequest& request) {
  if (!is_bare_feature(request)) return std::string();
  return pipeline::collection_header(*request.service.store, request.target.segments[1]);
}

}  // namespace watertight::server
