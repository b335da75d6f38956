// SPDX-License-Identifier: GPL-3.0-or-later
//
// The line has the number of source vertices; for each its merged vertex, or "x:y:z" when no ring
// uses it; then, for each ring vertex whose merged vertex has several sources, its source vertex.
#include "pipeline/stored/merged_vertices.h"

#include <array>
#include <charconv>
#include <optional>
#include <vector>

namespace watertight::pipeline {
namespace {

Error malformed(std::string what) {
  return Error{ErrorCode::malformed, "stored vertex merge: " + std::move(what), {}, {}};
}

template <class Number>
void append_number(std::string& line, Number number) {
  std::array<char, 32> buffer{};
  line.append(buffer.data(),
              std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr);
}

/// Cuts the next word off the front of a line.
std::string_view next_word(std::string_view& line) {
  const std::size_t end = line.find(' ');
  const std::string_view word = line.substr(0, end);
  line = end == std::string_view::npos ? std::string_view{} : line.substr(end + 1);
  return word;
}

template <class Number>
std::optional<Number> number_in(std::string_view word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return number;
}

std::optional<Point> point_in(std::string_view word) {
  Point point;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis == 2 ? word.size() : word.find(':');
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = number_in<double>(word.substr(0, end));
    if (!number) return std::nullopt;
    point[axis] = *number;
    word = word.substr(axis == 2 ? end : end + 1);
  }
  return point;
}

/// The number of source vertices of each merged vertex.
std::vector<Index> count_sources(const std::vector<Index>& vertex_of, Index merged_count) {
  std::vector<Index> count(merged_count, 0);
  for (const Index merged : vertex_of) {
    if (merged != kNone) ++count[merged];
  }
  return count;
}

struct SourceVertices {
  std::vector<Point> points;
  std::vector<Index> vertex_of;
};

Result<SourceVertices> read_vertices(const Solid& merged, std::string_view& line,
                                     const Limits& limits) {
  const auto count = number_in<std::uint64_t>(next_word(line));
  if (!count) return malformed("no vertex count");
  if (*count > limits.vertices || *count > line.size()) return malformed("too many vertices");
  SourceVertices source;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const std::string_view word = next_word(line);
    const auto index = number_in<Index>(word);
    if (index && *index < merged.vertex_count()) {
      source.vertex_of.push_back(*index);
      source.points.push_back(merged.vertices()[*index]);
      continue;
    }
    const auto point = point_in(word);
    if (!point) return malformed("vertex " + std::to_string(i));
    source.vertex_of.push_back(kNone);
    source.points.push_back(*point);
  }
  return source;
}

}  // namespace

Result<std::string> describe_merge(const Solid& source, const Solid& merged) {
  if (source == merged) return std::string();
  const geometry::MergedSolid merge = geometry::merge_equal_vertices(source);
  if (!(merge.solid == merged)) {
    return Error{ErrorCode::not_encodable,
                 "the certified solid is not the submitted one with its vertices merged"};
  }
  const std::vector<Index> sources = count_sources(merge.vertex_of, merged.vertex_count());
  std::string line;
  append_number(line, source.vertex_count());
  for (Index vertex = 0; vertex < source.vertex_count(); ++vertex) {
    line += ' ';
    if (merge.vertex_of[vertex] != kNone) {
      append_number(line, merge.vertex_of[vertex]);
      continue;
    }
    const Point& point = source.vertices()[vertex];
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) line += ':';
      append_number(line, point[axis]);
    }
    // "5:6:7" is no index, so the word itself shows whether it is an index or a point.
  }
  for (const Index vertex : source.arrays().ring_vertices) {
    if (sources[merge.vertex_of[vertex]] < 2) continue;
    line += ' ';
    append_number(line, vertex);
  }
  return line;
}

Result<Solid> unmerge(const Solid& merged, std::string_view line, const Limits& limits) {
  auto source = read_vertices(merged, line, limits);
  if (!source) return std::move(source).error();
  const std::vector<Index> sources = count_sources(source->vertex_of, merged.vertex_count());
  std::vector<Index> only_source(merged.vertex_count(), kNone);
  for (Index vertex = 0; vertex < source->vertex_of.size(); ++vertex) {
    if (source->vertex_of[vertex] != kNone) only_source[source->vertex_of[vertex]] = vertex;
  }
  SolidArrays arrays = merged.arrays();
  for (Index& corner : arrays.ring_vertices) {
    const Index vertex = corner;
    if (sources[vertex] == 0) return malformed("vertex " + std::to_string(vertex) + " is missing");
    if (sources[vertex] == 1) {
      corner = only_source[vertex];
      continue;
    }
    const auto chosen = number_in<Index>(next_word(line));
    if (!chosen || *chosen >= source->vertex_of.size() || source->vertex_of[*chosen] != vertex) {
      return malformed("a ring does not use a source of its merged vertex");
    }
    corner = *chosen;
  }
  if (!line.empty()) return malformed("text follows its end");
  arrays.vertices = std::move(source->points);
  return Solid::make(std::move(arrays), merged.lattice(), merged.srid(), limits);
}

}  // namespace watertight::pipeline
