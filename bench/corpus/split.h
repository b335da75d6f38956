// SPDX-License-Identifier: GPL-3.0-or-later
//
// The division of a corpus into solids that train the models of the codec and solids that test
// them.
// Within a set, blocks of 64 consecutive solids are training and test in turn; sets that are
// excluded from training are test only. A test solid at the site of a training solid (the same
// building in another release, level of detail or file) is left out.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "bench/corpus/corpus.h"
#include "codec/page/container.h"

namespace watertight {

inline constexpr std::size_t kBlock = 64;

/// Solids of one set and one frame, in their order.
struct CorpusPage {
  std::string set;
  bool is_test = false;
  codec::Frame frame;
  std::vector<std::size_t> solids;  // indices into the corpus
};

/// Pages of at most `most` solids, which are neighbours within the training or the test half.
/// Solids without a grid are in no page. `stored` holds the solids of the corpus as stored_solid()
/// makes them.
std::vector<CorpusPage> split_corpus(const std::vector<CorpusSolid>& corpus,
                                     const std::vector<codec::PageSolid>& stored,
                                     const std::set<std::string>& excluded, std::size_t most);

}  // namespace watertight
