// SPDX-License-Identifier: GPL-3.0-or-later
//
// A side of a box is a step of 1/65535 of the side of the page's box, rounded outwards.
#include "pipeline/file/block_pages.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace watertight::pipeline {
namespace {

constexpr std::uint16_t kLastStep = 65535;

/// The coordinate of a step between two numbers.
double at_step(double low, double high, std::uint16_t step) {
  if (step == kLastStep) return high;
  const double part = static_cast<double>(step) / kLastStep;
  return std::min(low * (1 - part) + high * part, high);
}

std::uint16_t guess(double low, double high, double value) {
  const double part = high > low ? (value - low) / (high - low) : 0;
  if (!(part > 0)) return 0;
  return static_cast<std::uint16_t>(std::min(part * kLastStep, static_cast<double>(kLastStep)));
}

/// The last step that is not above the value.
std::uint16_t step_below(double low, double high, double value) {
  std::uint16_t step = guess(low, high, value);
  while (step > 0 && at_step(low, high, step) > value) --step;
  return step;
}

/// The first step that is not below the value.
std::uint16_t step_above(double low, double high, double value) {
  std::uint16_t step = guess(low, high, value);
  while (step < kLastStep && at_step(low, high, step) < value) ++step;
  return step;
}

}  // namespace

void FlatBox::include(const FlatBox& other) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    min[axis] = std::min(min[axis], other.min[axis]);
    max[axis] = std::max(max[axis], other.max[axis]);
  }
}

bool FlatBox::contains(const FlatBox& other) const {
  return min[0] <= other.min[0] && min[1] <= other.min[1] && max[0] >= other.max[0] &&
         max[1] >= other.max[1];
}

bool FlatBox::meets(const FlatBox& other) const {
  return min[0] <= other.max[0] && min[1] <= other.max[1] && max[0] >= other.min[0] &&
         max[1] >= other.min[1];
}

FlatBox flat(const store::StoredBox& box) {
  return {{box.min[0], box.min[1]}, {box.max[0], box.max[1]}};
}

WrittenBlockPage write_block_page(std::span<const BlockEntry> entries) {
  WrittenBlockPage written;
  written.page.blocks = entries.size();
  for (const BlockEntry& entry : entries) {
    if (!entry.box) continue;
    if (!written.page.box) written.page.box = *entry.box;
    written.page.box->include(*entry.box);
  }
  ByteWriter writer;
  std::uint64_t end = 0;
  for (const BlockEntry& entry : entries) {
    writer.varint(entry.extent.offset - end);
    writer.varint(entry.extent.size);
    writer.varint(2 * entry.features + (entry.box ? 1 : 0));
    end = entry.extent.end();
    for (std::size_t axis = 0; entry.box && axis < 2; ++axis) {
      const double low = written.page.box->min[axis];
      const double high = written.page.box->max[axis];
      const std::uint16_t from = step_below(low, high, entry.box->min[axis]);
      const std::uint16_t to = step_above(low, high, entry.box->max[axis]);
      writer.u16(from);
      writer.u16(to < from ? kLastStep : to);
    }
  }
  written.payload = std::move(writer).bytes();
  return written;
}

Result<std::vector<BlockEntry>> read_block_page(ByteView payload, const BlockPage& page) {
  ByteReader reader(payload);
  std::vector<BlockEntry> entries;
  bool is_good = true;
  std::uint64_t end = 0;
  const std::uint64_t limit = page.extent.offset;
  for (std::uint64_t i = 0; i < page.blocks && is_good && !reader.failed(); ++i) {
    BlockEntry& entry = entries.emplace_back();
    const std::uint64_t gap = reader.varint();
    entry.extent.size = reader.varint();
    const std::uint64_t features = reader.varint();
    entry.features = features / 2;
    is_good = gap <= limit - end && entry.extent.size <= limit - end - gap && entry.extent.size > 0;
    entry.extent.offset = is_good ? end + gap : 0;
    end = is_good ? entry.extent.end() : end;
    if (features % 2 == 0) continue;
    is_good = is_good && page.box.has_value();
    entry.box.emplace();
    for (std::size_t axis = 0; is_good && axis < 2; ++axis) {
      const double low = page.box->min[axis];
      const double high = page.box->max[axis];
      const std::uint16_t from = reader.u16();
      const std::uint16_t to = reader.u16();
      entry.box->min[axis] = at_step(low, high, from);
      entry.box->max[axis] = at_step(low, high, to);
      is_good = from <= to;
    }
  }
  if (is_good && !reader.failed() && reader.remaining() == 0) return entries;
  return Error{ErrorCode::malformed, "malformed index of blocks", page.extent.offset, {}};
}

}  // namespace watertight::pipeline
