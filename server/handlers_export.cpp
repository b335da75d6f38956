// SPDX-License-Identifier: GPL-3.0-or-later
//
// The handler that sends a whole collection as one file, which is made part by part meanwhile.
#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "geopackage/collection_file.h"
#include "pipeline/export.h"
#include "server/export_files.h"
#include "server/features/filters.h"
#include "server/handlers.h"
#include "server/items/preconditions.h"
#include "server/items/ranges.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

struct FileFormat {
  std::string_view parameter;  // value of f=
  std::string_view type;
  std::string_view ending;
  /// Nothing for a GeoPackage, which has to be whole before its first byte can be sent.
  std::optional<pipeline::ExportFormat> format;
};

constexpr std::array<FileFormat, 3> kFiles{
    {{"wt", kContainer, ".wt", pipeline::ExportFormat::container},
     {"cityjsonseq", kCityJsonSeq, ".city.jsonl", pipeline::ExportFormat::sequence},
     {"gpkg", kGeoPackage, ".gpkg", std::nullopt}}};

constexpr std::uint64_t kPiece = 1U << 20U;  // bytes of a kept file that are sent at a time

const FileFormat* chosen_file(const RoutedRequest& request) {
  if (const std::string* wanted = request.target.parameter("f")) {
    for (const FileFormat& file : kFiles) {
      if (file.parameter == *wanted) return &file;
    }
    return nullptr;
  }
  const auto offer =
      negotiate(request.request.header("accept"), {kFiles[0].type, kFiles[1].type, kFiles[2].type});
  return offer ? &kFiles[*offer] : nullptr;
}

Response refuse_export(const Error& error) {
  switch (error.code) {
    case ErrorCode::unsupported:  // the collection exists, but not in this form
      return refuse(406, "not-acceptable", error.message);
    case ErrorCode::malformed:
    case ErrorCode::limit_exceeded:
    case ErrorCode::not_encodable:  // the fault is in the store, not in the request
      return refuse(500, "internal", "the collection cannot be exported: " + error.message);
    default:
      return to_response(to_problem(error));
  }
}

/// The number of a sequence that a request asks for, from 1. Errors: invalid_argument.
Result<std::optional<std::size_t>> part_of_request(const Target& target, const FileFormat& file) {
  const std::string* text = target.parameter("part");
  if (text == nullptr) return std::optional<std::size_t>();
  std::size_t part = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), part);
  if (error != std::errc{} || end != text->data() + text->size() || part == 0) {
    return Error{ErrorCode::invalid_argument, "part is a number from 1"};
  }
  if (file.format != pipeline::ExportFormat::sequence) {
    return Error{ErrorCode::invalid_argument, "only f=cityjsonseq has parts"};
  }
  return std::optional(part);
}

/// A request for an export, apart from the message that stated it, so that another thread can
/// answer it later.
struct ExportRequest {
  Service service;
  const FileFormat* file;
  pipeline::ExportScope scope;
  std::optional<std::size_t> part;  // the number of the sequence, from 1
  std::optional<std::string> lod;   // of a GeoPackage
  std::optional<store::Filter> filter;
  std::string selection;  // selection_name()
  store::StoredCollection collection;
  Request message;

  std::string etag() const {
    std::string representation(file->parameter);
    if (scope == pipeline::ExportScope::proven) representation += "-proven";
    if (scope == pipeline::ExportScope::unproven) representation += "-unproven";
    if (lod) representation += "-lod" + percent_encode(*lod);
    representation += selection;
    if (part) representation += "-part-" + std::to_string(*part);
    return etag_of_state(collection.state, representation);
  }
  std::string key() const { return collection.id + "/" + etag(); }
};

std::vector<HeaderField> headers_of(const ExportRequest& request) {
  std::string attachment = "attachment; filename=\"";
  attachment += request.collection.id;
  if (request.part && *request.part > 1) attachment += "-" + std::to_string(*request.part);
  attachment.append(request.file->ending) += '"';
  return {{"Vary", "Accept"},
          {"ETag", request.etag()},
          {"Accept-Ranges", "bytes"},
          {"Content-Crs", crs_header(request.collection.srid)},
          {"Content-Disposition", attachment}};
}

/// The field that names the members of headers that a sequence cannot keep; none if it keeps all.
std::optional<HeaderField> losses_field(const pipeline::PlannedSequence& sequence) {
  constexpr std::size_t kMostNamed = 50;
  if (sequence.losses.empty()) return std::nullopt;
  std::string value;
  for (std::size_t i = 0; i < std::min(sequence.losses.size(), kMostNamed); ++i) {
    if (i > 0) value += ", ";
    value += percent_encode(sequence.losses[i]);
  }
  if (sequence.losses.size() > kMostNamed) value += ", ...";
  return HeaderField{"Watertight-Losses", std::move(value)};
}

/// The export that answers a request, with the fields that it adds to the answer. The solids of a
/// Watertight file are the blobs that are stored: pages are an eighth smaller, but coding them anew
/// takes nine times as long.
struct StartedExport {
  pipeline::CollectionExport exporting;
  std::vector<HeaderField> headers;
};
using ExportOrRefusal = std::variant<StartedExport, Response>;

