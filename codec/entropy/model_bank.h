// SPDX-License-Identifier: GPL-3.0-or-later
//
// The adaptive models of a part of the format. Each family of decisions has tables of counters,
// indexed by contexts; weights, which learn too, mix the counters in the logistic domain. All
// arithmetic is on integers, so that every machine computes the same probabilities. A bank starts
// neutral or from a prior, the state that training left behind (docs/format.md, "Models").
// Source: M. Mahoney, "Adaptive weighing of context models for lossless data compression" (2005).
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_layout.h"

namespace watertight::codec {

/// Says how much of a trained bank a prior keeps.
struct PriorShape {
  std::uint32_t max_count = 10;   // the most observations that a counter keeps: so a bank still
                                  // adapts
  std::uint32_t least_count = 1;  // counters with fewer observations are stored as new ones
  bool has_weights = true;        // false: all inputs of a family start with the same weight
};

class ModelBank {
 public:
  explicit ModelBank(const ModelLayout& layout);

  /// Codes one decision of `family`, an enumerator of the bank's Family, then learns from it.
  /// Returns the answer: `value`, or the one that was read. Without a selector: requires a family
  /// with one set of weights. Cost: linear in the contexts.
  template <auto family>
  bool code(EntropyStream& stream, SelectorOf<family> selector, const ContextsOf<family>& contexts,
            bool value) {
    static_assert(std::same_as<decltype(shape_of(family)), const FamilyShape&>);
    return code(stream, family, selector.value, contexts.values, value);
  }
  template <auto family>
  bool code(EntropyStream& stream, const ContextsOf<family>& contexts, bool value) {
    return code<family>(stream, kNothingKnown, contexts, value);
  }
  /// The probability of a yes, in 1/65536, with which code() would code this decision.
  template <auto family>
  std::uint32_t probability(SelectorOf<family> selector, const ContextsOf<family>& contexts) const {
    static_assert(std::same_as<decltype(shape_of(family)), const FamilyShape&>);
    return probability(family, selector.value, contexts.values);
  }

  /// Codes a number that is not negative, by an enumerator of the bank's Number: its bit length in
  /// unary and the three bits after the first under mixed models, the rest in plain bits. Requires
  /// value < 2^62. A bit length above `max_length` fails the stream.
  template <auto number>
  std::uint64_t code_number(EntropyStream& stream, SelectorOf<number> selector,
                            const ContextsOf<number>& contexts, std::uint64_t value,
                            int max_length = 62) {
    static_assert(std::same_as<decltype(shape_of(number)), const NumberShape&>);
    return code_number(stream, number, selector.value, contexts.values, value, max_length);
  }
  template <auto number>
  std::uint64_t code_number(EntropyStream& stream, const ContextsOf<number>& contexts,
                            std::uint64_t value, int max_length = 62) {
    return code_number<number>(stream, kNothingKnown, contexts, value, max_length);
  }
  /// Codes the magnitude of a number as code_number() does, then its sign under the same contexts.
  template <auto number>
  std::int64_t code_signed(EntropyStream& stream, SelectorOf<number> selector,
                           const ContextsOf<number>& contexts, std::int64_t value,
                           int max_length = 62) {
    static_assert(std::same_as<decltype(shape_of(number)), const NumberShape&>);
    return code_signed(stream, number, selector.value, contexts.values, value, max_length);
  }
  template <auto number>
  std::int64_t code_signed(EntropyStream& stream, const ContextsOf<number>& contexts,
                           std::int64_t value, int max_length = 62) {
    return code_signed<number>(stream, kNothingKnown, contexts, value, max_length);
  }

  /// These functions take the family by its number, whose type is not checked, for banks of any
  /// layout. They require as many contexts as the family has inputs, each below the size of its
  /// table, and a selector that the family has.
  bool code(EntropyStream& stream, std::uint32_t family, std::uint32_t selector,
            std::span<const std::uint32_t> contexts, bool value);
  std::uint32_t probability(std::uint32_t family, std::uint32_t selector,
                            std::span<const std::uint32_t> contexts) const;
  std::uint64_t code_number(EntropyStream& stream, std::uint32_t number, std::uint32_t selector,
                            std::span<const std::uint32_t> contexts, std::uint64_t value,
                            int max_length = 62);
  std::int64_t code_signed(EntropyStream& stream, std::uint32_t number, std::uint32_t selector,
                           std::span<const std::uint32_t> contexts, std::int64_t value,
                           int max_length = 62);

  /// Notes all changes from now on, so that take_back() can undo them, until they are so many that
  /// a copy of the bank costs less. Requires a bank in no trial.
  void note_from_now();
  /// Undoes all changes since note_from_now(). Returns false, and undoes nothing, if they were too
  /// many.
  bool take_back();

  /// save() returns the state of the bank as bytes, load() sets it. load() returns false and
  /// changes nothing if the bytes are no state of this layout.
  Bytes save(const PriorShape& shape) const;
  bool load(ByteView state);

 private:
  struct Family {
    std::uint32_t inputs = 0;
    std::uint32_t selectors = 0;
    std::uint32_t first_weight = 0;  // indices in values_
    std::uint32_t first_rate = 0;
    std::array<std::uint32_t, kMaxInputs> first_counter{};
    std::array<std::uint32_t, kMaxInputs> sizes{};
  };
  /// The inputs of one decision and the probability that their weighted sum gives. Only as many
  /// elements are set as the family has inputs: clearing the other elements took a third of the
  /// time of mix().
  struct Mix {
    Mix() {}  // NOLINT(modernize-use-equals-default, cppcoreguidelines-pro-type-member-init)
    std::array<std::uint32_t, kMaxInputs> counter;
    std::array<std::int32_t, kMaxInputs + 1> input;
    std::uint32_t ones;
  };
  /// A value that changed during a trial: its index in values_, and the value that it had before.
  struct Change {
    std::uint32_t index = 0;
    std::uint32_t before = 0;
  };
  friend class BankTrial;
  [[gnu::noinline]] void note_changes(const Family& family, std::uint32_t selector,
                                      const Mix& mixed);
  /// Undoes the latest changes, until `left` are left.
  void undo(std::size_t left);
  void add_family(const FamilyShape& shape);
  void set_first_values();
  std::int32_t first_weight(std::uint32_t inputs) const;
  template <class Count>
  Mix mix(Count inputs, const Family& family, const std::uint32_t* weight,
          const std::uint32_t* contexts) const;
  template <class Count>
  bool code_at(Count inputs, EntropyStream& stream, const Family& family, std::uint32_t selector,
               const std::uint32_t* contexts, bool value);
  bool code_at(EntropyStream& stream, const Family& family, std::uint32_t selector,
               const std::uint32_t* contexts, bool value);

  bool is_agile_ = false;
  std::vector<Family> families_;
  std::size_t number_base_ = 0;  // index in families_ of the first family of the first number
  std::size_t counters_ = 0;     // the number of counters
  std::size_t weights_ = 0;      // the number of weights
  std::size_t rates_ = 0;        // the number of sets of weights
  /// What the bank learns, in one array so that a change is an index and a value: the counters (22
  /// bits of probability, 10 of count), the weights (the bits of signed fixed-point
  /// numbers, 16.16), then for each set of weights the decisions that it mixed, at most 1000.
  std::vector<std::uint32_t> values_;
  std::vector<Change> changes_;  // all changes since the beginning of the outermost trial
  int trials_ = 0;  // number of trials that live now and note changes; note_from_now() is one
  bool is_noting_ = false;  // the outermost trial is that of note_from_now()
};

}  // namespace watertight::codec
