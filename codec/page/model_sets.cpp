// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/page/model_sets.h"

#include <string>
#include <utility>

#include "codec/page/modes.h"
#include "codec/page/solid_coder.h"
#include "codec/page/source_order.h"

namespace watertight::codec {

/// The file codec/models/model-1.bin, which codec/CMakeLists.txt embeds.
extern const std::span<const std::uint8_t> kModel1;

namespace {

using Priors = std::array<ModelBank, kModelParts>;

constexpr std::uint8_t kModelSetMagic[3] = {'W', 'T', 'M'};

ModelBank neutral(ModelPart part) { return ModelBank(layout_of(part)); }

/// The priors of a model set, read when first used; null if no set has this number.
const Priors* priors_of(std::uint8_t number) {
  static const Priors zero = neutral_priors();
  static const Result<Priors> one = read_models(kModel1, 1);
  if (number == 0) return &zero;
  return number == 1 && one ? &*one : nullptr;
}

constexpr std::size_t kSets = 2;

/// The banks that this thread keeps for the next set with a number; null where there is none.
std::array<std::unique_ptr<ModelBank>, kModelParts>& kept_banks(std::uint8_t number) {
  thread_local std::array<std::array<std::unique_ptr<ModelBank>, kModelParts>, kSets> kept;
  return kept[number];
}

}  // namespace

const ModelLayout& layout_of(ModelPart part) {
  switch (part) {
    case ModelPart::frame:
      break;
    case ModelPart::order:
      return order_layout();
    case ModelPart::polygon:
      return polygon::model_layout();
    case ModelPart::walk:
      return walk::model_layout();
    case ModelPart::parallelogram:
      return parallelogram::model_layout();
  }
  return frame_layout();
}

Priors neutral_priors() {
  return {neutral(ModelPart::frame), neutral(ModelPart::order), neutral(ModelPart::polygon),
          neutral(ModelPart::walk), neutral(ModelPart::parallelogram)};
}

Result<ModelSet> ModelSet::make(std::uint8_t number) {
  const Priors* priors = priors_of(number);
  if (priors == nullptr) {
    return Error{ErrorCode::unsupported, "model set " + std::to_string(number) + " is unknown"};
  }
  ModelSet set(*priors);
  set.number_ = number;
  return set;
}

ModelBank& ModelSet::operator[](ModelPart part) {
  const auto i = static_cast<std::size_t>(part);
  if (banks_[i]) return *banks_[i];
  if (number_) banks_[i] = std::move(kept_banks(*number_)[i]);
  if (!banks_[i]) {
    banks_[i] = std::make_unique<ModelBank>((*priors_)[i]);
    if (number_) banks_[i]->note_from_now();
  }
  return *banks_[i];
}

ModelSet::~ModelSet() {
  for (std::size_t i = 0; number_ && i < kModelParts; ++i) {
    if (banks_[i] && banks_[i]->take_back()) kept_banks(*number_)[i] = std::move(banks_[i]);
  }
}

Bytes write_models(const Priors& banks, std::uint8_t number,
                   const std::array<PriorShape, kModelParts>& shapes) {
  ByteWriter writer;
  writer.append(kModelSetMagic);
  writer.u8(number);
  for (std::size_t i = 0; i < kModelParts; ++i) {
    const Bytes state = banks[i].save(shapes[i]);
    writer.varint(state.size());
    writer.append(state);
  }
  return std::move(writer).bytes();
}

Result<Priors> read_models(ByteView file, std::uint8_t number) {
  ByteReader reader(file);
  bool fits = true;
  for (const std::uint8_t byte : kModelSetMagic) fits = fits && reader.u8() == byte;
  fits = fits && reader.u8() == number;
  Priors priors = neutral_priors();
  for (ModelBank& bank : priors) fits = fits && bank.load(reader.take(reader.varint()));
  if (!fits || reader.failed() || reader.remaining() != 0) {
    return Error{ErrorCode::malformed, "no model file of this number and these layouts"};
  }
  return priors;
}

}  // namespace watertight::codec
