// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/number_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace watertight::report {
namespace {

/// The most digits after the point. Smaller numbers are written with an exponent.
constexpr int kMostDecimals = 15;

/// From here on numbers are written with an exponent.
constexpr double kLargest = 1e15;

std::string formatted(const char* format, int digits, double value) {
  std::array<char, 64> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, digits, value);
  const auto most = static_cast<int>(buffer.size()) - 1;
  return std::string(buffer.data(), static_cast<std::size_t>(std::clamp(length, 0, most)));
}

/// A number with at most so many digits after the point, without zeros at its end.
std::string decimal_text(double value, int decimals) {
  if (!(std::abs(value) < kLargest)) return formatted("%.*g", 9, value);
  std::string text = formatted("%.*f", std::clamp(decimals, 0, kMostDecimals), value);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

/// A unit for lengths, and the digits after the point.
struct Scale {
  int thousandths = 0;  // the unit is 1000^-thousandths metres
  int decimals = 2;
};

constexpr std::array<std::string_view, 4> kLengths{"m", "mm", "\xC2\xB5m", "nm"};

/// The scale for a length. The smallest length with a unit is 0.05 nm.
Scale scale_of(double metres) {
  const double size = std::abs(metres);
  if (size == 0 || size >= 0.99995) return {0, 2};
  Scale scale{1, 1};
  for (double least = 5e-5; size < least && scale.thousandths < 3; least /= 1000) {
    ++scale.thousandths;
  }
  return scale;
}

bool has_unit(double metres) { return metres == 0 || std::abs(metres) >= 5e-11; }

/// The digits after the point of a number that is no length: three significant ones below 1.
int plain_decimals(double value) {
  const double size = std::abs(value);
  if (size == 0 || size >= 1 || !std::isfinite(size)) return 2;
  return 2 - static_cast<int>(std::floor(std::log10(size)));
}

std::string readable(double value, const std::string& unit, int more) {
  if (unit != "m") {
    std::string text = decimal_text(value, plain_decimals(value) + more);
    if (unit.empty()) return text;
    text.append(1, ' ').append(unit);
    if (unit == "degree" && value != 1) text += 's';
    return text;
  }
  if (!has_unit(value)) return formatted("%.*g", 2 + more, value) + " m";
  const Scale scale = scale_of(value);
  const double scaled = value * std::pow(1000.0, scale.thousandths);
  std::string text = decimal_text(scaled, scale.decimals + more);
  text.append(1, ' ').append(kLengths[static_cast<std::size_t>(scale.thousandths)]);
  return text;
}

std::string column(double value, const std::string& unit, int more) {
  if (unit != "m") return decimal_text(value, plain_decimals(value) + more);
  if (!has_unit(value)) return formatted("%.*g", 2 + more, value);
  const Scale scale = scale_of(value);
  return decimal_text(value, 3 * scale.thousandths + scale.decimals + more);
}

template <class Write>
MeasureText measure_of(const Finding& finding, const Write& write) {
  MeasureText text;
  if (!finding.measured) {
    if (finding.limit) text.limit = write(*finding.limit, finding.unit, 0);
    return text;
  }
  for (int more = 0; more <= kMostDecimals; ++more) {
    text.measured = write(*finding.measured, finding.unit, more);
    if (!finding.limit) break;
    text.limit = write(*finding.limit, finding.unit, more);
    if (text.measured != text.limit || *finding.measured == *finding.limit) break;
  }
  return text;
}

}  // namespace

/// The limit has the unit of the measured value, unless both are lengths in units of their own.
MeasureText readable_measure(const Finding& finding) {
  MeasureText text = measure_of(finding, readable);
  const bool repeats = finding.unit != "m" && !finding.unit.empty() && !text.measured.empty();
  if (repeats) text.limit.resize(std::min(text.limit.find(' '), text.limit.size()));
  return text;
}

MeasureText measure_columns(const Finding& finding) {
  MeasureText text = measure_of(finding, column);
  if (finding.measured || finding.limit) text.unit = finding.unit;
  return text;
}

std::string measure_words(const Finding& finding) {
  const MeasureText text = readable_measure(finding);
  if (text.measured.empty() || text.limit.empty()) return text.measured;
  std::string words = text.measured;
  return words.append(", limit ").append(text.limit);
}

std::array<std::string, 3> point_columns(const std::array<double, 3>& point) {
  double largest = 0;
  for (const double coordinate : point) largest = std::max(largest, std::abs(coordinate));
  const bool has_digits = largest > 0 && std::isfinite(largest);
  const int decimals = has_digits ? 8 - static_cast<int>(std::floor(std::log10(largest))) : 0;
  std::array<std::string, 3> columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Coordinates below the last digit of decimal_text() are those of a solid of atoms.
    columns[axis] = decimals > kMostDecimals ? formatted("%.*g", 9, point[axis])
                                             : decimal_text(point[axis], decimals);
  }
  return columns;
}

std::string point_text(const std::array<double, 3>& point) {
  const auto [x, y, z] = point_columns(point);
  std::string text = x;
  return text.append(1, ' ').append(y).append(1, ' ').append(z);
}

}  // namespace watertight::report
