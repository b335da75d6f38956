// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/ring_texts.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>

namespace watertight::formats {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

/// The numbers of a ring as they are written, one blank after each; in the order of its positions
/// or in the opposite order. Empty where the numbers are not three for each position.
std::string positions_of(std::string_view text, bool is_reversed) {
  std::vector<std::string_view> numbers;
  for (std::size_t at = 0; (at = text.find_first_not_of(kBlanks, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    numbers.push_back(text.substr(at, end - at));
    at = end;
  }
  std::string positions;
  if (numbers.size() % 3 != 0) return positions;
  const std::size_t count = numbers.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = 3 * (is_reversed ? count - 1 - i : i);
    for (std::size_t axis = 0; axis < 3; ++axis)
      positions.append(numbers[first + axis]).append(" ");
  }
  return positions;
}

}  // namespace

void find_copies(const GmlModel& model, std::span<GmlRingUse> uses) {
  const auto is_unused = [&](Index node) {
    return model.nodes[node].kind == GmlKind::ring && uses[node].solid == kNone;
  };
  std::vector<Index> unused;
  for (Index node = 0; node < model.nodes.size(); ++node) {
    if (is_unused(node)) unused.push_back(node);
  }
  if (unused.empty()) return;
  const auto text_of = [&](Index node, bool is_reversed) {
    return positions_of(model.numbers(model.nodes[node].positions), is_reversed);
  };
  std::unordered_map<std::string, Index> used;
  for (Index node = 0; node < model.nodes.size(); ++node) {
    if (uses[node].solid != kNone) used.emplace(text_of(node, false), node);
  }
  for (const Index node : unused) {
    for (const bool is_reversed : {false, true}) {
      const auto found = used.find(text_of(node, is_reversed));
      if (found == used.end() || found->first.empty()) continue;
      uses[node] = uses[found->second];
      uses[node].is_reversed = uses[node].is_reversed != is_reversed;
      break;
    }
  }
}

std::vector<RingText> ring_texts(const GmlModel& model, std::span<const GmlRingUse> uses,
                                 ByteView bytes) {
  const std::string_view document = as_text(bytes);
  const auto& elements = model.numbers_of_rings;
  std::vector<RingText> texts;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Index node = elements[i].ring;
    const GmlRingUse& use = uses[node];
    if (use.solid == kNone || elements[i].content > document.size()) continue;
    const bool is_first = i == 0 || elements[i - 1].ring != node;
    const bool is_last = i + 1 == elements.size() || elements[i + 1].ring != node;
    RingText text;
    text.at = elements[i].content;
    text.size = std::min(document.find('<', text.at), document.size()) - text.at;
    text.solid = use.solid;
    text.ring = use.ring;
    text.is_whole = is_first && is_last;
    text.is_reversed = use.is_reversed;
    text.is_y_first = use.is_y_first;
    if (!is_first && !texts.empty()) text.position = texts.back().position + 1;
    texts.push_back(text);
  }
  return texts;
}

}  // namespace watertight::formats
