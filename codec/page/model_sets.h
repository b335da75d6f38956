// SPDX-License-Identifier: GPL-3.0-or-later
//
// The numbered, immutable sets of priors (docs/format.md, "Models"), from which the banks of all
// parts of the format start. Number 0 is the neutral set; every other set is a file of
// codec/models, built into the program. A released number never changes and stays decodable.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "base/bytes.h"
#include "base/result.h"
#include "codec/entropy/model_bank.h"

namespace watertight::codec {

/// The parts of the format that have models of their own, in the order of the model files.
enum class ModelPart : std::uint8_t { frame, order, polygon, walk, parallelogram };
inline constexpr std::size_t kModelParts = 5;

const ModelLayout& layout_of(ModelPart part);

/// One bank for each part, copied from its prior when it is first asked for. Copies take longer
/// than the coding of a small solid, so each thread keeps the banks of a numbered set that is done
/// with, with their changes undone, for the next one.
class ModelSet {
 public:
  /// Makes the set with this number. Errors: unsupported if there is none.
  static Result<ModelSet> make(std::uint8_t number);
  /// Makes a set of other priors, for training; `priors` must outlive it.
  explicit ModelSet(const std::array<ModelBank, kModelParts>& priors) : priors_(&priors) {}
  explicit ModelSet(std::array<ModelBank, kModelParts>&& priors) = delete;
  ModelSet(ModelSet&&) = default;
  ModelSet& operator=(ModelSet&&) = delete;
  ~ModelSet();

  ModelBank& operator[](ModelPart part);
  std::uint8_t number() const { return number_.value_or(0); }

 private:
  const std::array<ModelBank, kModelParts>* priors_;
  std::optional<std::uint8_t> number_;
  std::array<std::unique_ptr<ModelBank>, kModelParts> banks_;
};

/// The neutral priors of all parts.
std::array<ModelBank, kModelParts> neutral_priors();

/// Returns a model file: "WTM", the number of the set, then for each bank the length of its state
/// (varint) and the state.
Bytes write_models(const std::array<ModelBank, kModelParts>& banks, std::uint8_t number,
                   const std::array<PriorShape, kModelParts>& shapes);
/// Reads the priors of a model file. Errors: malformed if the file is not one of this number.
Result<std::array<ModelBank, kModelParts>> read_models(ByteView file, std::uint8_t number);

}  // namespace watertight::codec
