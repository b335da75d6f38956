// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/validate_stream.h"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "geometry/parallel.h"
#include "pipeline/instances.h"

namespace watertight::pipeline {
namespace {

/// The most features between reading and handing on, per thread: enough that a slow feature does
/// not hold up the others for long.
constexpr std::uint64_t kFeaturesInFlight = 32;
/// The most bytes of lines between reading and handing on; more only when one line is longer.
constexpr std::uint64_t kBytesInFlight = std::uint64_t{32} << 20U;

/// A feature between reader and sink: it gets a number, then is validated or found unreadable.
struct Passage {
  std::uint64_t bytes = 0;
  std::optional<ValidatedFeature> feature;
  std::optional<Error> error;
};

/// If the document is a single feature, all threads help within it.
CertifyOptions certify_options(const formats::FeatureReader& reader, const StreamOptions& options) {
  CertifyOptions certify = options.certify;
  if (reader.feature_count() == std::size_t{1}) {
    certify.threads = static_cast<unsigned>(std::clamp<std::size_t>(options.threads, 1, 256));
  }
  return certify;
}

class Stream {
 public:
  Stream(formats::FeatureReader& reader, delaunay::EngineWorkers* workers,
         const StreamOptions& options, const FeatureSink& on_feature, const ErrorSink& on_error)
      : reader_(reader),
        workers_(workers),
        options_(options),
        certify_(certify_options(reader, options)),
        on_feature_(on_feature),
        on_error_(on_error),
        templates_(reader.document().templates, workers, certify_,
                   group_options(options.groups, certify_)) {}

  Result<StreamOutcome> run() {
    const std::size_t threads = std::max<std::size_t>(options_.threads, 1);
    most_in_flight_ = kFeaturesInFlight * threads;
    geometry::for_each_piece(threads, static_cast<unsigned>(threads),
                             [this](std::size_t, bool) { work(); });
    if (!failure_) add_templates();
    if (failure_) return *std::move(failure_);
    return outcome_;
  }

 private:
  struct Found {
    std::uint64_t number = 0;
    formats::FeatureText text;
  };

  /// The work of every thread until the document ends.
  void work() {
    try {
      for (auto found = take_next(); found; found = take_next()) {
        put_back(found->number, validate(std::move(*found)));
      }
    } catch (...) {
      stop(Error{ErrorCode::unavailable, "a thread failed"});
      throw;
    }
  }

  std::optional<Found> take_next();
  Passage validate(Found found);
  void put_back(std::uint64_t number, Passage passage);
  void hand_on_in_order(std::unique_lock<std::mutex>& lock);
  Status hand_on(Passage passage);
  void add_templates();
  void stop(Error error);
  bool has_room() const {
    return passages_.empty() || (taken_ - handed_on_ < most_in_flight_ && bytes_ < kBytesInFlight);
  }

  formats::FeatureReader& reader_;
  delaunay::EngineWorkers* workers_;
  const StreamOptions& options_;
  const CertifyOptions certify_;
  const FeatureSink& on_feature_;
  const ErrorSink& on_error_;
  std::uint64_t most_in_flight_ = 0;
  TemplateInspector templates_;

  std::mutex mutex_;  // guards the members below, and reader_.next()
  std::condition_variable room_;
  std::map<std::uint64_t, Passage> passages_;  // in flight; a passage is empty while validated
  std::uint64_t taken_ = 0;
  std::uint64_t handed_on_ = 0;
  std::uint64_t bytes_ = 0;  // bytes of the lines in flight
  bool is_handing_on_ = false;
  bool is_over_ = false;  // no more features are taken
  std::optional<Error> failure_;
  StreamOutcome outcome_;
};

std::optional<Stream::Found> Stream::take_next() {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return is_over_ || has_room(); });
  if (is_over_) return std::nullopt;
  if (options_.is_cancelled && options_.is_cancelled()) {
    lock.unlock();
    stop(Error{ErrorCode::cancelled, "stopped before all features were validated"});
    return std::nullopt;
  }
  auto text = reader_.next();
  if (text && *text) {
    Found found{taken_++, **std::move(text)};
    Passage& passage = passages_[found.number];
    passage.bytes = found.text.line.size();
    bytes_ += passage.bytes;
    return found;
  }
  is_over_ = true;
  if (!text) {  // the rest cannot be read; the error waits for its turn
    passages_[taken_++].error = std::move(text).error();
    hand_on_in_order(lock);
  }
  room_.notify_all();
  return std::nullopt;
}

Passage Stream::validate(Found found) {
  Passage passage;
  passage.bytes = found.text.line.size();
  auto feature = reader_.read(std::move(found.text));
  if (feature) {
    passage.feature = ValidatedFeature{
        found.number,
        inspect(*std::move(feature), workers_, certify_, options_.groups, &templates_)};
  } else {
    passage.error = std::move(feature).error();
  }
  return passage;
}

void Stream::put_back(std::uint64_t number, Passage passage) {
  std::unique_lock lock(mutex_);
  passages_[number] = std::move(passage);
  hand_on_in_order(lock);
}

/// Hands on the complete passages in order; one thread at a time, without the lock during calls.
void Stream::hand_on_in_order(std::unique_lock<std::mutex>& lock) {
  if (is_handing_on_) return;
  is_handing_on_ = true;
  while (!failure_) {
    const auto first = passages_.find(handed_on_);
    if (first == passages_.end() || !(first->second.feature || first->second.error)) break;
    Passage passage = std::move(first->second);
    const std::uint64_t bytes_read = reader_.bytes_read();
    const std::uint64_t bytes = passage.bytes;
    lock.unlock();
    Status status = hand_on(std::move(passage));
    if (status && options_.progress) options_.progress(outcome_.features, bytes_read);
    lock.lock();
    passages_.erase(handed_on_++);
    bytes_ -= bytes;
    if (!status) {
      if (!failure_) failure_ = std::move(status).error();
      is_over_ = true;
    }
    room_.notify_all();
  }
  is_handing_on_ = false;
}

/// Calls the sink of a passage. Only the thread that hands on changes outcome_.
Status Stream::hand_on(Passage passage) {
  if (passage.error) {
    ++outcome_.unreadable;
    return on_error_(*passage.error);
  }
  ++outcome_.features;
  outcome_.verdict = worse(outcome_.verdict, passage.feature->inspected.verdict());
  return on_feature_(*std::move(passage.feature));
}

/// Hands on the geometry templates, last because what they count as depends on their instances.
void Stream::add_templates() {
  auto inspected = templates_.inspect_templates(reader_.document().instances);
  if (!inspected) return;
  Passage passage;
  passage.feature = ValidatedFeature{taken_, *std::move(inspected)};
  if (Status status = hand_on(std::move(passage)); !status) failure_ = std::move(status).error();
}

void Stream::stop(Error error) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(error);
  is_over_ = true;
  room_.notify_all();
}

}  // namespace

Result<StreamOutcome> validate_stream(formats::FeatureReader& reader,
                                      delaunay::EngineWorkers* workers,
                                      const StreamOptions& options, const FeatureSink& on_feature,
                                      const ErrorSink& on_error) {
  return Stream(reader, workers, options, on_feature, on_error).run();
}

}  // namespace watertight::pipeline
