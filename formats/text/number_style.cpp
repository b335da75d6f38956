// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/text/number_style.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace watertight::formats {
namespace {

/// The most decimals or significant digits that a style has; a double has up to 17 digits.
constexpr std::size_t kMostDigits = 40;

/// The number of characters after the point, up to an exponent.
std::size_t decimals_of(std::string_view number) {
  const std::size_t point = number.find('.');
  if (point == std::string_view::npos) return 0;
  return std::min(number.find_first_of("eE"), number.size()) - point - 1;
}

std::size_t significant_digits_of(std::string_view number) {
  number = number.substr(0, number.find_first_of("eE"));
  const std::size_t first = number.find_first_of("123456789");
  if (first == std::string_view::npos) return 1;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return static_cast<std::size_t>(
      std::count_if(number.begin() + static_cast<std::ptrdiff_t>(first), number.end(), is_digit));
}

std::string with_zeros(std::string text, std::size_t decimals) {
  const std::size_t present = decimals_of(text);
  if (present >= decimals || text.find_first_of("eE") != std::string::npos) return text;
  if (present == 0) text += '.';
  return text.append(decimals - present, '0');
}

/// The digits of a double; "" if they are more than the array holds.
std::string digits_of(double value, std::chars_format format, std::size_t digits) {
  std::array<char, 128> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format,
                                 static_cast<int>(digits));
  return end.ec == std::errc{} ? std::string(text.data(), end.ptr) : std::string();
}

double lattice_coordinate(const VertexCoordinate& coordinate) {
  const Point& point = coordinate.solid->vertices()[coordinate.vertex];
  return coordinate.axis == 0 ? point.x : coordinate.axis == 1 ? point.y : point.z;
}

}  // namespace

std::string VertexCoordinate::digits() const {
  return solid->lattice().world_text(lattice_coordinate(*this), axis);
}

double VertexCoordinate::value() const {
  return solid->lattice().world(lattice_coordinate(*this), axis);
}

std::string NumberStyle::print(const VertexCoordinate& coordinate) const {
  switch (form_) {
    case Form::exact:
      return with_zeros(coordinate.digits(), digits_);
    case Form::fixed:
      return digits_of(coordinate.value(), std::chars_format::fixed, digits_);
    case Form::scientific:
      return digits_of(coordinate.value(), std::chars_format::scientific, digits_);
    case Form::capital: {
      std::string text = digits_of(coordinate.value(), std::chars_format::scientific, digits_);
      std::replace(text.begin(), text.end(), 'e', 'E');
      return text;
    }
    case Form::general:
      return digits_of(coordinate.value(), std::chars_format::general, digits_);
  }
  return {};
}

void NumberStyle::learn(const VertexCoordinate& coordinate, std::string_view text) {
  const std::size_t decimals = std::min(decimals_of(text), kMostDigits);
  const std::size_t significant = std::min(significant_digits_of(text), kMostDigits);
  NumberStyle style;
  for (const Form form :
       {Form::exact, Form::fixed, Form::scientific, Form::capital, Form::general}) {
    style.form_ = form;
    style.digits_ = form == Form::general ? significant : decimals;
    if (style.print(coordinate) != text) continue;
    *this = style;
    return;
  }
}

void add_number(ExceptionWriter& numbers, NumberStyle& style, const VertexCoordinate& coordinate,
                std::string_view text) {
  if (style.print(coordinate) == text) {
    numbers.expected();
    return;
  }
  numbers.exception(text);
  style.learn(coordinate, text);
}

void append_number(ExceptionReader& numbers, NumberStyle& style, const VertexCoordinate& coordinate,
                   std::string& text) {
  std::string_view exception;
  if (!numbers.next(exception)) {
    text += style.print(coordinate);
    return;
  }
  style.learn(coordinate, exception);
  text += exception;
}

void add_likely(ExceptionWriter& texts, std::string& last, std::string_view text) {
  if (text == last) {
    texts.expected();
    return;
  }
  texts.exception(text);
  last = text;
}

void append_likely(ExceptionReader& texts, std::string& last, std::string& text) {
  std::string_view exception;
  if (texts.next(exception)) last = exception;
  text += last;
}

}  // namespace watertight::formats
