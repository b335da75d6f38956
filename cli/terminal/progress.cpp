// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "cli/terminal/printable.h"

namespace watertight::cli {
namespace {

constexpr double kWidthOfBar = 30;
constexpr std::chrono::milliseconds kInterval{100};

/// The columns where the terminal does not say how many it has.
constexpr std::size_t kUsualColumns = 80;

/// The least of a label that is kept.
constexpr std::size_t kLeastLabel = 12;

/// The columns of the terminal at standard error, less one: a full line would move the cursor to
/// the next.
std::size_t columns() {
  winsize size{};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return (is_known ? size.ws_col : kUsualColumns) - 1;
}

bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

/// The first characters of a text.
std::string first_of(const std::string& text, std::size_t count) {
  std::size_t end = 0;
  for (; end < text.size(); ++end) {
    if (starts_character(text[end]) && count-- == 0) break;
  }
  return text.substr(0, end);
}

/// The last characters of a text.
std::string last_of(const std::string& text, std::size_t count) {
  const std::size_t width = width_of(text);
  return width <= count ? text : text.substr(first_of(text, width - count).size());
}

}  // namespace

ProgressBar::ProgressBar(const std::string& label, const std::string& position)
    : label_(printable(label)),
      position_(position),
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
  const std::string line =
      fit_to_width(position_, label_, progress_line("", features, share, seconds), columns());
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
}

std::string position_among(std::size_t number, std::size_t files) {
  if (files < 2) return {};
  return std::string("file ")
      .append(std::to_string(number))
      .append(" of ")
      .append(std::to_string(files));
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

std::string fit_to_width(const std::string& position, const std::string& label,
                         const std::string& rest, std::size_t columns) {
  const std::string before = position.empty() ? "" : position + "  ";
  const std::size_t fixed = width_of(before) + width_of(rest);
  const std::size_t room = std::max(columns > fixed ? columns - fixed : 0, kLeastLabel);
  std::string line = before;
  line += width_of(label) <= room ? label : "\xE2\x80\xA6" + last_of(label, room - 1);
  return first_of(line + rest, columns);
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
