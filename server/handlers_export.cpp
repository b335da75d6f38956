// SPDX-License-Identifier: GPL-3.0-or-later
//
// The handler that sends a whole collection as one file, which is made part by part meanwhile.
#include <array>
#include <memory>

#include "pipeline/export.h"
#include "server/handlers.h"

namespace watertight::server {
namespace {

struct FileFormat {
  std::string_view parameter;  // value of f=
  std::string_view type;
  std::string_view ending;
  pipeline::ExportFormat format;
};

constexpr std::array<FileFormat, 2> kFiles{
    {{"wt", kContainer, ".wt", pipeline::ExportFormat::container},
     {"cityjsonseq", kCityJsonSeq, ".city.jsonl", pipeline::ExportFormat::sequence}}};

const FileFormat* chosen_file(const RoutedRequest& request) {
  if (const std::string* wanted = request.target.parameter("f")) {
    for (const FileFormat& file : kFiles) {
      if (file.parameter == *wanted) return &file;
    }
    return nullptr;
  }
  const auto offer = negotiate(request.request.header("accept"), {kFiles[0].type, kFiles[1].type});
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

}  // namespace

Response get_export(const RoutedRequest& request) {
  const FileFormat* file = chosen_file(request);
  if (file == nullptr) {
    return refuse(406, "not-acceptable",
                  "a collection is available as application/vnd.watertight (f=wt) or "
                  "application/city+json-seq (f=cityjsonseq)");
  }
  const std::string& id = request.target.segments[1];
  const auto collection = request.service.store->collection(id);
  if (!collection) return to_response(to_problem(collection.error()));
  auto started = pipeline::CollectionExport::start(*request.service.store, id, file->format);
  if (!started) return refuse_export(started.error());
  const auto exporting = std::make_shared<pipeline::CollectionExport>(*std::move(started));
  // The first part is made before the status is sent, because most errors show there.
  auto first = exporting->next();
  if (!first) return refuse_export(first.error());
  Response response{200, std::string(file->type), std::string(as_text(*first)), {}};
  std::string attachment = "attachment; filename=\"";
  attachment.append(id).append(file->ending) += '"';
  response.headers = {{"Vary", "Accept"},
                      {"Content-Crs", crs_header(collection->srid)},
                      {"Content-Disposition", attachment}};
  if (exporting->is_at_end()) return response;
  response.rest = [exporting]() -> Result<std::string> {
    const auto part = exporting->next();
    if (!part) return part.error();
    return std::string(as_text(*part));
  };
  return response;
}

}  // namespace watertight::server
