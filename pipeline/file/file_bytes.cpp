// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file/file_bytes.h"

#include <algorithm>
#include <utility>

namespace watertight::pipeline {
namespace {

/// A gap that is read rather than saved: a request costs more.
constexpr std::uint64_t kSmallGap = 2048;

std::uint64_t gap_before(const std::vector<Extent>& ranges, std::size_t i) {
  return ranges[i].offset - ranges[i - 1].end();
}

/// For each range whether the gap before it is to be read too: the smallest gaps, with at most
/// `spare` bytes, until few enough ranges are left.
std::vector<bool> smallest_gaps(const std::vector<Extent>& ranges, std::size_t most_ranges,
                                std::uint64_t spare) {
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i < ranges.size(); ++i) order.push_back(i);
  std::sort(order.begin(), order.end(), [&ranges](std::size_t a, std::size_t b) {
    return gap_before(ranges, a) < gap_before(ranges, b);
  });
  std::vector<bool> is_read(ranges.size());
  std::size_t left = ranges.size();
  for (const std::size_t i : order) {
    if (left <= most_ranges || gap_before(ranges, i) > spare) break;
    spare -= gap_before(ranges, i);
    is_read[i] = true;
    --left;
  }
  return is_read;
}

std::vector<Extent> without_gaps(const std::vector<Extent>& ranges,
                                 const std::vector<bool>& is_read) {
  std::vector<Extent> joined;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (is_read[i]) {
      joined.back().size = ranges[i].end() - joined.back().offset;
    } else {
      joined.push_back(ranges[i]);
    }
  }
  return joined;
}

}  // namespace

std::vector<Extent> joined_ranges(std::vector<Extent> extents, std::size_t most_requests) {
  std::sort(extents.begin(), extents.end(),
            [](const Extent& a, const Extent& b) { return a.offset < b.offset; });
  std::vector<Extent> ranges;
  std::uint64_t wanted = 0;
  for (const Extent& extent : extents) {
    if (!ranges.empty() && extent.offset <= ranges.back().end() + kSmallGap) {
      const std::uint64_t end = std::max(ranges.back().end(), extent.end());
      ranges.back().size = end - ranges.back().offset;
    } else {
      ranges.push_back(extent);
    }
  }
  for (const Extent& range : ranges) wanted += range.size;
  return without_gaps(ranges, smallest_gaps(ranges, most_requests, wanted));
}

RangeCache::RangeCache(ByteView bytes) : bytes_read_(bytes.size()) {
  file_.size = bytes.size();
  kept_.push_back({{0, bytes.size()}, {}, bytes});
}

const RangeCache::Range* RangeCache::find(const Extent& extent) const {
  for (const std::list<Range>* ranges : {&kept_, &fetched_}) {
    for (const Range& range : *ranges) {
      if (extent.offset >= range.extent.offset && extent.end() <= range.extent.end()) {
        return &range;
      }
    }
  }
  return nullptr;
}

Result<RangeCache::Range> RangeCache::read(const Extent& extent) {
  Range range{extent, {}, {}};
  if (const Range* known = find(extent)) {
    range.view = known->view.subspan(static_cast<std::size_t>(extent.offset - known->extent.offset),
                                     static_cast<std::size_t>(extent.size));
    range.bytes.assign(range.view.begin(), range.view.end());
  } else {
    auto bytes = file_.read(extent.offset, extent.size);
    if (!bytes) return std::move(bytes).error();
    if (bytes->size() != extent.size) {
      return Error{ErrorCode::unavailable,
                   "the file gave another number of bytes than it has",
                   extent.offset,
                   {}};
    }
    bytes_read_ += extent.size;
    range.bytes = *std::move(bytes);
  }
  range.view = range.bytes;
  return range;
}

Result<ByteView> RangeCache::get(const Extent& extent) {
  const Range* known = find(extent);
  if (known == nullptr) {
    auto range = read(extent);
    if (!range) return std::move(range).error();
    fetched_.clear();
    known = &fetched_.emplace_back(*std::move(range));
  }
  return known->view.subspan(static_cast<std::size_t>(extent.offset - known->extent.offset),
                             static_cast<std::size_t>(extent.size));
}

Result<ByteView> RangeCache::keep(const Extent& extent) {
  if (std::any_of(kept_.begin(), kept_.end(), [&](const Range& range) {
        return extent.offset >= range.extent.offset && extent.end() <= range.extent.end();
      })) {
    return get(extent);
  }
  auto range = read(extent);
  if (!range) return std::move(range).error();
  kept_.push_back(*std::move(range));
  return kept_.back().view;
}

Status RangeCache::fetch(std::vector<Extent> extents, std::size_t most_requests) {
  std::erase_if(extents, [this](const Extent& extent) { return find(extent) != nullptr; });
  if (extents.empty()) return Done{};
  std::list<Range> fetched;
  for (const Extent& extent : joined_ranges(std::move(extents), most_requests)) {
    auto range = read(extent);
    if (!range) return std::move(range).error();
    fetched.push_back(*std::move(range));
  }
  // What was fetched before may be wanted together with it.
  fetched_.splice(fetched_.end(), fetched);
  return Done{};
}

}  // namespace watertight::pipeline
