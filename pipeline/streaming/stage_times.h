// SPDX-License-Identifier: GPL-3.0-or-later
//
// The time that goes into the stages of an ingestion.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string_view>

namespace watertight::pipeline {

/// What is done with a feature on its way into a store, in this order.
enum class Stage : std::uint8_t { reading, judging, encoding, packing, storing };
inline constexpr std::array kStages = {Stage::reading, Stage::judging, Stage::encoding,
                                       Stage::packing, Stage::storing};
constexpr std::string_view to_string(Stage stage) {
  constexpr std::array<std::string_view, kStages.size()> kNames = {"reading", "judging", "encoding",
                                                                   "packing", "storing"};
  return kNames[static_cast<std::size_t>(stage)];
}

/// The time of all threads together, by stage. Thread-safe.
class StageTimes {
 public:
  using Clock = std::chrono::steady_clock;

  void add(Stage stage, Clock::duration time) {
    const auto count = std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
    nanoseconds_[static_cast<std::size_t>(stage)] += count;
  }
  double seconds(Stage stage) const {
    constexpr double kNano = 1e-9;
    return static_cast<double>(nanoseconds_[static_cast<std::size_t>(stage)].load()) * kNano;
  }

 private:
  std::array<std::atomic<std::int64_t>, kStages.size()> nanoseconds_{};
};

/// Adds the time of its life to a stage; to none if `times` is null.
class StageTimer {
 public:
  StageTimer(StageTimes* times, Stage stage) : times_(times), stage_(stage) {}
  ~StageTimer() {
    if (times_ != nullptr) times_->add(stage_, StageTimes::Clock::now() - start_);
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes* times_;
  Stage stage_;
  StageTimes::Clock::time_point start_ = StageTimes::Clock::now();
};

}  // namespace watertight::pipeline
