// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/source/source_elements.h"

#include <cstddef>

namespace watertight::validate {
namespace {

template <class Value>
Value entry(std::span<const Value> list, std::size_t number) {
  return number < list.size() ? list[number] : Value{};
}

}  // namespace

SourceElement element_at(const Place& place, const Solid& solid, const SourceElements& elements) {
  SourceElement element;
  element.line = elements.line;
  if (place.facet == kNone || place.facet >= solid.facet_count()) return element;
  element.polygon = entry(elements.facet_ids, place.facet);
  const std::uint64_t facet_line = entry(elements.facet_lines, place.facet);
  if (facet_line != 0) element.line = facet_line;
  const IndexRange rings = solid.rings_of(place.facet);
  if (place.ring == kNone || place.ring >= rings.size()) return element;
  const std::size_t ring = std::size_t{rings.begin} + place.ring;
  element.ring = entry(elements.ring_ids, ring);
  const std::uint64_t ring_line = entry(elements.ring_lines, ring);
  if (ring_line != 0) element.line = ring_line;
  return element;
}

void name_elements(const Solid& solid, const SourceElements& elements, Finding& finding) {
  finding.source = element_at(finding.place, solid, elements);
  if (finding.other) finding.other_source = element_at(*finding.other, solid, elements);
}

}  // namespace watertight::validate
