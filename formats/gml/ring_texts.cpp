// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/ring_texts.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace watertight::formats {

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
