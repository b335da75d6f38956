// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fingerprint.h"

#include <filesystem>

#include "base/json_text.h"
#include "report/number_text.h"
#include "report/place.h"

namespace watertight::report {
namespace {

/// FNV-1a, 64 bits.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001B3U;
  }
  return hash;
}

/// Separates the parts of a key. Line feeds within a part become blanks.
constexpr char kEnd = '\n';

/// A text as a JSON report gives it back.
std::string part(std::string_view text) {
  std::string clean = utf8_text(text);
  for (char& c : clean) {
    if (c == kEnd) c = ' ';
  }
  return clean + kEnd;
}

void append_index(std::string& text, Index index) {
  if (index != kNone) text += std::to_string(index);
  text += kEnd;
}

std::string key_of(const FindingSide& side, bool has_place) {
  std::string key = part(side.object) + part(side.lod);
  if (!has_place) return key;
  for (const Index index :
       {side.place.shell, side.place.facet, side.place.ring, side.place.vertex}) {
    append_index(key, index);
  }
  return key;
}

FindingSide side_of(const pipeline::InspectedFeature& feature, Index solid, const Place& place) {
  if (solid >= feature.solids.size()) return {{}, {}, place};
  const SolidSource& source = feature.solids[solid].source;
  return {source.object_id, source.lod, place};
}

}  // namespace

std::uint64_t fingerprint_of(const FindingIdentity& identity) {
  std::string key = part(plain_file_name(identity.file));
  key += std::to_string(identity.code);
  key += kEnd;
  const bool has_place = !identity.witness;
  std::string first = key_of(identity.side, has_place);
  std::string second = identity.other ? key_of(*identity.other, has_place) : std::string();
  if (second < first) std::swap(first, second);
  key += first;
  key += second;
  if (identity.witness) key += point_text(*identity.witness);
  return hash_of(key);
}

std::string plain_file_name(std::string_view file) {
  return std::filesystem::path(file).lexically_normal().generic_string();
}

std::vector<IdentifiedFinding> identified_findings(std::string_view file,
                                                   const pipeline::InspectedFeature& feature) {
  std::vector<IdentifiedFinding> all;
  for (const PlacedFinding& placed : findings_of(feature)) {
    const Finding& finding = *placed.finding;
    FindingIdentity identity{
        file, finding.code, side_of(feature, placed.solid, finding.place), {}, finding.witness};
    if (finding.other) identity.other = side_of(feature, placed.other_solid, *finding.other);
    all.push_back({&finding, fingerprint_of(identity)});
  }
  return all;
}

}  // namespace watertight::report
