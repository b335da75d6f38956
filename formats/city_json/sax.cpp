// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/city_json/sax.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

enum class Role : std::uint8_t {
  other,
  root,
  city_objects,
  city_object,
  geometries,
  geometry,
};
enum class Capture : std::uint8_t { none, vertices, boundaries };

// An object or array that is not complete yet.
struct Frame {
  bool is_array = false;
  Role role = Role::other;
  std::vector<std::string> keys;  // the keys of the members that are complete; empty for arrays
  std::vector<Json> values;
  std::string key;  // the key of the member that comes next
};

// Messages of the parser quote the input; they are made short and printable.
constexpr std::size_t kLongestMessage = 300;  // the most bytes of a parser's message

std::string syntax_message(std::string_view what) {
  if (const auto end = what.find("] "); end != std::string_view::npos) what.remove_prefix(end + 2);
  std::string message(what.substr(0, 240));
  for (char& c : message) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) c = '?';
  }
  return message;
}

// The events of nlohmann's SAX parser, which is iterative. A function that returns false ends the
// parsing.
class CitySax {
 public:
  CitySax(bool is_city, CityText kind, const Limits& limits)
      : is_city_(is_city), kind_(kind), limits_(limits) {}

  bool null() { return scalar(nullptr); }
  bool boolean(bool value) { return scalar(value); }
  bool number_integer(std::int64_t value) {
    if (capture_ == Capture::vertices) return coordinate(value);
    return scalar(value);
  }
  bool number_unsigned(std::uint64_t value) {
    if (capture_ == Capture::boundaries) return vertex_index(value);
    if (capture_ == Capture::vertices) {
      if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
        return fail(ErrorCode::limit_exceeded, "a vertex coordinate needs more than 64 bits");
      }
      return coordinate(static_cast<std::int64_t>(value));
    }
    return scalar(value);
  }
  bool number_float(double value, const std::string& text) {
    if (capture_ == Capture::vertices) return decimal_coordinate(text);
    return scalar(number_value(value, text));
  }
  bool string(std::string& value) { return scalar(std::move(value)); }
  bool binary(Json::binary_t&) { return fail(ErrorCode::malformed, "binary value"); }

  bool start_object(std::size_t) {
    if (!leave_capture()) return false;
    return open(false);
  }
  bool key(std::string& key) {
    frames_.back().key = std::move(key);
    return true;
  }
  bool end_object() {
    Frame& top = frames_.back();
    if (const std::string* twice = duplicate_key(top); twice != nullptr) {
      top.key = *twice;
      return fail(ErrorCode::malformed, "the key occurs twice in one object");
    }
    return close(make_object(std::move(top.keys), std::move(top.values)));
  }
  bool start_array(std::size_t) {
    if (capture_ != Capture::none) return open_captured();
    const Capture capture = capture_of_next();
    if (capture == Capture::none) return open(true);
    capture_ = capture;
    if (capture == Capture::vertices) model_.vertices.is_present = true;
    return open_captured();
  }
  bool end_array() {
    if (capture_ != Capture::none) return close_captured();
    return close(Json(Json::array_t(std::move(frames_.back().values))));
  }
  bool parse_error(std::size_t position, const std::string&, const Json::exception& exception) {
    error_.code = ErrorCode::malformed;
    error_.message = syntax_message(exception.what());
    // The message quotes the token, which may be megabytes of digits.
    if (error_.message.size() > kLongestMessage) {
      std::size_t end = kLongestMessage;
      while (end > 0 && (static_cast<unsigned char>(error_.message[end]) & 0xC0U) == 0x80U) --end;
      error_.message = error_.message.substr(0, end) + " ...";
    }
    error_.byte_offset = position == 0 ? 0 : position - 1;
    return false;
  }

  CityModel& model() { return model_; }
  Error& error() { return error_; }

 private:
  bool fail(ErrorCode code, std::string message) {
    error_ = Error{code, std::move(message), {}, pointer()};
    return false;
  }

  std::string pointer() const {
    std::string path;
    for (const Frame& frame : frames_) {
      path += frame.is_array ? pointer_token(frame.values.size()) : pointer_token(frame.key);
    }
    // counters_[0] belongs to the captured array itself; a counter is the index of the next
    // element.
    for (const std::size_t position : counters_) path += pointer_token(position);
    return path;
  }

  bool scalar(Json value) {
    if (!leave_capture()) return false;
    add(std::move(value));
    return true;
  }

  bool not_captured() {
    return fail(ErrorCode::malformed, "a vertex is an array of three numbers");
  }

  // Ends the capture before a value that cannot be in what is captured. Boundaries become Json
  // values, from their start on; vertices are for all objects, so the document cannot be read.
  bool leave_capture() {
    if (capture_ == Capture::none) return true;
    if (capture_ == Capture::vertices) return not_captured();
    capture_ = Capture::none;
    counters_.clear();
    const std::size_t begin = model_.boundary_begin.back();
    for (std::size_t i = begin; i < model_.tokens.size(); ++i) {
      const BoundaryToken token = model_.tokens[i];
      if (token == kOpen) {
        frames_.push_back(Frame{true, Role::other, {}, {}, {}});
      } else if (token == kClose) {
        Json array(Json::array_t(std::move(frames_.back().values)));
        frames_.pop_back();
        add(std::move(array));
      } else {
        add(std::uint64_t{token});
      }
    }
    model_.tokens.resize(begin);
    return true;
  }

  void add(Json value) {
    if (frames_.empty()) {
      model_.root = std::move(value);
      return;
    }
    Frame& top = frames_.back();
    if (!top.is_array) top.keys.push_back(std::move(top.key));
    top.values.push_back(std::move(value));
  }

  Role role_of_next(bool is_array) const {
    if (!is_city_) return Role::other;
    if (frames_.empty()) return is_array ? Role::other : Role::root;
    const Frame& top = frames_.back();
    switch (top.role) {
      case Role::root:
        return !is_array && top.key == "CityObjects" ? Role::city_objects : Role::other;
      case Role::city_objects:
        return is_array ? Role::other : Role::city_object;
      case Role::city_object:
        return is_array && top.key == "geometry" ? Role::geometries : Role::other;
      case Role::geometries:
        return is_array ? Role::other : Role::geometry;
      default:
        return Role::other;
    }
  }

  Capture capture_of_next() const {
    if (frames_.empty()) return Capture::none;
    const Frame& top = frames_.back();
    if (top.role == Role::root && top.key == "vertices") return Capture::vertices;
    if (top.role == Role::geometry && top.key == "boundaries") return Capture::boundaries;
    return Capture::none;
  }

  bool has_room() {
    if (frames_.size() + counters_.size() < limits_.nesting) return true;
    return fail(ErrorCode::limit_exceeded, "arrays and objects are nested deeper than " +
                                               std::to_string(limits_.nesting) + " levels");
  }

  bool open(bool is_array) {
    if (!has_room()) return false;
    const Role role = role_of_next(is_array);
    frames_.push_back(Frame{is_array, role, {}, {}, {}});
    return true;
  }

  bool close(Json value) {
    const Role role = frames_.back().role;
    frames_.pop_back();
    if (role == Role::geometry) {
      // A number in the source would be mistaken for the index of a captured boundary.
      const Json* boundaries = find_member(value, "boundaries");
      if (boundaries != nullptr && !was_captured_ && !is_kept(*boundaries)) {
        return fail(ErrorCode::malformed, "the boundaries of a geometry must be an array");
      }
      was_captured_ = false;
    }
    add(std::move(value));
    return true;
  }

  // Whether boundaries that were not captured are no index of captured ones, and refer to solids in
  // a skeleton alone.
  bool is_kept(const Json& boundaries) const {
    if (boundaries.is_object()) return kind_ == CityText::skeleton;
    return !boundaries.is_number_unsigned();
  }

  bool open_captured() {
    if (!has_room()) return false;
    if (capture_ == Capture::boundaries) {
      model_.tokens.push_back(kOpen);
    } else if (counters_.size() >= 2) {
      return not_captured();
    } else if (counters_.size() == 1) {
      axis_ = 0;
      if (model_.vertices.size() >= kMostVertices) {
        return fail(ErrorCode::limit_exceeded, "more vertices than a 32-bit index can name");
      }
    }
    counters_.push_back(0);
    return true;
  }

  bool close_captured() {
    if (capture_ == Capture::vertices && counters_.size() == 2) {
      if (axis_ != 3) return not_captured();
      add_vertex();
    }
    counters_.pop_back();
    if (capture_ == Capture::boundaries) model_.tokens.push_back(kClose);
    if (!counters_.empty()) {
      ++counters_.back();
      return true;
    }
    if (capture_ == Capture::boundaries) {
      was_captured_ = true;
      const std::uint64_t index = model_.boundary_begin.size() - 1;
      model_.boundary_begin.push_back(model_.tokens.size());
      capture_ = Capture::none;
      add(index);
    } else {
      capture_ = Capture::none;
      add(nullptr);
    }
    return true;
  }

  bool vertex_index(std::uint64_t value) {
    if (value >= kMostVertices) return scalar(value);
    model_.tokens.push_back(static_cast<BoundaryToken>(value));
    ++counters_.back();
    return true;
  }

  bool coordinate(std::int64_t value) {
    if (counters_.size() != 2 || axis_ >= 3) return not_captured();
    if (model_.vertices.are_integers) {
      integer_[axis_] = value;
    } else {
      auto exact = exact_number(std::to_string(value));
      if (!exact) return fail(exact.error().code, exact.error().message);
      decimal_[axis_] = exact->value;
      is_rounded_ = is_rounded_ || exact->is_rounded;
    }
    ++axis_;
    ++counters_.back();
    return true;
  }

  bool decimal_coordinate(const std::string& text) {
    if (counters_.size() != 2 || axis_ >= 3) return not_captured();
    auto exact = exact_number(text);
    if (!exact) return fail(exact.error().code, exact.error().message);
    if (model_.vertices.are_integers && !change_to_decimals()) return false;
    decimal_[axis_++] = exact->value;
    is_rounded_ = is_rounded_ || exact->is_rounded;
    ++counters_.back();
    return true;
  }

  bool change_to_decimals() {
    VertexList& list = model_.vertices;
    const auto change = [](const std::array<std::int64_t, 3>& from, std::size_t axes,
                           std::array<GridNumber, 3>& to) {
      for (std::size_t axis = 0; axis < axes; ++axis) {
        auto exact = exact_number(std::to_string(from[axis]));
        if (!exact) return false;
        to[axis] = exact->value;
      }
      return true;
    };
    list.decimals.resize(list.integers.size());
    for (std::size_t i = 0; i < list.integers.size(); ++i) {
      if (!change(list.integers[i], 3, list.decimals[i])) return not_captured();
    }
    if (!change(integer_, axis_, decimal_)) return not_captured();
    list.integers = {};
    list.are_integers = false;
    return true;
  }

  void add_vertex() {
    if (is_rounded_) model_.vertices.rounded.push_back(static_cast<Index>(model_.vertices.size()));
    is_rounded_ = false;
    if (model_.vertices.are_integers) {
      model_.vertices.integers.push_back(integer_);
    } else {
      model_.vertices.decimals.push_back(decimal_);
    }
  }

  static const std::string* duplicate_key(const Frame& frame) {
    if (frame.keys.size() < 2) return nullptr;
    std::vector<const std::string*> sorted;
    sorted.reserve(frame.keys.size());
    for (const std::string& key : frame.keys) sorted.push_back(&key);
    std::sort(sorted.begin(), sorted.end(),
              [](const std::string* a, const std::string* b) { return *a < *b; });
    const auto twice =
        std::adjacent_find(sorted.begin(), sorted.end(),
                           [](const std::string* a, const std::string* b) { return *a == *b; });
    return twice == sorted.end() ? nullptr : *twice;
  }

  bool is_city_;
  CityText kind_;
  const Limits& limits_;
  CityModel model_;
  Error error_;
  std::vector<Frame> frames_;
  Capture capture_ = Capture::none;
  bool was_captured_ = false;          // the open geometry has captured boundaries
  std::vector<std::size_t> counters_;  // the number of elements so far, by open captured array
  std::size_t axis_ = 0;
  std::array<std::int64_t, 3> integer_{};
  std::array<GridNumber, 3> decimal_{};
  bool is_rounded_ = false;  // a number of the open vertex was rounded
};

Result<CityModel> parse(std::string_view text, bool is_city, CityText kind, const Limits& limits) {
  if (text.size() > limits.bytes) {
    return Error{ErrorCode::limit_exceeded, std::to_string(text.size()) + " bytes; the limit is " +
                                                std::to_string(limits.bytes)};
  }
  // The parser takes a NUL for the end of the text and would lose the rest.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    return Error{ErrorCode::malformed, "a JSON text must not contain a NUL byte", nul, {}};
  }
  CitySax sax(is_city, kind, limits);
  if (!Json::sax_parse(text.begin(), text.end(), &sax)) return std::move(sax.error());
  sax.model().text_bytes = text.size();
  return std::move(sax.model());
}

}  // namespace

Result<CityModel> parse_city_model(std::string_view text, CityText kind, const Limits& limits) {
  return parse(text, true, kind, limits);
}

Result<Json> parse_json(std::string_view text, const Limits& limits) {
  auto model = parse(text, false, CityText::document, limits);
  if (!model) return std::move(model).error();
  return std::move(model->root);
}

}  // namespace watertight::formats
