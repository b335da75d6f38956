// SPDX-License-Identifier: GPL-3.0-or-later
//
// The ways in which programs print coordinates. Internal to formats/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "formats/text/text_layout.h"
#include "geometry/solid.h"

namespace watertight::formats {

/// One coordinate of a vertex of a solid.
struct VertexCoordinate {
  const Solid* solid = nullptr;
  Index vertex = 0;
  int axis = 0;

  std::string digits() const;  // the exact digits (Lattice::world_text)
  double value() const;        // the nearest double
};

/// How a program prints one coordinate after the other. It starts as the exact digits and learns
/// from each number that it did not predict.
class NumberStyle {
 public:
  /// The likely text of the coordinate.
  std::string print(const VertexCoordinate& coordinate) const;
  /// Takes the style in which the coordinate has this text; keeps the old one if no style has it.
  void learn(const VertexCoordinate& coordinate, std::string_view text);

 private:
  enum class Form : std::uint8_t {
    exact,       // the exact digits, with zeros up to a number of decimals
    fixed,       // the double, rounded to a number of decimals
    scientific,  // the double as 1.250000e+02
    capital,     // the double as 1.250000E+02
    general      // the double, rounded to a number of significant digits, without zeros at the end
  };
  Form form_ = Form::exact;
  std::size_t digits_ = 0;
};

/// Writes the text of a coordinate, which is expected to be that of the style; the style learns.
void add_number(ExceptionWriter& numbers, NumberStyle& style, const VertexCoordinate& coordinate,
                std::string_view text);

/// Appends what add_number() wrote.
void append_number(ExceptionReader& numbers, NumberStyle& style, const VertexCoordinate& coordinate,
                   std::string& text);

/// Writes a text that is expected to be the last one of its kind, which it replaces.
void add_likely(ExceptionWriter& texts, std::string& last, std::string_view text);

/// Appends what add_likely() wrote.
void append_likely(ExceptionReader& texts, std::string& last, std::string& text);

}  // namespace watertight::formats