/// The answer for a collection that needs several sequences when the request names none.
Response refuse_parts(const ExportRequest& request, const pipeline::SequencePlan& plan) {
  Problem problem;
  problem.status = 406;
  problem.kind = "not-acceptable";
  problem.detail = "the collection needs " + std::to_string(plan.sequences().size()) +
                   " sequences, as its documents have different headers; ask for each with part=N, "
                   "or for all in a Watertight file (f=wt)";
  Json parts = Json::array();
  const std::string path = "/collections/" + percent_encode(request.collection.id) +
                           "/export?f=cityjsonseq" +
                           (request.scope == pipeline::ExportScope::proven ? "&proven=true" : "");
  for (std::size_t i = 0; i < plan.sequences().size(); ++i) {
    const pipeline::PlannedSequence& sequence = plan.sequences()[i];
    Json part{{"href", path + "&part=" + std::to_string(i + 1)}, {"headers", sequence.headers}};
    if (!sequence.reason.empty()) part["reason"] = sequence.reason;
    if (!sequence.losses.empty()) part["losses"] = sequence.losses;
    parts.push_back(std::move(part));
  }
  problem.extension = Json{{"parts", std::move(parts)}}.dump();
  return to_response(problem);
}

ExportOrRefusal start_sequence(const ExportRequest& request, const CancelPoll& is_cancelled) {
  SolidStore& store = *request.service.store;
  auto made = pipeline::SequencePlan::make(store, request.collection.id, is_cancelled);
  if (!made) return refuse_export(made.error());
  const auto plan = std::make_shared<const pipeline::SequencePlan>(*std::move(made));
  if (!request.part && plan->sequences().size() > 1) return refuse_parts(request, *plan);
  const std::size_t number = request.part.value_or(1) - 1;
  auto started = pipeline::CollectionExport::start_sequence(store, request.collection.id, plan,
                                                            number, request.scope, request.filter);
  if (!started) return refuse_export(started.error());
  StartedExport exporting{*std::move(started), {}};
  auto losses = losses_field(plan->sequences()[number]);
  if (losses) exporting.headers.push_back(*std::move(losses));
  return exporting;
}

ExportOrRefusal export_for(const ExportRequest& request, const CancelPoll& is_cancelled) {
  if (request.file->format == pipeline::ExportFormat::sequence) {
    return start_sequence(request, is_cancelled);
  }
  auto started = pipeline::CollectionExport::start(
      *request.service.store, request.collection.id, *request.file->format,
      {.layout = pipeline::SolidLayout::blobs}, request.scope, request.filter);
  if (!started) return refuse_export(started.error());
  return StartedExport{*std::move(started), {}};
}

/// Sends the file while it is made.
Response streamed(const ExportRequest& request, const CancelPoll& is_cancelled) {
  auto started = export_for(request, is_cancelled);
  if (auto* refusal = std::get_if<Response>(&started)) return std::move(*refusal);
  auto& [made, headers] = std::get<StartedExport>(started);
  const auto exporting = std::make_shared<pipeline::CollectionExport>(std::move(made));
  // The first part is made before the status is sent, because most errors show there.
  auto first = exporting->next(is_cancelled);
  if (!first) return refuse_export(first.error());
  Response response{200, std::string(request.file->type), std::string(as_text(*first)),
                    headers_of(request)};
  for (HeaderField& field : headers) response.headers.push_back(std::move(field));
  if (exporting->is_at_end()) return response;
  response.rest = [exporting](const CancelPoll& is_unwanted) -> Result<std::string> {
    const auto part = exporting->next(is_unwanted);
    if (!part) return part.error();
    return std::string(as_text(*part));
  };
  return response;
}

/// Makes the bytes of an export as a file. Errors: unsupported when there is no such file, which
/// streamed() explains; limit_exceeded when there are too many bytes of such files; those of
/// CollectionExport::next() and geopackage::collection_file().
Result<TemporaryFile> make_file(const ExportRequest& request, const CancelPoll& is_cancelled) {
  ExportFiles& files = *request.service.export_files;
  const auto has_room = [&](std::uint64_t bytes) { return files.make_room(bytes); };
  if (!request.file->format) {
    auto made = geopackage::collection_file(*request.service.store, request.collection.id,
                                            {request.scope, request.filter, request.lod},
                                            is_cancelled, has_room);
    if (!made) return std::move(made).error();
    return std::move(made->file);
  }
  auto started = export_for(request, is_cancelled);
  if (!std::holds_alternative<StartedExport>(started)) {
    return Error{ErrorCode::unsupported, "there is no such file"};
  }
  pipeline::CollectionExport* const exporting = &std::get<StartedExport>(started).exporting;
  auto file = TemporaryFile::make();
  if (!file) return file;
  while (!exporting->is_at_end()) {
    const auto part = exporting->next(is_cancelled);
    if (!part) return part.error();
    if (!has_room(file->size() + part->size())) {
      return Error{ErrorCode::limit_exceeded, "no room for the file of the export"};
    }
    if (Status added = file->append(*part); !added) return std::move(added).error();
  }
  return file;
}

