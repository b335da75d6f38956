// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/families.h"

#include <algorithm>
#include <array>

#include "codec/mode_parallelogram/axis_places.h"
#include "codec/page/modes.h"

namespace watertight::codec::parallelogram {

using namespace parallelogram;

namespace {

constexpr FamilyShape close_family() {
  FamilyShape family{3, {}};
  std::copy(kCloseSizes.begin(), kCloseSizes.end(), family.contexts.begin());
  return family;
}

}  // namespace

const ModelLayout& model_layout() {
  static constexpr std::array<FamilyShape, kFamilyCount> kFamilies{
      FamilyShape{1, {1}},
      FamilyShape{1, {2}},
      FamilyShape{1, {1}},
      close_family(),
      FamilyShape{1, {32, 32, 64, 8 * 64}},
      FamilyShape{3, {kPatterns * 12, 8 * 12, kPatterns * 24, kPatterns * 7}},
      FamilyShape{5, {5 * kPatterns, 15 * 8}},
      kPlacesFamily,
      FamilyShape{1, {1}},
      FamilyShape{kGuesses - 1,
                  {kGuesses * kGuesses * kGuesses, kGuesses * kGuesses * kGuesses,
                   kGuesses * kGuesses * kGuesses, kGuesses * kSpans, kGuesses * kErrors,
                   kGuesses * kDistances * kDistances}}};
  static constexpr std::array<NumberShape, kNumberCount> kNumbers{
      NumberShape{1, {2, 64}}, NumberShape{1, {3, 64}},
      NumberShape{
          6,
          {kErrors * kParts * 3, kErrors * kMisses * 3, (kSpans + kGuesses) * kMisses * kParts,
           kErrors * kSpreads * kMisses, kErrors * kErrors * 3, kErrors}},
      NumberShape{1, {1}}, kPlacesNumber};
  static const ModelLayout kLayout{kFamilies, kNumbers, true};
  return kLayout;
}

}  // namespace watertight::codec::parallelogram
