// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/jobs/job.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "server/json_answers.h"

namespace watertight::server {
namespace {

constexpr std::array<std::string_view, 5> kStates = {"accepted", "running", "successful", "failed",
                                                     "dismissed"};
constexpr int kThousand = 1000;

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json counts_json(const pipeline::IngestCounts& counts) {
  return {{"features", counts.total},
          {"valid", counts.total - counts.invalid - counts.undecided},
          {"invalid", counts.invalid},
          {"undecided", counts.undecided},
          {"stored", counts.stored},
          {"unprovenFeatures", counts.unproven_features},
          {"unprovenSolids", counts.unproven},
          {"duplicates", counts.twins}};
}

/// Reads members of the text of a job, and remembers whether one was missing or of another type.
class MemberReader {
 public:
  explicit MemberReader(const Json& json) : json_(json) {}
  void read(const char* name, std::string& value) {
    const auto found = json_.find(name);
    is_wrong_ |= found == json_.end() || !found->is_string();
    if (!is_wrong_) value = found->get<std::string>();
  }
  template <class Integer>
  void read(const char* name, Integer& value) {
    const auto found = json_.find(name);
    is_wrong_ |= found == json_.end() || !found->is_number_integer();
    if (!is_wrong_) value = found->get<Integer>();
  }
  bool is_wrong() const { return is_wrong_; }

 private:
  const Json& json_;
  bool is_wrong_ = false;
};

/// Calls `member(name, reference)` for each member of a job that is kept as it is.
template <class AnyJob, class Member>
void for_each_member(AnyJob& job, const Member& member) {
  member("id", job.id);
  member("target", job.target);
  member("collection", job.collection);
  member("name", job.name);
  member("idempotencyKey", job.idempotency_key);
  member("owner", job.owner);
  member("bytes", job.bytes);
  member("message", job.message);
  member("created", job.created);
  member("started", job.started);
  member("finished", job.finished);
  member("documents", job.documents);
  member("documentsDone", job.documents_done);
  member("documentsFailed", job.documents_failed);
  member("starts", job.starts);
  member("resultsBytes", job.results_bytes);
  member("features", job.counts.total);
  member("invalid", job.counts.invalid);
  member("undecided", job.counts.undecided);
  member("stored", job.counts.stored);
  member("unprovenFeatures", job.counts.unproven_features);
  member("unprovenSolids", job.counts.unproven);
}

/// Rate and time left of a running job.
void add_speed(Json& json, const JobProgress& progress) {
  if (progress.seconds <= 0) return;
  const double rate = static_cast<double>(progress.all_features) / progress.seconds;
  json["featuresPerSecond"] = std::round(rate);
  const double done = progress.share - progress.share_before;
  if (done <= 0) return;
  json["secondsLeft"] = std::ceil(progress.seconds * (1 - progress.share) / done);
}

}  // namespace

std::string_view to_string(JobState state) { return kStates[static_cast<std::size_t>(state)]; }

Moment now() {
  using std::chrono::milliseconds;
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<milliseconds>(since).count();
}

std::string text_of(Moment moment) {
  const std::time_t whole = moment / kThousand;
  std::tm utc{};
  gmtime_r(&whole, &utc);
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", utc.tm_year + 1900,
                utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec,
                static_cast<int>(moment % kThousand));
  return text.data();
}

std::string text_of(const Job& job) {
  Json json;
  json["state"] = to_string(job.state);
  for_each_member(job, [&](const char* name, const auto& value) { json[name] = value; });
  json["verdict"] = static_cast<int>(job.counts.verdict);
  json["duplicates"] = job.counts.twins;
  return dumped(json) + "\n";
}

Result<Job> read_job(const std::string& text) {
  const Error wrong{ErrorCode::malformed, "not the text of a job"};
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return wrong;
  Job job;
  MemberReader reader(json);
  for_each_member(job, [&](const char* name, auto& value) { reader.read(name, value); });
  std::string state;
  reader.read("state", state);
  int verdict = 0;
  reader.read("verdict", verdict);
  const auto* const found = std::find(kStates.begin(), kStates.end(), state);
  if (reader.is_wrong() || found == kStates.end()) return wrong;
  if (verdict < 0 || verdict > static_cast<int>(Verdict::undecided)) return wrong;
  // Older programs did not count them.
  const auto twins = json.find("duplicates");
  if (twins != json.end() && twins->is_number_unsigned()) job.counts.twins = *twins;
  job.state = static_cast<JobState>(found - kStates.begin());
  job.counts.verdict = static_cast<Verdict>(verdict);
  return job;
}

std::string status_json(const Job& job, const JobProgress& progress, const std::string& base) {
  constexpr double kPercent = 100;
  const std::string self = base + "/jobs/" + job.id;
  Json json{{"jobID", job.id}, {"processID", "ingest"}, {"type", "process"}};
  json["status"] = to_string(job.state);
  json["message"] = job.message;
  json["created"] = text_of(job.created);
  if (job.started > 0) json["started"] = text_of(job.started);
  if (job.finished > 0) json["finished"] = text_of(job.finished);
  const bool is_running = job.state == JobState::running;
  const double share = is_running ? progress.share : 0;
  json["progress"] =
      job.state == JobState::successful ? 100 : static_cast<int>(std::floor(share * kPercent));
  json["collection"] = job.collection;
  if (!job.name.empty()) json["name"] = job.name;
  json["bytes"] = job.bytes;
  json["documents"] = {
      {"all", job.documents}, {"done", job.documents_done}, {"failed", job.documents_failed}};
  json["counts"] = counts_json(job.counts);
  if (is_running) {
    json["featuresJudged"] = job.counts.total + progress.features;
    add_speed(json, progress);
  }
  json["links"] = Json::array(
      {link(self, "self", kJson, "this job"), link(self + "/events", "monitor", "text/event-stream",
                                                   "this job, again whenever it changes")});
  if (job.is_over()) {
    json["links"].push_back(link(self + "/results",
                                 "http://www.opengis.net/def/rel/ogc/1.0/results",
                                 "application/x-ndjson", "a line for each feature"));
  }
  json["links"].push_back(link(base + "/collections/" + percent_encode(job.collection), "related",
                               kJson, "the collection"));
  return dumped(json);
}

}  // namespace watertight::server
