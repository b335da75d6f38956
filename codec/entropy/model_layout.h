// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a part of the format declares its models: an enum Family and an enum Number with the names of
// the format's text, in its order, and a table of shapes for each. Beside the tables, two functions
// shape_of(Family) and shape_of(Number) return a row; through them ModelBank::code<family>() checks
// the type of each context against the table when it is compiled.
//
// None of these declarations is in an anonymous namespace: g++ 12 instantiates
// ModelBank::code<family>() of an enumerator without linkage as a symbol that the linker merges
// with that of another file.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "codec/entropy/context.h"

namespace watertight::codec {

/// At most this many contexts of a decision are mixed.
inline constexpr std::size_t kMaxInputs = 24;

/// The shape of a family of decisions: one set of weights for each selector, one table of counters
/// for each input. `inputs` has the sizes of the tables and ends at the first 0.
struct FamilyShape {
  std::uint32_t family = 0;  // the enumerator of the family, which is the index of its row
  std::uint32_t selectors = 1;
  std::array<std::uint32_t, kMaxInputs> inputs{};
};

/// The shape of a family of whole numbers, which ModelBank makes into three families of decisions.
/// It has at most kMaxInputs - 1 inputs and takes about 160 counters for each context.
struct NumberShape {
  std::uint32_t family = 0;
  std::uint32_t selectors = 1;
  std::array<std::uint32_t, kMaxInputs> inputs{};
};

/// The models of one part of the format: its families, then its numbers.
struct ModelLayout {
  std::span<const FamilyShape> families;
  std::span<const NumberShape> numbers;
  bool is_agile = false;  // weights begin at the mean of the inputs and move twice as fast
};

template <class Shape>
constexpr std::size_t input_count(const Shape& shape) {
  std::size_t count = 0;
  while (count < kMaxInputs && shape.inputs[count] != 0) ++count;
  return count;
}

/// The row of an enumerator of a Family or Number.
template <auto family>
constexpr const auto& checked_shape() {
  constexpr const auto& shape = shape_of(family);
  static_assert(shape.family == family, "the table is not in the order of the enum");
  return shape;
}

template <auto family, std::size_t... i>
Contexts<checked_shape<family>().inputs[i]...> contexts_of(std::index_sequence<i...>);

/// One context of the right size for each input of a family.
template <auto family>
using ContextsOf =
    decltype(contexts_of<family>(std::make_index_sequence<input_count(checked_shape<family>())>{}));

template <auto family>
using SelectorOf = Context<checked_shape<family>().selectors>;

}  // namespace watertight::codec
