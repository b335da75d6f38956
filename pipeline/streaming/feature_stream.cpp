// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/streaming/feature_stream.h"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "geometry/parallel.h"

namespace watertight::pipeline {
namespace {

/// The most features between reading and handing on, per thread: enough that a slow feature does
/// not hold up the others for long.
constexpr std::uint64_t kFeaturesInFlight = 32;
/// The most bytes of lines between reading and handing on; more only when one line is longer.
constexpr std::uint64_t kBytesInFlight = std::uint64_t{32} << 20U;

/// A feature between reader and delivery: it gets a number, then its work is done.
struct Passage {
  std::uint64_t bytes = 0;
  Delivery delivery;  // empty while the work is under way
};

class FeatureStream {
 public:
  FeatureStream(formats::FeatureReader& reader, const FeatureStreamOptions& options,
                const TextWork& work)
      : reader_(reader), options_(options), work_(work) {}

  Result<std::uint64_t> run() {
    const std::size_t threads = std::max<std::size_t>(options_.threads, 1);
    most_in_flight_ = kFeaturesInFlight * threads;
    geometry::for_each_piece(threads, static_cast<unsigned>(threads),
                             [this](std::size_t, bool) { work_to_the_end(); });
    if (failure_) return *std::move(failure_);
    return taken_;
  }

 private:
  struct Found {
    std::uint64_t number = 0;
    formats::FeatureText text;
  };

  /// The work of every thread until the document ends.
  void work_to_the_end() {
    try {
      for (auto found = take_next(); found; found = take_next()) {
        const std::uint64_t bytes = found->text.line.size();
        Delivery delivery = work_(found->number, std::move(found->text));
        put_back(found->number, {bytes, std::move(delivery)});
      }
    } catch (...) {
      stop(Error{ErrorCode::unavailable, "a thread failed"});
      throw;
    }
  }

  std::optional<Found> take_next();
  void put_back(std::uint64_t number, Passage passage);
  void hand_on_in_order(std::unique_lock<std::mutex>& lock);
  void stop(Error error);
  bool has_room() const {
    return passages_.empty() || (taken_ - handed_on_ < most_in_flight_ && bytes_ < kBytesInFlight);
  }

  formats::FeatureReader& reader_;
  const FeatureStreamOptions& options_;
  const TextWork& work_;
  std::uint64_t most_in_flight_ = 0;

  std::mutex mutex_;  // guards the members below, and reader_.next()
  std::condition_variable room_;
  std::map<std::uint64_t, Passage> passages_;  // in flight
  std::uint64_t taken_ = 0;
  std::uint64_t handed_on_ = 0;
  std::uint64_t bytes_ = 0;  // bytes of the lines in flight
  bool is_handing_on_ = false;
  bool is_over_ = false;  // no more features are taken
  std::optional<Error> failure_;
};

std::optional<FeatureStream::Found> FeatureStream::take_next() {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return is_over_ || has_room(); });
  if (is_over_) return std::nullopt;
  if (options_.is_cancelled && options_.is_cancelled()) {
    lock.unlock();
    stop(Error{ErrorCode::cancelled, "stopped before all features were validated"});
    return std::nullopt;
  }
  auto text = [this] {
    const StageTimer timer(options_.stages, Stage::reading);
    return reader_.next();
  }();
  if (text && *text) {
    Found found{taken_++, **std::move(text)};
    Passage& passage = passages_[found.number];
    passage.bytes = found.text.line.size();
    bytes_ += passage.bytes;
    return found;
  }
  is_over_ = true;
  if (!text) {  // the rest cannot be read; the error waits for its turn
    const std::uint64_t number = taken_++;
    passages_[number].delivery = work_(number, std::move(text).error());
    hand_on_in_order(lock);
  }
  room_.notify_all();
  return std::nullopt;
}

void FeatureStream::put_back(std::uint64_t number, Passage passage) {
  std::unique_lock lock(mutex_);
  passages_[number] = std::move(passage);
  hand_on_in_order(lock);
}

/// Hands on the finished passages in order; one thread at a time, without the lock during calls.
void FeatureStream::hand_on_in_order(std::unique_lock<std::mutex>& lock) {
  if (is_handing_on_) return;
  is_handing_on_ = true;
  while (!failure_) {
    const auto first = passages_.find(handed_on_);
    if (first == passages_.end() || !first->second.delivery) break;
    const Delivery delivery = std::exchange(first->second.delivery, {});
    const std::uint64_t bytes_read = reader_.bytes_read();
    const std::uint64_t bytes = first->second.bytes;
    lock.unlock();
    Status status = delivery();
    if (status && options_.progress) options_.progress(bytes_read);
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

void FeatureStream::stop(Error error) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(error);
  is_over_ = true;
  room_.notify_all();
}

}  // namespace

Result<std::uint64_t> stream_texts(formats::FeatureReader& reader,
                                   const FeatureStreamOptions& options, const TextWork& work) {
  return FeatureStream(reader, options, work).run();
}

Result<std::uint64_t> stream_features(formats::FeatureReader& reader,
                                      const FeatureStreamOptions& options,
                                      const FeatureWork& work) {
  return stream_texts(reader, options,
                      [&](std::uint64_t number, Result<formats::FeatureText> text) {
                        if (!text) return work(number, {}, std::move(text).error());
                        Result<Feature> feature = [&] {
                          const StageTimer timer(options.stages, Stage::reading);
                          return reader.read(*text);
                        }();
                        return work(number, *text, std::move(feature));
                      });
}

}  // namespace watertight::pipeline
