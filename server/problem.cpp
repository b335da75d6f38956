// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/problem.h"

#include <nlohmann/json.hpp>

namespace watertight::server {
namespace {

/// The title of a kind: "Not found" for "not-found".
std::string title_of(std::string_view kind) {
  std::string title(kind);
  for (char& c : title) {
    if (c == '-') c = ' ';
  }
  if (!title.empty() && title[0] >= 'a' && title[0] <= 'z') {
    title[0] = static_cast<char>(title[0] - 'a' + 'A');
  }
  return title;
}

unsigned status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::malformed:
    case ErrorCode::invalid_argument:
      return 400;
    case ErrorCode::unsupported:
      return 415;
    case ErrorCode::limit_exceeded:
      return 413;
    case ErrorCode::not_encodable:
      return 422;
    case ErrorCode::not_found:
      return 404;
    case ErrorCode::conflict:
      return 409;
    case ErrorCode::precondition_failed:
      return 412;
    case ErrorCode::cancelled:
    case ErrorCode::unavailable:
      return 503;
  }
  return 500;
}

}  // namespace

Response to_response(const Problem& problem) {
  nlohmann::ordered_json json;
  json["type"] = std::string(kProblemPrefix) + problem.kind;
  json["title"] = title_of(problem.kind);
  json["status"] = problem.status;
  if (!problem.detail.empty()) json["detail"] = problem.detail;
  if (problem.byte_offset) json["byteOffset"] = *problem.byte_offset;
  if (!problem.pointer.empty()) json["pointer"] = problem.pointer;
  if (!problem.extension.empty()) {
    const nlohmann::ordered_json extension =
        nlohmann::ordered_json::parse(problem.extension, nullptr, false);
    if (extension.is_object()) json.update(extension);
  }
  // Details quote the sender's bytes, which need not be UTF-8: wrong bytes are replaced, nothing
  // throws.
  Response response{
      problem.status, "application/problem+json",
      json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n",
      problem.headers};
  response.note = problem.note;
  return response;
}

Problem to_problem(const Error& error) {
  Problem problem;
  problem.status = status_of(error.code);
  problem.kind = std::string(to_string(error.code));
  problem.detail = error.message;
  problem.note = error.detail;
  problem.byte_offset = error.byte_offset;
  problem.pointer = error.pointer;
  if (problem.status == 503) problem.headers.push_back({"Retry-After", "5"});
  return problem;
}

}  // namespace watertight::server
