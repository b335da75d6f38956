// SPDX-License-Identifier: GPL-3.0-or-later
//
// Texts of ISO 10303-21, in which STEP and IFC files are written: numbered instances of entities.
// The text is searched once; an instance becomes values when it is asked for. Internal to formats/.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/limits.h"
#include "base/result.h"

namespace watertight::formats {

struct StepValue {
  enum class Kind : std::uint8_t {
    omitted,      // $
    derived,      // *
    number,       // integer or real
    text,         // 'text', as written between the quotes
    enumeration,  // .TEXT.
    reference,    // #12
    list,         // (...)
    typed         // TYPE(value): `text` is the type, `items` has the value
  };
  Kind kind = Kind::omitted;
  double number = 0;
  std::uint64_t id = 0;
  std::string_view text;
  std::vector<StepValue> items;

  bool is_true() const { return kind == Kind::enumeration && text == "T"; }
};

/// One entity of an instance. Types are in upper case.
struct StepEntity {
  std::string_view type;
  std::vector<StepValue> values;
};

struct StepInstance {
  std::uint64_t id = 0;
  std::size_t offset = 0;            // of the instance in the text, bytes
  std::vector<StepEntity> entities;  // one; several of a complex instance
};

/// Where an instance stands, and the type of a simple one; "" for a complex one.
struct StepPlace {
  std::uint64_t id = 0;
  std::string_view type;
  std::size_t offset = 0;
};

class Part21 {
 public:
  /// Searches a text for its instances. Refers to the text. Errors: malformed with byte offset (no
  /// text of this kind, truncated, a string without end, an id twice). Cost: linear.
  static Result<Part21> read(std::string_view text, const Limits& limits);

  /// The schema that the header names, "" if none: "IFC4", "AUTOMOTIVE_DESIGN ...".
  std::string_view schema() const { return schema_; }
  /// All instances, by ascending id.
  std::span<const StepPlace> places() const { return places_; }
  /// The instance of a number. Errors: malformed with byte offset, also if there is none;
  /// limit_exceeded for lists nested deeper than Limits::nesting. Cost: linear in its text.
  Result<StepInstance> instance(std::uint64_t id) const;
  /// The type of a simple instance, "" if there is none.
  std::string_view type_of(std::uint64_t id) const;

 private:
  explicit Part21(std::string_view text, const Limits& limits) : text_(text), limits_(limits) {}
  const StepPlace* find(std::uint64_t id) const;
  Status search();

  std::string_view text_;
  Limits limits_;
  std::string_view schema_;
  std::vector<StepPlace> places_;
};

/// "#12".
std::string instance_name(std::uint64_t id);

/// Whether a text starts as one of ISO 10303-21, after blanks.
bool is_part21(std::string_view text);

/// A string of a text as UTF-8: '' is a quote, \X2\00F8\X0\ and the like are characters.
std::string decoded_text(std::string_view text);

}  // namespace watertight::formats
