// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/corpus/split.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace watertight {
namespace {

/// The least and greatest x and y of a solid, rounded to multiples of 500 steps.
using Site = std::array<std::int64_t, 4>;

Site site_of(const codec::PageSolid& stored) {
  std::array<std::int64_t, 2> low{INT64_MAX, INT64_MAX};
  std::array<std::int64_t, 2> high{INT64_MIN, INT64_MIN};
  for (const codec::GridPoint& vertex : stored.integers->vertices) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], vertex[axis]);
      high[axis] = std::max(high[axis], vertex[axis]);
    }
  }
  constexpr std::int64_t kUnit = 500;
  return {low[0] / kUnit, low[1] / kUnit, high[0] / kUnit, high[1] / kUnit};
}

/// The page with this frame that has room, or a new page.
CorpusPage& page_for(std::vector<CorpusPage>& pages, const CorpusPage& wanted, std::size_t most) {
  const auto page = std::find_if(pages.rbegin(), pages.rend(), [&](const CorpusPage& other) {
    return other.set == wanted.set && other.is_test == wanted.is_test &&
           other.frame == wanted.frame;
  });
  if (page != pages.rend() && page->solids.size() < most) return *page;
  pages.push_back(wanted);
  return pages.back();
}

}  // namespace

std::vector<CorpusPage> split_corpus(const std::vector<CorpusSolid>& corpus,
                                     const std::vector<codec::PageSolid>& stored,
                                     const std::set<std::string>& excluded, std::size_t most) {
  std::map<std::string, std::size_t> seen;  // the number of solids of each set so far
  std::vector<bool> is_test(corpus.size(), false);
  std::set<Site> training;
  for (std::size_t i = 0; i < corpus.size(); ++i) {
    if (!stored[i].integers) continue;
    const std::size_t number = seen[corpus[i].set]++;
    is_test[i] = excluded.contains(corpus[i].set) || (number / kBlock) % 2 == 1;
    if (!is_test[i]) training.insert(site_of(stored[i]));
  }
  std::vector<CorpusPage> pages;
  for (std::size_t i = 0; i < corpus.size(); ++i) {
    if (!stored[i].integers || (is_test[i] && training.contains(site_of(stored[i])))) continue;
    const codec::Frame frame =
        codec::frame_of(corpus[i].canonical.boundary.solid(), corpus[i].acceptance);
    page_for(pages, {corpus[i].set, is_test[i], frame, {}}, most).solids.push_back(i);
  }
  return pages;
}

}  // namespace watertight
