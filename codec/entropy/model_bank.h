// SPDX-License-Identifier: GPL-3.0-or-later
//
// The adaptive models of a part of the format: for each family of decisions some tables of counters
// indexed by context, mixed in the logistic domain by weights that learn too. Integers only, so
// that every machine computes the same probabilities. A bank starts neutral or from a prior, the
// state that training left behind (docs/format.md, "Models").
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

/// At most this many contexts of a decision are mixed.
inline constexpr std::size_t kMaxInputs = 24;

/// The shape of a family: one weight set per selector, one table of `contexts[i]` counters per
/// input; inputs end at the first 0.
struct FamilyShape {
  std::uint32_t selectors = 1;
  std::array<std::uint32_t, kMaxInputs> contexts{};
};

/// The shape of a family of numbers (code_number), with at most kMaxInputs - 1 inputs. Takes about
/// 160 counters per context.
struct NumberShape {
  std::uint32_t selectors = 1;
  std::array<std::uint32_t, kMaxInputs> contexts{};
};

/// Families and numbers are each numbered in the order of the layout.
struct ModelLayout {
  std::span<const FamilyShape> families;
  std::span<const NumberShape> numbers;
  bool is_agile = false;  // weights begin at the mean of the inputs and move twice as fast
};

/// What of a trained bank a prior keeps.
struct PriorShape {
  std::uint32_t max_count = 10;   // confidence in counters: a bank still adapts
  std::uint32_t least_count = 1;  // counters seen less often are as good as new
  bool has_weights = true;        // else the inputs count alike, and the weights adapt fast
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
  /// The probability of 65536 that code() would code this decision with.
  std::uint32_t probability(std::uint32_t family, std::uint32_t selector,
                            std::span<const std::uint32_t> contexts) const;

  /// A number from 0 on: its bit length in unary and the three bits after the first by mixed
  /// models, the rest plain. Requires value < 2^62. Bit lengths above `max_length` fail the stream.
  std::uint64_t code_number(EntropyStream& stream, std::uint32_t number, std::uint32_t selector,
                            std::initializer_list<std::uint32_t> contexts, std::uint64_t value,
                            int max_length = 62);
  /// The same for magnitude and sign, the sign under the same contexts.
  std::int64_t code_signed(EntropyStream& stream, std::uint32_t number, std::uint32_t selector,
                           std::initializer_list<std::uint32_t> contexts, std::int64_t value,
                           int max_length = 62);

  /// The state as bytes, and back. load() is false (and the bank neutral) if the bytes are
  /// no state of this layout.
  Bytes save(const PriorShape& shape) const;
  bool load(ByteView state);

  /// Sizes, for reports.
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
  /// What a decision is coded with: the counters' opinions and their weighted sum. Only as many as
  /// the family has inputs are ever set: clearing the rest took a third of the time of mix().
  struct Mix {
    Mix() {}  // NOLINT(modernize-use-equals-default, cppcoreguidelines-pro-type-member-init)
    std::array<std::uint32_t, kMaxInputs> counter;
    std::array<std::int32_t, kMaxInputs + 1> input;
    std::uint32_t ones;
  };
  /// A change of a trial: the place (counters, then weights, then decisions seen) and what was
  /// there.
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
  std::vector<Change> changes_;          // since the first trial that goes on
  int trials_ = 0;                       // that go on
};

/// While it lives, the bank may code what is only measured; then the bank is as before. Trials may
/// be nested. Cost: for a solid of few vertices that of noting each change, else a copy of the
/// bank.
class BankTrial {
 public:
  BankTrial(ModelBank& bank, std::size_t vertices);
  ~BankTrial();
  BankTrial(const BankTrial&) = delete;
  BankTrial& operator=(const BankTrial&) = delete;

 private:
  ModelBank& bank_;
  std::optional<ModelBank> before_;  // of many vertices
  std::size_t begin_;                // of few: in the changes
};

}  // namespace watertight::codec
