// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/entropy/bank_trial.h"

#include <utility>
#include <vector>

namespace watertight::codec {

BankTrial::BankTrial(ModelBank& bank, std::size_t vertices)
    : bank_(bank), first_change_(bank.changes_.size()) {
  // A coded vertex changes some hundred values of the bank. To note a value takes several times as
  // long as to copy it.
  constexpr std::size_t kCountersPerVertex = 1000;
  if (vertices > bank.counters_.size() / kCountersPerVertex) {
    before_ = bank;
  } else {
    ++bank.trials_;
  }
}

BankTrial::~BankTrial() {
  if (before_) {
    bank_ = *std::move(before_);
    return;
  }
  std::vector<ModelBank::Change>& changes = bank_.changes_;
  for (; changes.size() > first_change_; changes.pop_back()) bank_.undo(changes.back());
  --bank_.trials_;
}

}  // namespace watertight::codec
