// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/city_json/sax.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/assert.h"
#include "formats/text/json_events.h"
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
  std::size_t first_key = 0;    // the index of its first member among the keys of all frames
  std::size_t first_value = 0;  // the same among the values
  std::string key;              // the key of the member that comes next
};

constexpr std::string_view kNotThreeNumbers = "a vertex is an array of three numbers";
constexpr std::string_view kTooManyBits = "a vertex coordinate needs more than 64 bits";
constexpr std::string_view kNoDouble = "a vertex coordinate is beyond the range of doubles";

Json number_of(const GridNumber& number) {
  const std::string text = plain_text(number);
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return number_value(value, text);
}

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
        return keep_faulty(kTooManyBits, value);
      }
      return coordinate(static_cast<std::int64_t>(value));
    }
    return scalar(value);
  }
  bool number_float(double value, const std::string& text) {
    if (capture_ == Capture::vertices) return decimal_coordinate(value, text);
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
    const auto keys = std::span(keys_).subspan(top.first_key);
    if (const std::string* twice = duplicate_key(keys); twice != nullptr) {
      top.key = *twice;
      return fail(ErrorCode::malformed, "the key occurs twice in one object");
    }
    Json object = make_object(keys, std::span(values_).subspan(top.first_value));
    keys_.resize(top.first_key);
    return close(std::move(object));
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
    return close(open_array());
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
    const auto append = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        path += frames_[i].is_array ? pointer_token(value_count(i)) : pointer_token(frames_[i].key);
      }
    };
    const std::size_t captured = faulty_base_.value_or(frames_.size());
    append(0, captured);
    // counters_[0] belongs to the captured array itself; a counter is the index of the next
    // element.
    for (const std::size_t position : counters_) path += pointer_token(position);
    append(captured, frames_.size());
    return path;
  }

  // The number of complete values in a frame.
  std::size_t value_count(std::size_t frame) const {
    const bool is_top = frame + 1 == frames_.size();
    const std::size_t end = is_top ? values_.size() : frames_[frame + 1].first_value;
    return end - frames_[frame].first_value;
  }

  void push_frame(bool is_array, Role role) {
    frames_.push_back(Frame{is_array, role, keys_.size(), values_.size(), {}});
  }

  void pop_frame() {
    values_.resize(frames_.back().first_value);
    frames_.pop_back();
  }

  // The array of the top frame's values, which are moved.
  Json open_array() {
    const auto values = std::span(values_).subspan(frames_.back().first_value);
    return Json::array_t(std::make_move_iterator(values.begin()),
                         std::make_move_iterator(values.end()));
  }

  bool scalar(Json value) {
    if (!leave_capture()) return false;
    add(std::move(value));
    return true;
  }

  // Makes a Json value of the element of `vertices` that is open, because it is no vertex: until it
  // ends, nothing is captured.
  void begin_faulty(std::string_view reason) {
    FaultyVertex fault{static_cast<Index>(model_.vertices.size()), {}, {}, reason};
    faulty_base_ = frames_.size();
    capture_ = Capture::none;
    if (counters_.size() == 2) {
      fault.place = pointer_token(counters_.back());
      counters_.pop_back();
      push_frame(true, Role::other);
      add_open_coordinates();
    }
    model_.vertices.faulty.push_back(std::move(fault));
  }

  // Ends the element that begin_faulty() has begun.
  void end_faulty(Json value) {
    model_.vertices.faulty.back().value = std::move(value);
    faulty_base_.reset();
    capture_ = Capture::vertices;
    integer_ = {};
    decimal_ = {};
    is_rounded_ = false;
    add_vertex();
    ++counters_.back();
  }

  bool keep_faulty(std::string_view reason, Json value) {
    if (!has_place_for_vertex()) return false;
    begin_faulty(reason);
    add(std::move(value));
    return true;
  }

  // Adds the coordinates of the open vertex so far to the values.
  void add_open_coordinates() {
    for (std::size_t axis = 0; axis < axis_; ++axis) {
      if (model_.vertices.are_integers) {
        values_.emplace_back(integer_[axis]);
      } else {
        values_.push_back(number_of(decimal_[axis]));
      }
    }
  }

  bool has_place_for_vertex() {
    if (model_.vertices.size() < kMostVertices) return true;
    return fail(ErrorCode::limit_exceeded, "more vertices than a 32-bit index can name");
  }

  // Ends the capture before a value that cannot be in what is captured. Boundaries become Json
  // values, from their start on; of vertices, the open one.
  bool leave_capture() {
    if (capture_ == Capture::none) return true;
    if (capture_ == Capture::vertices) {
      if (!has_place_for_vertex()) return false;
      begin_faulty(kNotThreeNumbers);
      return true;
    }
    capture_ = Capture::none;
    counters_.clear();
    const std::size_t begin = model_.boundary_begin.back();
    for (std::size_t i = begin; i < model_.tokens.size(); ++i) {
      const BoundaryToken token = model_.tokens[i];
      if (token == kOpen) {
        push_frame(true, Role::other);
      } else if (token == kClose) {
        Json array = open_array();
        pop_frame();
        add(std::move(array));
      } else {
        add(std::uint64_t{token});
      }
    }
    model_.tokens.resize(begin);
    return true;
  }

  void add(Json value) {
    if (faulty_base_ == frames_.size()) return end_faulty(std::move(value));
    if (frames_.empty()) {
      model_.root = std::move(value);
      return;
    }
    Frame& top = frames_.back();
    if (!top.is_array) keys_.push_back(std::move(top.key));
    values_.push_back(std::move(value));
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
    push_frame(is_array, role);
    return true;
  }

  bool close(Json value) {
    const Role role = frames_.back().role;
    pop_frame();
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
      begin_faulty(kNotThreeNumbers);
      return open(true);
    } else if (counters_.size() == 1) {
      axis_ = 0;
      if (!has_place_for_vertex()) return false;
    }
    counters_.push_back(0);
    return true;
  }

  bool close_captured() {
    if (capture_ == Capture::vertices && counters_.size() == 2) {
      if (axis_ != 3) {
        begin_faulty(kNotThreeNumbers);
        return end_array();
      }
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
    if (counters_.size() != 2 || axis_ >= 3) return scalar(value);
    if (model_.vertices.are_integers) {
      integer_[axis_] = value;
    } else {
      auto exact = exact_number(std::to_string(value));
      if (!exact) return keep_faulty(kNoDouble, value);
      decimal_[axis_] = exact->value;
      is_rounded_ = is_rounded_ || exact->is_rounded;
    }
    ++axis_;
    ++counters_.back();
    return true;
  }

  bool decimal_coordinate(double value, const std::string& text) {
    if (counters_.size() != 2 || axis_ >= 3) return scalar(number_value(value, text));
    auto exact = exact_number(text);
    if (!exact) return keep_faulty(kNoDouble, number_value(value, text));
    if (model_.vertices.are_integers) change_to_decimals();
    decimal_[axis_++] = exact->value;
    is_rounded_ = is_rounded_ || exact->is_rounded;
    ++counters_.back();
    return true;
  }

  void change_to_decimals() {
    VertexList& list = model_.vertices;
    const auto decimal = [](std::int64_t value) {
      const auto exact = exact_number(std::to_string(value));
      WATERTIGHT_ASSERT(exact);  // 64 bits are within the range of doubles
      return exact->value;
    };
    list.decimals.resize(list.integers.size());
    for (std::size_t i = 0; i < list.integers.size(); ++i) {
      std::transform(list.integers[i].begin(), list.integers[i].end(), list.decimals[i].begin(),
                     decimal);
    }
    for (std::size_t axis = 0; axis < axis_; ++axis) decimal_[axis] = decimal(integer_[axis]);
    list.integers = {};
    list.are_integers = false;
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

  static const std::string* duplicate_key(std::span<const std::string> keys) {
    if (keys.size() < 2) return nullptr;
    std::vector<const std::string*> sorted;
    sorted.reserve(keys.size());
    for (const std::string& key : keys) sorted.push_back(&key);
    std::sort(sorted.begin(), sorted.end(),
              [](const std::string* a, const std::string* b) { return *a < *b; });
    const auto twice =
        std::adjacent_find(sorted.begin(), sorted.end(),
                           [](const std::string* a, const std::string* b) { return *a == *b; });
    return twice == sorted.end() ? nullptr : *twice;
  }

  // While an element of `vertices` becomes a Json value: the number of frames around `vertices`.
  std::optional<std::size_t> faulty_base_;
  bool is_city_;
  CityText kind_;
  const Limits& limits_;
  CityModel model_;
  Error error_;
  std::vector<Frame> frames_;
  std::vector<std::string> keys_;  // the keys of the members that are complete, frame by frame
  std::vector<Json> values_;       // the values that are complete, frame by frame
  Capture capture_ = Capture::none;
  bool was_captured_ = false;          // the open geometry has captured boundaries
  std::vector<std::size_t> counters_;  // the number of elements so far, by open captured array
  std::size_t axis_ = 0;
  std::array<std::int64_t, 3> integer_{};
  std::array<GridNumber, 3> decimal_{};
  bool is_rounded_ = false;  // a number of the open vertex was rounded
};

CityModel finished(CitySax& sax, std::string_view text) {
  sax.model().text_bytes = text.size();
  return std::move(sax.model());
}

Result<CityModel> parse(std::string_view text, bool is_city, CityText kind, const Limits& limits) {
  if (text.size() > limits.bytes) {
    return Error{ErrorCode::limit_exceeded, std::to_string(text.size()) + " bytes; the limit is " +
                                                std::to_string(limits.bytes)};
  }
  // The parser takes a NUL for the end of the text and would lose the rest.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    return Error{ErrorCode::malformed, "a JSON text must not contain a NUL byte", nul, {}};
  }
  {
    CitySax quick(is_city, kind, limits);
    if (JsonEvents(text, quick).run()) return finished(quick, text);
  }
  CitySax sax(is_city, kind, limits);
  if (!Json::sax_parse(text.begin(), text.end(), &sax)) return std::move(sax.error());
  return finished(sax, text);
}

}  // namespace

const FaultyVertex* VertexList::fault_of(Index vertex) const {
  const auto found = std::lower_bound(
      faulty.begin(), faulty.end(), vertex,
      [](const FaultyVertex& fault, Index number) { return fault.vertex < number; });
  return found != faulty.end() && found->vertex == vertex ? &*found : nullptr;
}

Json json_of(const std::array<GridNumber, 3>& vertex) {
  Json::array_t axes;
  for (const GridNumber& axis : vertex) axes.push_back(number_of(axis));
  return axes;
}

Result<CityModel> parse_city_model(std::string_view text, CityText kind, const Limits& limits) {
  return parse(text, true, kind, limits);
}

Result<Json> parse_json(std::string_view text, const Limits& limits) {
  auto model = parse(text, false, CityText::document, limits);
  if (!model) return std::move(model).error();
  return std::move(model->root);
}

}  // namespace watertight::formats
