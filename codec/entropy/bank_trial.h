// SPDX-License-Identifier: GPL-3.0-or-later
//
// A trial: a stretch of measuring after which a bank of models is as it was before.
#pragma once

#include <cstddef>
#include <optional>

#include "codec/entropy/model_bank.h"

namespace watertight::codec {

/// While a trial lives, the bank codes what is only measured; the end of the trial undoes what the
/// bank learned, unless it is to be kept. Trials may be nested. Cost: for a solid of few vertices,
/// noting and undoing each change of the bank; for one of many vertices, a copy of the bank.
class BankTrial {
 public:
  BankTrial(ModelBank& bank, std::size_t vertices);
  ~BankTrial();
  BankTrial(const BankTrial&) = delete;
  BankTrial& operator=(const BankTrial&) = delete;
  /// Makes the end of the trial undo nothing: what the bank learned stays. Requires that all trials
  /// within this one have ended.
  void keep();

 private:
  ModelBank& bank_;
  std::optional<ModelBank> before_;  // the copy, for a solid of many vertices
  std::size_t first_change_;  // if there is no copy: the index of this trial's first change in the
                              // bank's list
  bool is_kept_ = false;
};

}  // namespace watertight::codec
