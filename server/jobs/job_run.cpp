// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/jobs/job_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "base/json_text.h"
#include "files/inputs.h"
#include "files/zip_documents.h"
#include "pipeline/collections/collection_header.h"
#include "pipeline/collections/collection_rules.h"
#include "pipeline/outcome_json.h"
#include "pipeline/streaming/ingestion.h"
#include "server/documents/rules.h"
#include "server/metrics/metrics.h"

namespace watertight::server {
namespace {

using Clock = std::chrono::steady_clock;

/// How often a document may be begun: one that ends the process each time must not do so for ever.
constexpr unsigned kMostStarts = 20;

/// The documents in the file of a job.
Result<std::vector<files::InputFile>> documents_of(const Job& job, const std::string& path) {
  if (!files::is_zip(path)) {
    return std::vector<files::InputFile>{
        {job.name, path, job.name, [path] { return files::open_file(path); }}};
  }
  auto documents = files::documents_of_zip(path, job.name.empty() ? "archive" : job.name);
  if (!documents) return std::move(documents).error();
  if (!documents->inputs.empty()) return std::move(documents->inputs);
  return Error{ErrorCode::unsupported, "no document in the archive"};
}

std::string text_for_client(const Error& error) {
  return to_string(Error{error.code, error.message, error.byte_offset, error.pointer});
}

std::string refusal_of(const pipeline::IngestCounts& counts) {
  return std::to_string(counts.invalid + counts.undecided) + " of " + std::to_string(counts.total) +
         " features are not valid, so nothing was stored; the results say why";
}

Error too_many_starts() {
  return {ErrorCode::limit_exceeded, "the service ended while it read this document, " +
                                         std::to_string(kMostStarts) + " times"};
}

/// Whether a document can be stored after an error, at another time.
bool can_go_on(const Error& error) {
  return error.code == ErrorCode::cancelled || error.code == ErrorCode::unavailable;
}

/// The share of a document that is done.
struct DocumentShare {
  std::optional<std::uint64_t> bytes;       // of the document; none if it is compressed
  std::optional<std::uint64_t> file_bytes;  // of the file
  std::optional<std::size_t> features;      // none for a sequence
  std::atomic<std::uint64_t> file_bytes_read = 0;

  double at(std::uint64_t features_done, std::uint64_t bytes_read) const {
    const auto part = [](std::uint64_t done, std::uint64_t all) {
      return all == 0 ? 0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(all));
    };
    if (features) return part(features_done, *features);
    if (bytes) return part(bytes_read, *bytes);
    return file_bytes ? part(file_bytes_read, *file_bytes) : 0;
  }
};

class Run {
 public:
  Run(Job& job, const JobRun& environment, GrowingFile results)
      : job_(job), run_(environment), results_(std::move(results)) {}

  Status all();

 private:
  Result<pipeline::IngestCounts> ingest(const files::InputFile& input);
  Result<pipeline::IngestCounts> store(pipeline::Ingestion& ingestion, files::FoundInput found,
                                       const pipeline::IngestOptions& options);
  Status take(const std::string& document, pipeline::FeatureOutcome&& feature);
  Status write_end(const std::string& document, const Result<pipeline::IngestCounts>& counts);
  void show(std::uint64_t features, std::uint64_t bytes);
  void count(const std::string& document, const Result<pipeline::IngestCounts>& counts);
  Status next(const files::InputFile& input);
  void conclude();

