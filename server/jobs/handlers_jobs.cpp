// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers of jobs: they take files, list, show, end and remove jobs, and give their results.
#include "server/jobs/handlers_jobs.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "base/byte_source.h"
#include "files/files.h"
#include "server/features/links.h"
#include "server/features/pages.h"
#include "server/jobs/job_run.h"
#include "server/jobs/jobs.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

constexpr std::string_view kEventStream = "text/event-stream";
constexpr std::string_view kNdjson = "application/x-ndjson";
constexpr std::size_t kLongestKey = 128;
constexpr std::size_t kLongestName = 255;
constexpr std::uint64_t kUsualJobs = 100;
constexpr std::chrono::seconds kBetweenEvents{1};
constexpr std::size_t kPartBytes = std::size_t{256} << 10U;

Response refuse_without_jobs() {
  return refuse(501, "no-jobs", "this service keeps no jobs: it was started without --jobs-dir");
}

Response no_job(const std::string& id) {
  return refuse(404, "not-found", "there is no job '" + id + "'");
}

/// An event whose data is the status of a job.
std::string event_of(const std::string& status) {
  std::string text = "event: status\ndata: ";
  return text.append(status).append("\n\n");
}

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x21 && c <= 0x7E; });
}

Response job_response(const RoutedRequest& request, unsigned status, const JobView& view) {
  const std::string base = base_url(request);
  Response response{status, std::string(kJson),
                    status_json(view.job, view.progress, base).append("\n")};
  if (status == 201) response.headers.push_back({"Location", base + "/jobs/" + view.job.id});
  return response;
}

/// The job that a request asks for. Errors: invalid_argument.
Result<Job> ordered_job(const RoutedRequest& request, const std::string& owner) {
  const auto options = job_options(request.service, request.request.target, false, {});
  if (!options) return options.error();
  Job job;
  job.target = request.request.target;
  job.collection = options->collection;
  job.owner = owner;
  if (const std::string* name = request.target.parameter("name")) {
    if (name->size() > kLongestName || name->find('/') != std::string::npos) {
      return Error{ErrorCode::invalid_argument,
                   "name is the name of a file without folder, of at most 255 bytes"};
    }
    job.name = *name;
  }
  if (const std::string* key = request.request.header("idempotency-key")) {
    if (key->empty() || key->size() > kLongestKey || !is_printable(*key)) {
      return Error{ErrorCode::invalid_argument,
                   "an Idempotency-Key has 1 to 128 printable ASCII characters"};
    }
    job.idempotency_key = *key;
  }
  return job;
}

/// The answer to a request that was made before; nothing if it is the first one.
std::optional<Response> answer_again(const RoutedRequest& request, const Job& job) {
  if (job.idempotency_key.empty()) return std::nullopt;
  const auto made = request.service.jobs->made_with(job.owner, job.idempotency_key);
  if (!made) return to_response(to_problem(made.error()));
  if (!*made) return std::nullopt;
  if ((*made)->job.target != job.target) {
    return refuse(
        422, "idempotency-key",
        "this Idempotency-Key belongs to a request with other parameters: job " + (*made)->job.id);
  }
  Response response = job_response(request, 200, **made);
  response.headers.push_back({"Location", base_url(request) + "/jobs/" + (*made)->job.id});
  return response;
}

}  // namespace

Admission begin_job(const RoutedRequest& request, const std::string& owner) {
  Admission admission;
  if (request.service.jobs == nullptr) {
    admission.refusal = refuse_without_jobs();
    return admission;
  }
  auto job = ordered_job(request, owner);
  if (!job) {
    admission.refusal = to_response(to_problem(job.error()));
    return admission;
  }
  admission.refusal = answer_again(request, *job);
  if (admission.refusal) return admission;
  auto upload = request.service.jobs->upload(*std::move(job));
  if (upload) {
    admission.sink = *std::move(upload);
    admission.sink_bytes = kLongestJobFile;
  } else {
    admission.refusal = to_response(problem_of_upload(upload.error()));
  }
  return admission;
}

Response post_job(const RoutedRequest& request) {
  auto upload = std::static_pointer_cast<Upload>(request.request.sink);
  if (!upload) {  // the body came in memory
    Admission admission = begin_job(request, "");
    if (admission.refusal) return *std::move(admission.refusal);
    upload = std::static_pointer_cast<Upload>(admission.sink);
    if (auto refusal = upload->take(request.request.body)) return *std::move(refusal);
  }
  const auto accepted = upload->accept();
  return accepted ? job_response(request, 201, *accepted)
                  : to_response(problem_of_upload(accepted.error()));
}

