// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/entropy/bank_trial.h"

#include <utility>

namespace watertight::codec {

BankTrial::BankTrial(ModelBank& bank, std::size_t vertices)
    : bank_(bank), first_change_(bank.changes_.size()) {
  // A coded vertex changes some hundred values of the bank. To note a value takes several times as
  // long as to copy it.
  constexpr std::size_t kCountersPerVertex = 1000;
  if (vertices > bank.counters_ / kCountersPerVertex) {
    before_ = bank;
  } else {
    ++bank.trials_;
  }
}

void BankTrial::keep() { is_kept_ = true; }

BankTrial::~BankTrial() {
  if (before_) {
    if (!is_kept_) bank_ = *std::move(before_);
    return;
  }
  --bank_.trials_;
  if (!is_kept_) bank_.undo(first_change_);
  if (bank_.trials_ == 0) bank_.changes_.clear();
}

}  // namespace watertight::codec