  Job& job_;
  const JobRun& run_;
  GrowingFile results_;
  JobProgress progress_;
  std::uint64_t features_before_ = 0;  // in the documents that this run has done
  const Clock::time_point start_ = Clock::now();
  std::shared_ptr<DocumentShare> share_;
  std::string first_failure_;
};

void Run::show(std::uint64_t features, std::uint64_t bytes) {
  progress_.features = features;
  progress_.all_features = features_before_ + features;
  const double of_document = share_ ? share_->at(features, bytes) : 0;
  progress_.share = (static_cast<double>(job_.documents_done) + of_document) /
                    static_cast<double>(std::max<std::uint64_t>(job_.documents, 1));
  progress_.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  run_.on_progress(progress_);
}

Status Run::take(const std::string& document, pipeline::FeatureOutcome&& feature) {
  if (run_.service.metrics != nullptr) run_.service.metrics->count(feature);
  std::string line = pipeline::feature_line(feature);
  if (job_.documents > 1) {
    std::string named = "{\"document\":";
    named.append(json_string(document)).append(",");
    line.replace(0, 1, named);
  }
  return results_.write(line.append("\n"));
}

/// Writes the line that says what became of a document as a whole.
Status Run::write_end(const std::string& document, const Result<pipeline::IngestCounts>& counts) {
  JsonText json;
  json.open('{').key("document").value(document);
  if (counts) {
    json.key("verdict").value(validate::to_string(counts->verdict));
    json.key("features").value(counts->total).key("stored").value(counts->stored);
    json.key("unprovenFeatures").value(counts->unproven_features);
    if (counts->twins > 0) json.key("duplicates").value(counts->twins);
  } else {
    const Error& error = counts.error();
    json.key("stored").value(0).key("problem").open('{');
    json.key("kind").value(to_string(error.code)).key("detail").value(error.message);
    if (error.byte_offset) json.key("byteOffset").value(*error.byte_offset);
    if (!error.pointer.empty()) json.key("pointer").value(error.pointer);
    json.close('}');
  }
  json.close('}');
  return results_.write(json.take().append("\n"));
}

Result<pipeline::IngestCounts> Run::store(pipeline::Ingestion& ingestion, files::FoundInput found,
                                          const pipeline::IngestOptions& options) {
  const Limits& limits = options.certify.limits;
  if (found.kind == files::InputKind::container) {
    const auto bytes = files::read_all(found.source, limits);
    if (!bytes) return bytes.error();
    const Status added = ingestion.add_container(*bytes, limits, pipeline::WholeModels::split);
    if (!added) return added.error();
    return ingestion.finish();
  }
  formats::ReadOptions read;
  read.limits = limits;
  read.curved = pipeline::curved_reading();
  read.surfaces = options.surfaces;
  const auto header = [&] {
    return pipeline::collection_header(*run_.service.store, options.collection);
  };
  auto opened = files::open_input(std::move(found), read, header);
  if (!opened) return std::move(opened).error();
  share_->features = opened->reader.feature_count();
  if (Status added = ingestion.add(opened->reader); !added) return std::move(added).error();
  return ingestion.finish();
}

Result<pipeline::IngestCounts> Run::ingest(const files::InputFile& input) {
  auto options = job_options(run_.service, job_.target, true, run_.is_cancelled);
  if (!options) return std::move(options).error();
  const std::string stem = std::filesystem::path(input.name).stem().string();
  options->unnamed = stem.empty() ? job_.collection : stem;
  auto file = input.open();
  if (!file) return std::move(file).error();
  share_ = std::make_shared<DocumentShare>();
  share_->file_bytes = file->bytes;
  file->source = [source = std::move(file->source),
                  share = share_](std::span<std::uint8_t> bytes) -> Result<std::size_t> {
    auto count = source(bytes);
    if (count) share->file_bytes_read += *count;
    return count;
  };
  auto found = files::find_input(*std::move(file), input.name);
  if (!found) return std::move(found).error();
  share_->bytes = found->bytes;
  pipeline::Ingestion ingestion(
      *run_.service.store, run_.service.workers, *options,
      [&](pipeline::FeatureOutcome&& feature) { return take(input.name, std::move(feature)); },
      [&](std::uint64_t features, std::uint64_t bytes) { show(features, bytes); });
  return store(ingestion, *std::move(found), *options);
}

/// Sets state and message of a job whose documents are done.
void Run::conclude() {
  const bool is_one = job_.documents == 1;
  job_.state = job_.documents_failed == 0 ? JobState::successful : JobState::failed;
  if (job_.documents_failed > 0 && is_one) {
    job_.message = first_failure_;
    return;
  }
  job_.message = std::to_string(job_.counts.stored) + " of " + std::to_string(job_.counts.total) +
                 " features are stored";
  if (job_.documents_failed > 0) {
    job_.message += "; nothing of " + std::to_string(job_.documents_failed) + " of " +
                    std::to_string(job_.documents) + " documents is, the first: " + first_failure_;
  }
}

/// Counts a document that is done, and remembers why nothing of it was stored.
void Run::count(const std::string& document, const Result<pipeline::IngestCounts>& counts) {
  const bool is_refused = counts && counts->stored == 0 && counts->verdict != Verdict::valid;
  if (counts) {
    job_.counts.add(*counts);
    features_before_ += counts->total;
  }
  if (!counts || is_refused) {
    ++job_.documents_failed;
    const std::string reason = counts ? refusal_of(*counts) : text_for_client(counts.error());
    if (first_failure_.empty()) {
      first_failure_ = job_.documents > 1 ? document + ": " + reason : reason;
    }
  }
  job_.results_bytes = results_.size();
  ++job_.documents_done;
  job_.starts = 0;
}

/// Judges and stores the next document. Errors: those of run_job().
Status Run::next(const files::InputFile& input) {
  ++job_.starts;
  if (Status saved = run_.save(job_); !saved) return saved;
  share_.reset();
  show(0, 0);
  const Result<pipeline::IngestCounts> counts =
      job_.starts > kMostStarts ? Result<pipeline::IngestCounts>(too_many_starts()) : ingest(input);
  if (!counts && can_go_on(counts.error())) {
    --job_.starts;
    return counts.error();
  }
  if (Status written = write_end(input.name, counts); !written) return written;
  if (Status synced = results_.sync(); !synced) return synced;
  count(input.name, counts);
  return run_.save(job_);
}

Status Run::all() {
  const auto inputs = documents_of(job_, run_.folder.document());
  if (!inputs) return inputs.error();
  job_.documents = inputs->size();
  progress_.share_before =
      static_cast<double>(job_.documents_done) / static_cast<double>(job_.documents);
  while (job_.documents_done < job_.documents) {
    if (Status done = next((*inputs)[job_.documents_done]); !done) return done;
  }
  conclude();
  return Done{};
}

}  // namespace

Result<pipeline::IngestOptions> job_options(const Service& service, const std::string& target,
                                            bool reads_collection, const CancelPoll& is_cancelled) {
  const auto parsed = parse_target(target);
  if (!parsed) return parsed.error();
  pipeline::IngestOptions options = ingest_options(service, is_cancelled);
  options.threads = std::max(1U, std::thread::hardware_concurrency());
  const std::string* collection = parsed->parameter("collection");
  if (collection == nullptr) {
    return Error{ErrorCode::invalid_argument, "the parameter collection says where to store"};
  }
  if (Status checked = store::check_collection_id(*collection); !checked) {
    return Error{ErrorCode::invalid_argument, checked.error().message};
  }
  options.collection = *collection;
  if (reads_collection) {
    const Status own = pipeline::apply_rules_of(*service.store, options);
    if (!own) return own.error();
  }
  if (Status rules = read_submit_rules(*parsed, options); !rules) return std::move(rules).error();
  return options;
}

Status run_job(Job& job, const JobRun& run) {
  auto results = GrowingFile::open(run.folder.results(), job.results_bytes);
  if (!results) return std::move(results).error();
  return Run(job, run, *std::move(results)).all();
}

}  // namespace watertight::server