Response get_jobs(const RoutedRequest& request) {
  if (request.service.jobs == nullptr) return refuse_without_jobs();
  const auto form = answer_form(request);
  if (!form) return refuse_forms();
  const auto limit = limit_of_request(request.target, request.service.options, kUsualJobs);
  if (!limit) return to_response(to_problem(limit.error()));
  const std::string* after = request.target.parameter("after");
  const auto views = request.service.jobs->list(*limit, after == nullptr ? "" : *after);
  if (!views) return to_response(to_problem(views.error()));
  const std::string base = base_url(request);
  const std::string start = base + "/jobs?limit=" + std::to_string(*limit);
  Json json{{"jobs", Json::array()}};
  for (const JobView& view : *views) {
    json["jobs"].push_back(Json::parse(status_json(view.job, view.progress, base), nullptr, false));
  }
  json["links"] = Json::array({link(base + "/jobs", "self", kJson, "the jobs, the newest first")});
  if (views->size() == *limit) {
    json["links"].push_back(
        link(start + "&after=" + views->back().job.id, "next", kJson, "older jobs"));
  }
  return *form == AnswerForm::html ? html_response(jobs_page(json)) : json_response(json);
}

Response get_job(const RoutedRequest& request) {
  if (request.service.jobs == nullptr) return refuse_without_jobs();
  const auto form = answer_form(request);
  if (!form) return refuse_forms();
  const auto view = request.service.jobs->find(request.target.segments[1]);
  if (!view) return no_job(request.target.segments[1]);
  if (*form == AnswerForm::json) return job_response(request, 200, *view);
  const std::string status = status_json(view->job, view->progress, base_url(request));
  return html_response(job_page(Json::parse(status, nullptr, false)));
}

Response delete_job(const RoutedRequest& request) {
  if (request.service.jobs == nullptr) return refuse_without_jobs();
  const auto view = request.service.jobs->dismiss(request.target.segments[1]);
  return view ? job_response(request, 200, *view) : to_response(to_problem(view.error()));
}

Response get_job_events(const RoutedRequest& request) {
  Jobs* const jobs = request.service.jobs;
  if (jobs == nullptr) return refuse_without_jobs();
  const std::string id = request.target.segments[1];
  const auto first = jobs->find(id);
  if (!first) return no_job(id);
  const std::string base = base_url(request);
  std::string status = status_json(first->job, first->progress, base);
  Response response{200, std::string(kEventStream), "retry: 3000\n\n" + event_of(status)};
  response.headers.push_back({"Cache-Control", "no-store"});
  if (first->job.is_over()) return response;
  response.pause = kBetweenEvents;
  response.rest = [jobs, id, base, last = std::move(status),
                   is_over = false](const CancelPoll&) mutable -> Result<std::string> {
    const auto view = jobs->find(id);
    if (is_over || !view) return std::string();
    is_over = view->job.is_over();
    std::string now = status_json(view->job, view->progress, base);
    if (now == last) return std::string(": no change\n\n");
    last = std::move(now);
    return event_of(last);
  };
  return response;
}

Response get_job_results(const RoutedRequest& request) {
  if (request.service.jobs == nullptr) return refuse_without_jobs();
  const std::string& id = request.target.segments[1];
  const auto view = request.service.jobs->find(id);
  if (!view) return no_job(id);
  if (!view->job.is_over()) {
    return refuse(404, "result-not-ready",
                  "the job is " + std::string(to_string(view->job.state)) +
                      "; its results are there when it is over");
  }
  const auto file = files::open_file(request.service.jobs->results_path(id));
  Response response{200, std::string(kNdjson), ""};
  if (!file) return response;  // it was over before it began
  response.rest = [source = file->source](const CancelPoll&) -> Result<std::string> {
    std::string part(kPartBytes, '\0');
    const std::span<std::uint8_t> bytes(reinterpret_cast<std::uint8_t*>(part.data()), part.size());
    const auto count = source(bytes);
    if (!count) return count.error();
    part.resize(*count);
    return part;
  };
  return response;
}

}  // namespace watertight::server
