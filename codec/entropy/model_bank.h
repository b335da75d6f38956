// SPDX-License-Identifier: GPL-3.0-or-later
//
// The adaptive models of a part of the format. Each family of decisions has tables of counters,
// indexed by contexts; weights, which learn too, mix the counters in the logistic domain. All
// arithmetic is on integers, so that every machine computes the same probabilities. A bank starts
// neutral or from a prior, the state that training left behind (docs/format.md, "Models").
// Source: M. Mahoney, "Adaptive weighing of context models for lossless data compression" (2005).
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "codec/entropy/entropy_stream.h"

namespace watertight::codec {

/// The most inputs that a family may have.
inline constexpr std::size_t kMaxInputs = 24;

/// The shape of a family: it has one set of weights for each selector, and input i has a table of
/// `contexts[i]` counters. Inputs end at the first 0.
struct FamilyShape {
  std::uint32_t selectors = 1;
  std::array<std::uint32_t, kMaxInputs> contexts{};
};

/// The shape of a family of numbers (code_number), with at most kMaxInputs - 1 inputs. Each context
/// takes about 160 counters.
struct NumberShape {
  std::uint32_t selectors = 1;
  std::array<std::uint32_t, kMaxInputs> contexts{};
};

/// The models of a bank. A family is named by its place in `families`, a number by its place in
/// `numbers`.
struct ModelLayout {
  std::span<const FamilyShape> families;
  std::span<const NumberShape> numbers;
  bool is_agile = false;  // weights begin at the mean of the inputs and move twice as fast
};

/// Says how much of a trained bank a prior keeps.
struct PriorShape {
  std::uint32_t max_count = 10;   // observations that a counter keeps: so a bank still adapts
  std::uint32_t least_count = 1;  // counters with fewer observations are stored as new ones
  bool has_weights = true;        // else all inputs of a family start with the same weight
};

class ModelBank {
 public:
  explicit ModelBank(const ModelLayout& layout);

  /// Codes one decision of `family`, then learns from it. Requires selector and contexts below
  /// what the shape says, and as many contexts as it has tables. Cost: linear in the contexts.
  bool code(EntropyStream& stream, std::uint32_t family, std::uint32_t selector,
            std::span<const std::uint32_t> contexts, bool value);
  bool code(EntropyStream& stream, std::uint32_t family, std::uint32_t selector,
            std::initializer_list<std::uint32_t> contexts, bool value) {
    return code(stream, family, selector, std::span(contexts.begin(), contexts.size()), value);
  }
  /// The probability, of 65536, with which code() would code this decision.
  std::uint32_t probability(std::uint32_t family, std::uint32_t selector,
                            std::span<const std::uint32_t> contexts) const;

  /// Codes a number that is not negative: its bit length in unary and the three bits after the
  /// first under mixed models, the rest in plain bits. Requires value < 2^62. A bit length above
  /// `max_length` fails the stream.
  std::uint64_t code_number(EntropyStream& stream, std::uint32_t number, std::uint32_t selector,
                            std::initializer_list<std::uint32_t> contexts, std::uint64_t value,
                            int max_length = 62);
  /// Codes the magnitude in the same way, then the sign under the same contexts.
  std::int64_t code_signed(EntropyStream& stream, std::uint32_t number, std::uint32_t selector,
                           std::initializer_list<std::uint32_t> contexts, std::int64_t value,
                           int max_length = 62);

  /// save() returns the state as bytes, load() sets it. load() returns false and leaves the bank
  /// neutral if the bytes are no state of this layout.
  Bytes save(const PriorShape& shape) const;
  bool load(ByteView state);

  /// For reports on sizes.
  std::size_t counter_count() const { return counters_.size(); }

 private:
  struct Family {
    std::uint32_t inputs = 0;
    std::uint32_t selectors = 0;
    std::uint32_t first_weight = 0;
    std::uint32_t first_rate = 0;
    std::array<std::uint32_t, kMaxInputs> first_counter{};
    std::array<std::uint32_t, kMaxInputs> sizes{};
  };
  /// The inputs of one decision and the probability that their weighted sum gives. Only as many
  /// elements are set as the family has inputs: clearing the rest took a third of the time of
  /// mix().
  struct Mix {
    Mix() {}  // NOLINT(modernize-use-equals-default, cppcoreguidelines-pro-type-member-init)
    std::array<std::uint32_t, kMaxInputs> counter;
    std::array<std::int32_t, kMaxInputs + 1> input;
    std::uint32_t ones;
  };
  /// A change that a trial made: its place (counters, then weights, then decisions seen) and the
  /// value before.
  struct Change {
    std::uint32_t place = 0;
    std::uint32_t before = 0;
  };
  friend class BankTrial;
  [[gnu::noinline]] void note_changes(const Family& family, std::uint32_t selector,
                                      const Mix& mixed);
  void undo(const Change& change);
  void add_family(const FamilyShape& shape);
  std::int32_t first_weight(std::uint32_t inputs) const;
  Mix mix(const Family& family, std::uint32_t selector, const std::uint32_t* contexts) const;
  bool code_at(EntropyStream& stream, const Family& family, std::uint32_t selector,
               const std::uint32_t* contexts, bool value);

  bool is_agile_ = false;
  std::vector<Family> families_;
  std::size_t number_base_ = 0;          // first family of numbers
  std::vector<std::uint32_t> counters_;  // 22 bits of probability, 10 of count
  std::vector<std::int32_t> weights_;    // 16.16
  std::vector<std::uint32_t> mixed_;     // decisions seen by each weight set
  std::vector<Change> changes_;          // since the beginning of the outermost trial
  int trials_ = 0;                       // trials that live now
};

/// While a trial lives, the bank may code what is only measured; when the trial ends, the bank is
/// as it was before. Trials may be nested. Cost: for a solid of few vertices each change is noted,
/// for one of many the bank is copied.
class BankTrial {
 public:
  BankTrial(ModelBank& bank, std::size_t vertices);
  ~BankTrial();
  BankTrial(const BankTrial&) = delete;
  BankTrial& operator=(const BankTrial&) = delete;

 private:
  ModelBank& bank_;
  std::optional<ModelBank> before_;  // for many vertices: the copy
  std::size_t begin_;                // for few: where the changes of this trial begin
};

}  // namespace watertight::codec
