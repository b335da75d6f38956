// SPDX-License-Identifier: GPL-3.0-or-later
//
// Limited quantities that requests share: memory, places. Internal to server/.
#pragma once

#include <atomic>
#include <cstdint>

namespace watertight::server {

/// A limited quantity that several threads take from and give back to.
class Budget {
 public:
  explicit Budget(std::uint64_t amount) : total_(amount), left_(amount) {}
  std::uint64_t total() const { return total_; }
  /// Takes the amount, or nothing if less is left.
  bool take(std::uint64_t amount) {
    std::uint64_t left = left_;
    while (left >= amount) {
      if (left_.compare_exchange_weak(left, left - amount)) return true;
    }
    return false;
  }
  void give_back(std::uint64_t amount) { left_ += amount; }

 private:
  std::uint64_t total_;
  std::atomic<std::uint64_t> left_;
};

/// A share of a Budget that is held while it lives.
class BudgetShare {
 public:
  BudgetShare(Budget& budget, std::uint64_t amount)
      : budget_(budget),
        amount_(budget.take(amount) ? amount : 0),
        is_granted_(amount_ == amount) {}
  /// Makes the share at least `amount`. False when the budget has not so much left.
  bool grow_to(std::uint64_t amount) {
    if (amount <= amount_) return true;
    if (!budget_.take(amount - amount_)) return false;
    amount_ = amount;
    return true;
  }
  ~BudgetShare() { budget_.give_back(amount_); }
  BudgetShare(const BudgetShare&) = delete;
  BudgetShare& operator=(const BudgetShare&) = delete;
  bool is_granted() const { return is_granted_; }

 private:
  Budget& budget_;
  std::uint64_t amount_;
  bool is_granted_;
};

}  // namespace watertight::server
