// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/outcome_json.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace watertight {
namespace {

/// Writes JSON objects and arrays member by member; the caller keeps them balanced.
class JsonText {
 public:
  JsonText& open(char bracket) { return punctuate().put(bracket, true); }
  JsonText& close(char bracket) { return put(bracket, false); }
  JsonText& key(std::string_view name) {
    punctuate();
    text_ += json_string(name);
    text_ += ':';
    is_first_ = true;
    return *this;
  }
  JsonText& value(std::string_view string) { return raw(json_string(string)); }
  JsonText& value(bool truth) { return raw(truth ? "true" : "false"); }
  JsonText& value(double number) {
    if (!std::isfinite(number)) return raw("null");
    return write_number(number);
  }
  JsonText& value(std::int64_t number) { return write_number(number); }
  JsonText& value(std::uint64_t number) { return write_number(number); }
  JsonText& value(Index number) { return write_number(number); }
  JsonText& value(const std::array<double, 3>& point) {
    open('[');
    for (const double coordinate : point) value(coordinate);
    return close(']');
  }
  JsonText& raw(std::string_view json) {
    punctuate();
    text_ += json;
    return *this;
  }
  std::string take() { return std::move(text_); }

 private:
  template <class Number>
  JsonText& write_number(Number number) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
    return raw(std::string_view(buffer.data(), static_cast<std::size_t>(end - buffer.data())));
  }
  JsonText& punctuate() {
    if (!is_first_) text_ += ',';
    is_first_ = false;
    return *this;
  }
  JsonText& put(char bracket, bool is_first) {
    text_ += bracket;
    is_first_ = is_first;
    return *this;
  }

  std::string text_;
  bool is_first_ = true;
};

void write_solid(JsonText& json, const SolidOutcome& solid) {
  const SolidSource& source = solid.source;
  json.open('{').key("object").value(source.object_id);
  json.key("geometryType").value(source.geometry_type);
  if (!source.lod.empty()) json.key("lod").value(source.lod);
  json.key("geometry").value(source.geometry).key("ordinal").value(source.ordinal);
  if (!source.pointer.empty()) json.key("pointer").value(source.pointer);
  if (solid.blob_bytes > 0) json.key("blobBytes").value(std::uint64_t{solid.blob_bytes});
  json.key("report").raw(solid.report_json).close('}');
}

/// Length of the UTF-8 sequence at the front, 0 if it is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  const unsigned second = byte(1);
  const bool is_overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool is_outside = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return is_overlong || is_outside ? 0 : length;
}

}  // namespace

std::string json_string(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string json = "\"";
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const char c = text.front();
    if (length == 0) {
      json += "\xEF\xBF\xBD";
    } else if (c == '"' || c == '\\') {
      json += '\\';
      json += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      json += "\\u00";
      json += kHex[static_cast<unsigned char>(c) / 16U];
      json += kHex[static_cast<unsigned char>(c) % 16U];
    } else {
      json += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return json + '"';
}

std::string measures_json(const Measures& measures) {
  JsonText json;
  json.open('{').key("volume").value(measures.volume).key("area").value(measures.area);
  json.key("boxMin").value(measures.box_min).key("boxMax").value(measures.box_max);
  json.key("genus").value(measures.genus).key("vertices").value(measures.vertices);
  json.key("facets").value(measures.facets).key("rings").value(measures.rings);
  json.key("shells").value(measures.shells).close('}');
  return json.take();
}

std::string outcome_json(const IngestOutcome& outcome) {
  JsonText json;
  json.open('{').key("verdict").value(to_string(outcome.verdict));
  json.key("stored").value(std::uint64_t{outcome.stored});
  json.key("features").open('[');
  for (const FeatureOutcome& feature : outcome.features) {
    json.open('{').key("id").value(feature.id);
    json.key("verdict").value(to_string(feature.verdict));
    json.key("stored").value(feature.is_stored).key("solids").open('[');
    for (const SolidOutcome& solid : feature.solids) write_solid(json, solid);
    json.close(']').close('}');
  }
  json.close(']').close('}');
  return json.take();
}

}  // namespace watertight
