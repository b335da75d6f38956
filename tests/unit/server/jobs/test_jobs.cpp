// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/jobs/jobs.h"

#include <unistd.h>

#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/unit/server/client.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_jobs {
namespace {

namespace fs = std::filesystem;
using samples::Json;

/// A service with jobs in a folder of its own.
class Fixture {
 public:
  Fixture() {
    std::string name = (fs::temp_directory_path() / "watertight-jobs-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    folder = name;
    service.store = &store;
    service.metrics = &metrics;
  }
  ~Fixture() {
    jobs.reset();
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  Fixture(const Fixture&) = delete;
  Fixture& operator=(const Fixture&) = delete;

  void start() {
    auto opened = server::Jobs::open(folder.string(), service, [](const std::string&) {});
    REQUIRE(opened);
    jobs = *std::move(opened);
    service.jobs = jobs.get();
  }
  server::Response send(const std::string& method, const std::string& target, std::string body = "",
                        std::vector<server::HeaderField> headers = {}) const {
    const CancelPoll never = [] { return false; };
    return server::respond(service, {method, target, std::move(headers), std::move(body)}, never);
  }
  /// The job that an upload makes.
  std::string post(const std::string& target, std::string body,
                   std::vector<server::HeaderField> headers = {}) const {
    const auto made = send("POST", target, std::move(body), std::move(headers));
    INFO(made.body);
    REQUIRE(made.status == 201);
    return Json::parse(made.body)["jobID"];
  }
  Json status(const std::string& job) const {
    return Json::parse(send("GET", "/jobs/" + job).body);
  }
  Json finished(const std::string& job) const {
    for (int i = 0; i < 2000; ++i) {
      Json json = status(job);
      if (json["status"] != "accepted" && json["status"] != "running") return json;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    FAIL("the job is not over after ten seconds");
    return {};
  }
  /// All of an answer in parts.
  std::string whole(const std::string& target) const {
    const auto answer = send("GET", target);
    REQUIRE(answer.status == 200);
    std::string text = answer.body;
    while (answer.rest) {
      const auto part = answer.rest([] { return false; });
      REQUIRE(part);
      if (part->empty()) break;
      text += *part;
    }
    return text;
  }
  std::vector<Json> results(const std::string& job) const {
    std::istringstream text(whole("/jobs/" + job + "/results"));
    std::vector<Json> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(Json::parse(line));
    return lines;
  }
  /// Writes a job as an earlier process would have left it.
  void leave(const server::Job& job, const std::string& document) const {
    const server::JobFolder place(folder.string(), job.id);
    REQUIRE(place.make());
    REQUIRE(place.save(job));
    std::ofstream(place.document(), std::ios::binary) << document;
  }

  fs::path folder;
  mutable samples::MemoryStore store;
  mutable server::Metrics metrics;
  server::Service service;
  std::unique_ptr<server::Jobs> jobs;
};

server::Job job_of(const std::string& id) {
  server::Job job;
  job.id = id;
  job.target = "/jobs?collection=town&invalid=keep";
  job.collection = "town";
  job.created = 1'000'000'000'125;
  return job;
}

TEST_CASE("a job is read back as it was written") {
  server::Job job = job_of("0001-a");
  job.name = "a \"quoted\" name";
  job.state = server::JobState::failed;
  job.bytes = 1ULL << 40U;
  job.counts.total = 5;
  job.counts.verdict = Verdict::invalid;
  const std::string text = server::text_of(job);
  const auto read = server::read_job(text);
  REQUIRE(read);
  CHECK(server::text_of(*read) == text);
  CHECK(read->state == server::JobState::failed);
  CHECK(read->counts.verdict == Verdict::invalid);
  CHECK(server::text_of(server::Moment{1'000'000'000'125}) == "2001-09-09T01:46:40.125Z");
  for (std::size_t length = 0; length + 1 < text.size(); ++length) {
    CHECK_FALSE(server::read_job(text.substr(0, length)));
  }
  for (const char* wrong : {"{}", "[]", "7", R"({"state": 1})", R"({"state": "asleep"})"}) {
    CHECK_FALSE(server::read_job(wrong));
  }
}

TEST_CASE_METHOD(Fixture, "an uploaded file is stored, with a line for each feature") {
  start();
  const std::string job = post("/jobs?collection=town&name=a.jsonl", samples::kTwo);
  const Json done = finished(job);
  CHECK(done["status"] == "successful");
  CHECK(done["progress"] == 100);
  CHECK(done["counts"]["stored"] == 2);
  CHECK(done["documents"]["done"] == 1);
  CHECK(store.collection("town")->features == 2);
  const auto lines = results(job);
  REQUIRE(lines.size() == 3);
  CHECK(lines[0] == Json{{"line", 2}, {"id", "a"}, {"verdict", "valid"}});
  CHECK(lines[2] == Json{{"document", "a.jsonl"},
                         {"verdict", "valid"},
                         {"features", 2},
                         {"stored", 2},
                         {"unprovenFeatures", 0},
                         {"duplicates", 2}});
  CHECK_FALSE(fs::exists(server::JobFolder(folder.string(), job).document()));
  CHECK(metrics.text(true).find(R"(watertight_jobs_total{status="successful"} 1)") !=
        std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a refused document leaves nothing, and its results say why") {
  start();
  const std::string job = post("/jobs?collection=town", samples::kOneOpen);
  const Json done = finished(job);
  CHECK(done["status"] == "failed");
  CHECK(done["counts"]["invalid"] == 1);
  CHECK_FALSE(store.collection("town"));
  const auto lines = results(job);
  REQUIRE(lines.size() == 3);
  CHECK(lines[1]["solids"][0]["report"]["verdict"] == "invalid");
  CHECK(lines[2]["stored"] == 0);
  const std::string kept = post("/jobs?collection=town&invalid=keep", samples::kOneOpen);
  CHECK(finished(kept)["counts"]["unprovenFeatures"] == 1);
}

TEST_CASE_METHOD(Fixture,
                 "a job goes on in the next process, and an upload that did not end is gone") {
  leave(job_of("0001-a"), samples::kTwo);
  server::Job running = job_of("0002-b");
  running.state = server::JobState::running;
  running.starts = 3;
  leave(running, samples::sequence({samples::feature("c")}));
  const server::JobFolder half(folder.string(), "0003-c");
  REQUIRE(half.make());
  std::ofstream(half.document()) << "half";
  start();
  CHECK(finished("0001-a")["counts"]["stored"] == 2);
  CHECK(finished("0002-b")["counts"]["stored"] == 1);
  CHECK(store.collection("town")->features == 3);
  CHECK_FALSE(fs::exists(folder / "0003-c"));
  CHECK(status("0003-c")["status"] == 404);
}

TEST_CASE_METHOD(Fixture, "a document that ends the process again and again is given up") {
  server::Job job = job_of("0001-a");
  job.state = server::JobState::running;
  job.starts = 20;
  leave(job, samples::kTwo);
  start();
  const Json done = finished("0001-a");
  CHECK(done["status"] == "failed");
  CHECK(done["message"].get<std::string>().find("20 times") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a job waits while the database is away") {
  start();
  store.is_away = true;
  const std::string job = post("/jobs?collection=town", samples::kTwo);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const Json waiting = status(job);
  CHECK(waiting["status"] == "running");
  CHECK(waiting["message"].get<std::string>().ends_with("is tried again"));
  store.is_away = false;
  CHECK(finished(job)["counts"]["stored"] == 2);
}

TEST_CASE_METHOD(Fixture, "a stop interrupts a job, and it is not lost") {
  start();
  store.is_away = true;
  const std::string job = post("/jobs?collection=town", samples::kTwo);
  jobs->stop();
  CHECK(server::JobFolder(folder.string(), job).load()->state == server::JobState::accepted);
  store.is_away = false;
  start();
  CHECK(finished(job)["status"] == "successful");
}

TEST_CASE_METHOD(Fixture, "a job that waits or runs can be ended, and one that is over removed") {
  start();
  store.is_away = true;
  const std::string first = post("/jobs?collection=town", samples::kTwo);
  const std::string second = post("/jobs?collection=town", samples::kTwo);
  CHECK(Json::parse(send("DELETE", "/jobs/" + second).body)["status"] == "dismissed");
  CHECK(whole("/jobs/" + second + "/results").empty());
  CHECK(send("DELETE", "/jobs/" + first).status == 200);
  CHECK(finished(first)["status"] == "dismissed");
  CHECK(send("DELETE", "/jobs/" + first).status == 200);
  CHECK(send("GET", "/jobs/" + first).status == 404);
  CHECK(send("DELETE", "/jobs/" + first).status == 404);
  CHECK_FALSE(fs::exists(folder / first));
  store.is_away = false;
}

TEST_CASE_METHOD(Fixture, "one key makes one job") {
  start();
  const std::vector<server::HeaderField> key{{"idempotency-key", "town-1"}};
  const std::string job = post("/jobs?collection=town", samples::kTwo, key);
  const auto again = send("POST", "/jobs?collection=town", samples::kTwo, key);
  CHECK(again.status == 200);
  CHECK(Json::parse(again.body)["jobID"] == job);
  CHECK(send("POST", "/jobs?collection=other", samples::kTwo, key).status == 422);
  CHECK(send("POST", "/jobs?collection=a", "x", {{"idempotency-key", "a b"}}).status == 400);
  CHECK(send("POST", "/jobs?collection=a", "x", {{"idempotency-key", std::string(129, 'a')}})
            .status == 400);
  server::Job order = job_of("");
  order.idempotency_key = "town-2";
  {
    const auto upload = jobs->upload(order);
    REQUIRE(upload);
    CHECK_FALSE(jobs->upload(order));
    CHECK(send("POST", "/jobs?collection=town", samples::kTwo, {{"idempotency-key", "town-2"}})
              .status == 409);
  }
  CHECK(jobs->upload(order));
}

TEST_CASE_METHOD(Fixture, "wrong orders are refused before anything is kept") {
  start();
  for (const char* target : {"/jobs", "/jobs?collection=", "/jobs?collection=a%2Fb",
                             "/jobs?collection=a&invalid=x", "/jobs?collection=a&planarity=-1",
                             "/jobs?collection=a&name=..%2Fb", "/jobs?collection=a&colour=red"}) {
    INFO(target);
    CHECK(send("POST", target, samples::kTwo).status == 400);
  }
  CHECK(send("POST", "/jobs?collection=a", "").status == 400);
  CHECK(send("GET", "/jobs?after=none").status == 404);
  CHECK(fs::is_empty(folder));
  jobs.reset();
  service.jobs = nullptr;
  for (const char* target : {"/jobs", "/jobs/a", "/jobs/a/results", "/jobs/a/events"}) {
    CHECK(send("GET", target).status == 501);
  }
  CHECK(send("POST", "/jobs?collection=a", "x").status == 501);
}

TEST_CASE_METHOD(Fixture, "a hostile file is refused, and other jobs go on") {
  start();
  const std::string lists(1'000'000, '[');
  const std::string job = post("/jobs?collection=town", "{\"type\":\"CityJSON\",\"x\":" + lists);
  const std::string next = post("/jobs?collection=town", samples::kTwo);
  CHECK(finished(job)["status"] == "failed");
  CHECK(finished(next)["status"] == "successful");
}

TEST_CASE_METHOD(Fixture, "browsers get jobs as pages, with every text escaped") {
  start();
  const std::vector<server::HeaderField> html{{"accept", "text/html"}};
  CHECK(send("GET", "/jobs", "", html).body.find("There is no job") != std::string::npos);
  const std::string job = post("/jobs?collection=town&name=%3Cb%3E", samples::kTwo);
  finished(job);
  const auto list = send("GET", "/jobs", "", html);
  CHECK(list.content_type == "text/html; charset=utf-8");
  CHECK(list.body.find("/jobs/" + job) != std::string::npos);
  const auto page = send("GET", "/jobs/" + job, "", html);
  CHECK(page.body.find("&lt;b&gt;") != std::string::npos);
  CHECK((list.body + page.body).find("<b>") == std::string::npos);
  CHECK(page.body.find("/jobs/" + job + "/results") != std::string::npos);
  CHECK(send("GET", "/jobs", "", {{"accept", "image/png"}}).status == 406);
}

TEST_CASE_METHOD(Fixture, "events tell the status until the job is over") {
  start();
  store.is_away = true;
  const std::string job = post("/jobs?collection=town", samples::kTwo);
  const auto events = send("GET", "/jobs/" + job + "/events");
  CHECK(events.content_type == "text/event-stream");
  CHECK(events.pause.count() > 0);
  CHECK(events.body.starts_with("retry: 3000\n\nevent: status\ndata: {\"jobID\":"));
  REQUIRE(events.rest);
  store.is_away = false;
  finished(job);
  const auto last = events.rest([] { return false; });
  REQUIRE(last);
  CHECK(last->find(R"("status":"successful")") != std::string::npos);
  CHECK(events.rest([] { return false; })->empty());
  CHECK_FALSE(send("GET", "/jobs/" + job + "/events").rest);
}

/// Keeps what it takes, up to a limit.
class Kept final : public server::BodySink {
 public:
  std::optional<server::Response> take(std::string_view piece) override {
    bytes += piece.size();
    ++pieces;
    if (bytes < limit) return std::nullopt;
    return server::Response{507, "text/plain", "full"};
  }
  std::size_t bytes = 0, pieces = 0, limit = 3'000'000;
};

TEST_CASE("a body that goes to a sink can be longer than those in memory") {
  const auto sink = std::make_shared<Kept>();
  server::ServerOptions options;
  options.port = 0;
  options.body_bytes = 1000;
  server::Application application;
  application.lane = [](const server::Request&, std::uint64_t) { return server::Lane::small; };
  application.admit = [&](const server::Request&) {
    server::Admission admission;
    admission.sink = sink;
    admission.sink_bytes = 5'000'000;
    return admission;
  };
  application.respond = [](const server::Request& request, const CancelPoll&) {
    CHECK(request.body.empty());
    const auto& kept = static_cast<const Kept&>(*request.sink);
    return server::Response{200, "text/plain", std::to_string(kept.bytes)};
  };
  const auto started = server::HttpServer::start(options, application, [](const std::string&) {});
  REQUIRE(started);
  const auto send = [&](std::size_t bytes) {
    const Client client((*started)->port());
    client.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(bytes) +
                "\r\n\r\n" + std::string(bytes, 'a'));
    return client.receive_answer();
  };
  CHECK(send(2'000'000).ends_with("\r\n\r\n2000000"));
  CHECK(sink->pieces >= 7);
  CHECK(send(2'000'000).starts_with("HTTP/1.1 507"));  // of the sink
  CHECK(send(5'000'001).starts_with("HTTP/1.1 413"));
  (*started)->stop();
}

}  // namespace
}  // namespace watertight::test_jobs
