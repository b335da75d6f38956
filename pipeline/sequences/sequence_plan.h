// SPDX-License-Identifier: GPL-3.0-or-later
//
// How the features of a collection become CityJSON sequences. One sequence has one header, so
// features of several documents share one where that changes no coordinate, and else are in
// sequences of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/cancel.h"
#include "formats/city_json/merge_headers.h"
#include "store/solid_store.h"

namespace watertight::pipeline {

/// One of the sequences of a collection.
struct PlannedSequence {
  std::string header;               // its first line
  std::size_t headers = 0;          // the number of different headers of its features
  std::vector<std::string> losses;  // paths of header members that are left out, as they differ
  std::string reason;               // why it is not in the first sequence; "" for the first
};

/// The line of one feature.
struct PlannedLine {
  std::size_t sequence = 0;  // the number of its sequence
  std::string text;          // without a line feed
  bool is_generic = false;   // only the solids are kept: a feature that came without a city model
};

class SequencePlan {
 public:
  /// The most headers that a collection may have.
  static constexpr std::uint64_t kMostHeaders = 5000;

  /// Plans the sequences of a collection, which has at least one. Reads all headers, and features
  /// only if some came without header (OBJ, WKT, ...). Errors: those of the store; not_found (no
  /// collection, no features); unsupported (no transform, coordinates on no decimal grid);
  /// limit_exceeded; cancelled.
  static Result<SequencePlan> make(SolidStore& store, const std::string& collection,
                                   const CancelPoll& is_cancelled = {});

  std::span<const PlannedSequence> sequences() const { return sequences_; }
  /// Whether a feature is in another sequence than this one, if its header alone says so.
  bool is_elsewhere(const store::FeatureRecord& feature, std::size_t sequence) const;
  /// The line of a feature: the very text that came in if its sequence has its vertices as they
  /// are. Errors: malformed when the feature is damaged; unsupported when its document came after
  /// make(); those of write_city_json_feature().
  Result<PlannedLine> line(StoredFeature feature) const;

 private:
  struct Place {
    std::size_t sequence = 0;
    formats::CityHeader header;
    formats::VertexMap map;
  };
  std::vector<PlannedSequence> sequences_;
  std::unordered_map<std::string, Place> places_;  // by header
};

}  // namespace watertight::pipeline
