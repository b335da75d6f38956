// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/metrics/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <map>
#include <string>

namespace watertight::server {
namespace {

using Labels = std::map<std::string, std::string>;

/// The upper limits of the classes of times, seconds.
const prometheus::Histogram::BucketBoundaries kSeconds{0.001, 0.003, 0.01, 0.03, 0.1, 0.3,
                                                       1,     3,     10,   30,   100, 300};

prometheus::Family<prometheus::Counter>& counters(prometheus::Registry& registry, const char* name,
                                                  const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

}  // namespace

class Metrics::Families {
 public:
  prometheus::Registry registry;
  prometheus::Family<prometheus::Counter>& requests =
      counters(registry, "watertight_requests_total",
               "Requests by method, path and status; status 0: the client left early");
  prometheus::Family<prometheus::Histogram>& seconds =
      prometheus::BuildHistogram()
          .Name("watertight_request_seconds")
          .Help("Time from the first byte of a request to the last one of its answer, by path")
          .Register(registry);
  prometheus::Family<prometheus::Counter>& bytes =
      counters(registry, "watertight_answer_bytes_total", "Bytes of the bodies of answers by path");
  prometheus::Family<prometheus::Counter>& solids =
      counters(registry, "watertight_solids_total", "Solids that requests had judged, by verdict");
  prometheus::Family<prometheus::Counter>& proofs =
      counters(registry, "watertight_proofs_total",
               "Solids whose tetrahedralization was accepted, by the rung that made it");
  prometheus::Family<prometheus::Counter>& findings = counters(
      registry, "watertight_findings_total", "Findings that requests were answered, by code");
  prometheus::Family<prometheus::Counter>& jobs =
      counters(registry, "watertight_jobs_total", "Jobs that are over, by state");
  prometheus::Gauge& is_ready = prometheus::BuildGauge()
                                    .Name("watertight_database_ready")
                                    .Help("1 if the database can be used, else 0")
                                    .Register(registry)
                                    .Add({});
};

Metrics::Metrics() : families_(std::make_unique<Families>()) {
  // Those that there can be from the start, so that a rate is right at the first event.
  for (const Verdict verdict : {Verdict::valid, Verdict::invalid, Verdict::undecided}) {
    families_->solids.Add({{"verdict", std::string(validate::to_string(verdict))}});
  }
}

Metrics::~Metrics() = default;

void Metrics::count(const AnsweredRequest& request, std::string_view route) {
  const Labels path{{"path", route.empty() ? "other" : std::string(route)}};
  Labels whole = path;
  whole.emplace("method", route.empty() ? "other" : std::string(request.method));
  whole.emplace("status", std::to_string(request.status));
  families_->requests.Add(whole).Increment();
  families_->bytes.Add(path).Increment(static_cast<double>(request.bytes));
  families_->seconds.Add(path, kSeconds).Observe(request.seconds);
}

void Metrics::count(const Report& report) {
  families_->solids.Add({{"verdict", std::string(validate::to_string(report.verdict))}})
      .Increment();
  if (report.verdict == Verdict::valid) {
    families_->proofs.Add({{"rung", std::string(delaunay::to_string(report.rung))}}).Increment();
  }
  count(report.findings);
}

void Metrics::count(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    families_->findings.Add({{"code", std::to_string(finding.code)}}).Increment();
  }
}

void Metrics::count(const pipeline::FeatureOutcome& feature) {
  for (const pipeline::SolidOutcome& solid : feature.solids) count(solid.report);
  for (const pipeline::InspectedGroup& group : feature.groups) count(group.report.findings);
}

void Metrics::count_job(std::string_view state) {
  families_->jobs.Add({{"status", std::string(state)}}).Increment();
}

std::string Metrics::text(bool is_ready) {
  families_->is_ready.Set(is_ready ? 1 : 0);
  return prometheus::TextSerializer().Serialize(families_->registry.Collect());
}

}  // namespace watertight::server
