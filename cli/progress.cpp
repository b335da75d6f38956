// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "cli/printable.h"

namespace watertight::cli {
namespace {

constexpr double kWidthOfBar = 30;
constexpr std::chrono::milliseconds kInterval{100};

}  // namespace

ProgressBar::ProgressBar(const std::string& label)
    : label_(printable(label)),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_ - kInterval) {}

ProgressBar::~ProgressBar() {
  if (is_drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(std::uint64_t features, std::optional<double> share) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_terminal_ || now - drawn_ < kInterval) return;
  drawn_ = now;
  is_drawn_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s", progress_line(label_, features, share, seconds).c_str());
}

std::optional<double> share_done(std::uint64_t features, std::optional<std::uint64_t> all_features,
                                 std::uint64_t bytes, std::optional<std::uint64_t> all_bytes) {
  const auto share = [](std::uint64_t part, std::uint64_t whole) -> std::optional<double> {
    if (whole == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(whole);
  };
  if (all_features) return share(features, *all_features);
  return all_bytes ? share(bytes, *all_bytes) : std::nullopt;
}

std::string progress_line(const std::string& label, std::uint64_t features,
                          std::optional<double> share, double seconds) {
  std::array<char, 96> text{};
  std::string line = label;
  if (share) {
    const double part = std::clamp(*share, 0.0, 1.0);
    const auto filled = static_cast<std::size_t>(kWidthOfBar * part);
    line += " [" + std::string(filled, '#') +
            std::string(static_cast<std::size_t>(kWidthOfBar) - filled, '.') + "]";
  }
  const double rate = seconds > 0 ? static_cast<double>(features) / seconds : 0;
  std::snprintf(text.data(), text.size(), " %llu features  %.0f/s",
                static_cast<unsigned long long>(features), rate);
  line += text.data();
  if (share && *share > 0 && *share < 1 && seconds >= 1) {
    const double left = seconds / *share * (1 - *share);
    const auto whole = static_cast<unsigned long long>(std::llround(std::min(left, 359'999.0)));
    if (whole >= 3600) {
      std::snprintf(text.data(), text.size(), "  %llu:%02llu:%02llu left", whole / 3600,
                    whole / 60 % 60, whole % 60);
    } else {
      std::snprintf(text.data(), text.size(), "  %llu:%02llu left", whole / 60, whole % 60);
    }
    line += text.data();
  }
  return line;
}

}  // namespace watertight::cli
