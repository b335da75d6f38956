// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers that return the document of the body in another form: POST /convert, /tessellate,
// /repair, /encode, /decode.
#include <array>
#include <optional>

#include "formats/surface.h"
#include "pipeline/container.h"
#include "pipeline/repaired/repair_document.h"
#include "server/documents/report_answer.h"
#include "server/documents/rules.h"
#include "server/documents/submission.h"

namespace watertight::server {
namespace {

struct WrittenFormat {
  std::string_view parameter;  // value of to=
  std::string_view type;
  Format format;
};

constexpr std::array<WrittenFormat, 7> kWritten{
    {{"cityjson", kCityJson, Format::city_json},
     {"cityjsonseq", kCityJsonSeq, Format::city_json_seq},
     {"obj", kObj, Format::obj},
     {"off", "model/vnd.off", Format::off},
     {"wkt", "text/wkt", Format::wkt},
     {"ewkb", "application/ewkb", Format::ewkb},
     {"gml", kGml, Format::gml}}};

/// The most bytes of notes in the header of an answer.
constexpr std::size_t kMostNoteBytes = 4000;

/// The format that a client wants; nothing if there is none such.
std::optional<WrittenFormat> wanted_format(const RoutedRequest& request) {
  if (const std::string* named = request.target.parameter("to")) {
    for (const WrittenFormat& format : kWritten) {
      if (format.parameter == *named) return format;
    }
    return std::nullopt;
  }
  std::vector<std::string_view> offers;
  for (const WrittenFormat& format : kWritten) offers.push_back(format.type);
  const auto chosen = negotiate(request.request.header("accept"), offers);
  return chosen ? std::optional(kWritten[*chosen]) : std::nullopt;
}

Response refuse_written_formats() {
  return refuse(406, "not-acceptable",
                "the document is available as application/city+json (to=cityjson), "
                "application/city+json-seq (to=cityjsonseq), model/obj (to=obj), model/vnd.off "
                "(to=off), text/wkt (to=wkt), application/ewkb (to=ewkb) and application/gml+xml "
                "(to=gml)");
}

/// The document as the client wants it, with the notes of its reader.
Response converted(const Document& document, const WrittenFormat& wanted) {
  const auto bytes = pipeline::convert_document(document, wanted.format);
  if (!bytes) {
    Problem problem = problem_of_body(bytes.error());
    if (bytes.error().code == ErrorCode::not_encodable) problem.status = 422;
    return to_response(problem);
  }
  Response response{200, std::string(wanted.type), std::string(as_text(*bytes)), {}};
  std::string notes;
  for (const std::string& note : document.notes) {
    const std::string text = percent_encode(note);
    if (notes.size() + text.size() > kMostNoteBytes) break;
    notes.append(notes.empty() ? "" : ", ").append(text);
  }
  if (!notes.empty()) response.headers.push_back({"Watertight-Notes", std::move(notes)});
  return response;
}

/// The only document of a Watertight file, or the answer that refuses it.
Result<Document> only_document(const RoutedRequest& request) {
  auto documents =
      pipeline::decode_container(as_bytes(request.request.body), request.service.options.limits);
  if (!documents) return std::move(documents).error();
  if (documents->size() == 1) return std::move(documents->front());
  return Error{ErrorCode::unsupported, "the file has " + std::to_string(documents->size()) +
                                           " documents; `watertight decode` writes each"};
}

/// The kind of report that a client wants to have instead of the document; nothing if it wants the
/// document.
std::optional<ReportForm> wanted_report(const RoutedRequest& request) {
  if (const std::string* named = request.target.parameter("to")) {
    if (*named == "report") return ReportForm::json;
    return *named == "html" ? std::optional(ReportForm::html) : std::nullopt;
  }
  std::vector<std::string_view> offers;
  for (const WrittenFormat& format : kWritten) offers.push_back(format.type);
  offers.push_back(kJson);
  offers.push_back(kHtml);
  const auto chosen = negotiate(request.request.header("accept"), offers);
  if (!chosen || *chosen < kWritten.size()) return std::nullopt;
  return *chosen == kWritten.size() ? ReportForm::json : ReportForm::html;
}

Error cancelled() { return {ErrorCode::cancelled, "the request was cancelled"}; }

/// The answer 422 to a document with solids that no remedy mended.
Response refused_repair(const Response& report) {
  Problem problem;
  problem.status = 422;
  problem.kind = "invalid-solids";
  problem.detail = "the document has solids that the remedies did not make valid";
  problem.extension = "{\"report\":" + report.body + "}";
  return to_response(problem);
}

}  // namespace

Response post_convert(const RoutedRequest& request) {
  const auto wanted = wanted_format(request);
  if (!wanted) return refuse_written_formats();
  const auto surfaces = stored_surfaces(request.target);
  if (!surfaces) return to_response(to_problem(surfaces.error()));
  Conversion conversion = read_conversion(request, wanted->format, *surfaces);
  if (conversion.problem) return to_response(*conversion.problem);
  if (*surfaces == formats::Surfaces::as_solids) {
    const auto turned = formats::turn_surfaces_into_solids(*conversion.document);
    if (!turned) return to_response(problem_of_body(turned.error()));
  }
  return converted(*conversion.document, *wanted);
}

Response post_tessellate(const RoutedRequest& request) {
  const auto report = wanted_report(request);
  const auto wanted = report ? std::optional(kWritten[0]) : wanted_format(request);
  if (!wanted) return refuse_written_formats();
  Conversion conversion = read_conversion(request, wanted->format, formats::Surfaces::ignore);
  if (conversion.problem) return to_response(*conversion.problem);
  if (!report) return converted(*conversion.document, *wanted);
  const pipeline::IngestOptions options = ingest_options(request.service, request.is_cancelled);
  ReportAnswer answer(request.service, *report, options, "ignore");
  auto reader = formats::FeatureReader::of(*std::move(conversion.document));
  const Status judged = answer.judge(reader, "request body");
  if (!judged) return to_response(problem_of_body(judged.error()));
  return std::move(answer).finish();
}

Response post_repair(const RoutedRequest& request) {
  auto report = wanted_report(request);
  const auto wanted = report ? std::optional(kWritten[0]) : wanted_format(request);
  if (!wanted) return refuse_written_formats();
  pipeline::IngestOptions rules = ingest_options(request.service, request.is_cancelled);
  Status read = read_rules(request.target, rules);
  rules.repair.emplace().certify = rules.certify;
  if (read) read = read_remedies(request.target, "remedies", *rules.repair);
  if (!read) return to_response(to_problem(read.error()));
  const std::string* invalid = request.target.parameter("invalid");
  if (invalid != nullptr && *invalid != "keep" && *invalid != "refuse") {
    return refuse(400, "invalid-argument", "invalid is keep or refuse");
  }
  const BodyFormat body = body_format(request);
  if (body.problem) return to_response(*body.problem);
  // A report without a wish for a format is about the document as it comes.
  const Format to = report && body.format == Format::gml ? Format::gml : wanted->format;
  formats::ReadOptions reading;
  reading.limits = request.service.options.limits;
  reading.curved = pipeline::curved_reading();
  const auto threads = static_cast<unsigned>(request.service.options.threads_per_request);
  const auto repaired =
      pipeline::repair_text(as_bytes(request.request.body), body.format, to, reading,
                            request.service.workers, *rules.repair, threads);
  if (request.is_cancelled && request.is_cancelled()) return to_response(to_problem(cancelled()));
  if (!repaired) return to_response(problem_of_body(repaired.error()));
  const auto& [document, outcome] = *repaired;
  const bool is_refused = invalid != nullptr && *invalid == "refuse" && !outcome.is_all_valid();
  if (is_refused) report = ReportForm::json;
  if (!report) return converted(document, *wanted);
  ReportAnswer answer(request.service, *report, rules, "ignore");
  const Status judged = answer.judge_repaired(document, to, outcome);
  if (!judged) return to_response(problem_of_body(judged.error()));
  Response response = std::move(answer).finish();
  return is_refused && response.status == 200 ? refused_repair(response) : response;
}

Response post_encode(const RoutedRequest& request) {
  pipeline::IngestOptions options = ingest_options(request.service, request.is_cancelled);
  const std::string* named = request.target.parameter("invalid");
  const auto policy = pipeline::policy_named(named == nullptr ? "refuse" : *named);
  if (!policy) return to_response(to_problem(policy.error()));
  options.policy = *policy;
  if (Status rules = read_rules(request.target, options); !rules) {
    return to_response(to_problem(rules.error()));
  }
  const auto surfaces = stored_surfaces(request.target);
  if (!surfaces) return to_response(to_problem(surfaces.error()));
  options.surfaces = *surfaces;
  Conversion conversion = read_conversion(request, std::nullopt, *surfaces);
  if (conversion.problem) return to_response(*conversion.problem);
  const auto encoded =
      pipeline::encode_document(*std::move(conversion.document), request.service.workers, options);
  if (!encoded) return to_response(problem_of_body(encoded.error()));
  if (encoded->outcome.verdict != Verdict::valid && *policy == store::Policy::refuse) {
    return refused_document(encoded->outcome, "nothing was encoded");
  }
  const auto file = pipeline::write_container(encoded->document);
  if (!file) return to_response(to_problem(file.error()));
  return Response{200, std::string(kContainer), std::string(as_text(*file)), {}};
}

Response post_decode(const RoutedRequest& request) {
  if (!is_container_body(request)) {
    return refuse(415, "unsupported",
                  "send a Watertight file (application/vnd.watertight); /convert takes documents");
  }
  const Submission memory = container_submission(request);
  if (memory.problem) return to_response(*memory.problem);
  const auto document = only_document(request);
  if (!document) return to_response(problem_of_body(document.error()));
  // Without a wish the document comes as it was, whatever its format.
  const std::string* accept = request.request.header("accept");
  const std::string_view own = media_type_of(document->format);
  if (request.target.parameter("to") == nullptr && negotiate(accept, {own})) {
    return converted(*document, {"", own, document->format});
  }
  const auto wanted = wanted_format(request);
  if (!wanted) return refuse_written_formats();
  if (wanted->format == document->format) return converted(*document, *wanted);
  const auto text = pipeline::convert_document(*document, document->format);
  if (!text) return to_response(problem_of_body(text.error()));
  const auto again = pipeline::read_to_convert(*text, document->format, wanted->format,
                                               {request.service.options.limits});
  if (!again) return to_response(problem_of_body(again.error()));
  return converted(*again, *wanted);
}

}  // namespace watertight::server