/// Makes the whole file, whose length has to be known for ranges. Errors: those of make_file();
/// unavailable when the collection changes meanwhile.
Result<ExportFiles::File> whole_file(const ExportRequest& request, const CancelPoll& is_cancelled) {
  auto file = make_file(request, is_cancelled);
  if (!file) return std::move(file).error();
  const auto after = request.service.store->collection(request.collection.id);
  if (!after) return after.error();
  if (after->state != request.collection.state) {
    return Error{ErrorCode::unavailable, "the collection changed while its file was made"};
  }
  return request.service.export_files->keep(request.key(), *std::move(file));
}

/// The file, or the range of it that the request wants, read piece by piece while it is sent.
Response part_of(const ExportFiles::File& file, const ExportRequest& request) {
  const WantedRange wanted = wanted_range(request.message, request.etag(), file->size());
  if (wanted.kind == WantedRange::Kind::unsatisfiable) return beyond(file->size());
  const bool is_part = wanted.kind == WantedRange::Kind::part;
  Response response{is_part ? 206U : 200U, std::string(request.file->type), "",
                    headers_of(request)};
  if (is_part) response.headers.push_back(content_range(wanted.part, file->size()));
  const std::uint64_t first = is_part ? wanted.part.first : 0;
  const std::uint64_t end = is_part ? wanted.part.last + 1 : file->size();
  response.rest = [file, next = first, end](const CancelPoll&) mutable -> Result<std::string> {
    const auto count = static_cast<std::size_t>(std::min(kPiece, end - next));
    const auto bytes = file->read(next, count);
    if (!bytes) return bytes.error();
    next += count;
    return std::string(as_text(*bytes));
  };
  return response;
}

/// The answer where there is no file: a service may ignore a range (RFC 9110, section 14.2).
Response without_file(const ExportRequest& request, const Error& error,
                      const CancelPoll& is_cancelled) {
  const bool is_possible = request.file->format.has_value();
  if (is_possible &&
      (error.code == ErrorCode::limit_exceeded || error.code == ErrorCode::unsupported)) {
    return streamed(request, is_cancelled);
  }
  if (error.code == ErrorCode::limit_exceeded) {
    return refuse(413, "limit-exceeded",
                  "the GeoPackage has more bytes than the service keeps in files; `watertight "
                  "export` writes it");
  }
  return refuse_export(error);
}

/// Answers from a kept file, or by work that makes and keeps the file.
Response from_file(const ExportRequest& request) {
  ExportFiles* const files = request.service.export_files;
  if (auto file = files->find(request.key())) return part_of(file, request);
  Response response;
  response.further = std::make_shared<const FurtherWork>(FurtherWork{
      Lane::computing, request.key(), [request, files](const CancelPoll& is_cancelled) {
        // A request for the same file may have made it meanwhile.
        if (auto file = files->find(request.key())) return part_of(file, request);
        const auto made = whole_file(request, is_cancelled);
        return made ? part_of(*made, request) : without_file(request, made.error(), is_cancelled);
      }});
  return response;
}

}  // namespace

Response get_export(const RoutedRequest& request) {
  const FileFormat* file = chosen_file(request);
  if (file == nullptr) {
    return refuse(406, "not-acceptable",
                  "a collection is available as application/vnd.watertight (f=wt), "
                  "application/city+json-seq (f=cityjsonseq) or application/geopackage+sqlite3 "
                  "(f=gpkg)");
  }
  const auto is_proven = proof_of_request(request.target);
  if (!is_proven) return to_response(to_problem(is_proven.error()));
  auto scope = pipeline::ExportScope::all;
  if (*is_proven) {
    scope = **is_proven ? pipeline::ExportScope::proven : pipeline::ExportScope::unproven;
  }
  const auto part = part_of_request(request.target, *file);
  if (!part) return to_response(to_problem(part.error()));
  std::optional<std::string> lod;
  if (const std::string* wanted = request.target.parameter("lod")) lod = *wanted;
  if (lod && file->format) {
    return refuse(400, "invalid-argument", "only f=gpkg has one level of detail (lod)");
  }
  auto collection = request.service.store->collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  auto filter = selection_of_request(request.target, *collection);
  if (!filter) return to_response(to_problem(filter.error()));
  const ExportRequest wanted{request.service,
                             file,
                             scope,
                             *part,
                             std::move(lod),
                             *std::move(filter),
                             selection_name(request.target),
                             *std::move(collection),
                             request.request};
  auto unneeded = unless_needed(request.request, wanted.etag());
  if (unneeded) return *std::move(unneeded);
  // With a size of "all that there are", any range that is understood is a part.
  const auto range = wanted_range(request.request, wanted.etag(), UINT64_MAX);
  const bool has_range = range.kind == WantedRange::Kind::part;
  const bool can_keep = request.service.export_files != nullptr;
  if (!file->format && !can_keep) {
    return refuse(503, "unavailable", "the service keeps no files");
  }
  return can_keep && (has_range || !file->format) ? from_file(wanted)
                                                  : streamed(wanted, request.is_cancelled);
}

}  // namespace watertight::server
