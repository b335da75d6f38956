// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/rings/ring_coder.h"

#include <algorithm>
#include <bit>

#include "columns/models/number_coder.h"

namespace watertight::columns {
namespace {

constexpr std::size_t kMostRecent = 256;
constexpr std::ptrdiff_t kLatest = 16;
constexpr std::uint32_t kFarPosition = 5;
constexpr int kRankBits = 4;

}  // namespace

void RingCoder::restart() { *this = RingCoder(); }

bool RingCoder::is_in_ring(VertexNumber vertex) const {
  const auto looked_at = std::min<std::ptrdiff_t>(ring_.end() - ring_.begin(), kLatest);
  return std::find(ring_.end() - looked_at, ring_.end(), vertex) != ring_.end();
}

RingCoder::Guess RingCoder::guess(std::uint32_t position) const {
  Guess guess;
  if (ring_.empty()) return guess;
  if (const Neighbours* const last = neighbours_.find(ring_.back())) guess.before = last->before;
  if (position >= 2) {
    const Neighbours* const first = neighbours_.find(ring_.front());
    if (first != nullptr) guess.after = first->after;
  }
  if (guess.before && is_in_ring(*guess.before)) guess.before.reset();
  if (guess.after && is_in_ring(*guess.after)) guess.after.reset();
  guess.agree = guess.before && guess.after && *guess.before == *guess.after;
  if (guess.agree) guess.after.reset();
  return guess;
}

std::size_t RingCoder::end_of_ranked() const {
  const std::size_t of_ring = std::min(ring_.size(), static_cast<std::size_t>(kLatest));
  return recent_.size() - std::min(recent_.size(), of_ring);
}

// A rank counts the vertices used since, without those that are denied already.
std::optional<std::uint64_t> RingCoder::rank_of(const Guess& guess, VertexNumber vertex) const {
  std::uint64_t rank = 0;
  for (std::size_t i = end_of_ranked(); i-- > 0;) {
    if (recent_[i] == guess.before || recent_[i] == guess.after) continue;
    if (recent_[i] == vertex) return rank;
    ++rank;
  }
  return std::nullopt;
}

std::optional<VertexNumber> RingCoder::of_rank(const Guess& guess, std::uint64_t rank) const {
  for (std::size_t i = end_of_ranked(); i-- > 0;) {
    if (recent_[i] == guess.before || recent_[i] == guess.after) continue;
    if (rank-- == 0) return recent_[i];
  }
  return std::nullopt;
}

void RingCoder::end_ring() {
  const std::size_t size = ring_.size();
  if (size == 0) return;
  for (std::size_t i = 0; i < size; ++i) {
    const VertexNumber next = ring_[i + 1 == size ? 0 : i + 1];
    neighbours_[ring_[i]].after = next;
    neighbours_[next].before = ring_[i];
  }
  rings_.add(ring_);
  ring_.clear();
}

const RingList& RingCoder::finish() {
  end_ring();
  return rings_;
}

void RingCoder::take(VertexNumber vertex, Kind kind) {
  if (kind == Kind::fresh || kind == Kind::far) last_found_ = vertex;
  largest_ = std::max(largest_, vertex);
  before_last_kind_ = last_kind_;
  last_kind_ = kind;
  ring_.push_back(vertex);
  if (kind != Kind::fresh) {
    const auto known = std::find(recent_.rbegin(), recent_.rend(), vertex);
    if (known != recent_.rend()) recent_.erase(std::next(known).base());
  }
  recent_.push_back(vertex);
  if (recent_.size() > 2 * kMostRecent) {
    recent_.erase(recent_.begin(), recent_.end() - static_cast<std::ptrdiff_t>(kMostRecent));
  }
}

std::optional<VertexNumber> RingCoder::code(EntropyStream& stream, ContextMixer& mixer,
                                            std::uint32_t position,
                                            std::optional<VertexNumber> vertex) {
  if (position == 0) end_ring();
  const Guess guessed = guess(position);
  const VertexNumber fresh = largest_ + 1;
  const Hash where = std::min(position, kFarPosition);
  const Hash known = (guessed.before ? 1U : 0U) + (guessed.after ? 2U : 0U) +
                     (guessed.agree ? 4U : 0U) +
                     (!ring_.empty() && ring_.back() == largest_ ? 8U : 0U);
  const auto last = static_cast<Hash>(last_kind_);
  const Hash all = hash_of(where, last, static_cast<Hash>(before_last_kind_), known);
  const auto finish_with = [&](VertexNumber coded, Kind kind) {
    take(coded, kind);
    return coded;
  };
  if (mixer.flag(stream, Question::is_new_vertex,
                 {all, hash_of(where, known, last), hash_of(where, known)}, vertex == fresh)) {
    return finish_with(fresh, Kind::fresh);
  }
  if (guessed.before &&
      mixer.flag(stream, Question::is_before_neighbour, {all, hash_of(where, known, last), known},
                 vertex == *guessed.before)) {
    return finish_with(*guessed.before, Kind::before);
  }
  if (guessed.after && mixer.flag(stream, Question::is_after_neighbour,
                                  {all, hash_of(where, known, last)}, vertex == *guessed.after)) {
    return finish_with(*guessed.after, Kind::after);
  }
  const auto rank = vertex ? rank_of(guessed, *vertex) : std::nullopt;
  if (mixer.flag(stream, Question::is_recent, {all, hash_of(where, last)}, rank.has_value())) {
    const std::uint64_t coded =
        mixer.number(stream, Question::recent_rank,
                     {hash_of(where, last), hash_of(where, last_rank_), hash_of(where, known)},
                     rank.value_or(0), kRankBits);
    last_rank_ = static_cast<std::uint32_t>(std::bit_width(coded));
    const auto found = of_rank(guessed, coded);
    if (!found) stream.fail();
    return finish_with(found.value_or(0), Kind::recent);
  }
  if (!mixer.flag(stream, Question::is_vertex, {where}, vertex.has_value())) return std::nullopt;
  const std::int64_t residual = vertex.value_or(0) - last_found_;
  const std::uint64_t size = mixer.number(stream, Question::vertex_distance,
                                          {where, hash_of(where, last)}, magnitude(residual), 3);
  const bool is_negative = size > 0 && mixer.flag(stream, Question::vertex_sign,
                                                  {where, hash_of(where, last)}, residual < 0);
  if (size >= static_cast<std::uint64_t>(kMostVertexNumbers)) stream.fail();
  const std::int64_t far =
      stream.failed() ? 0 : last_found_ + static_cast<std::int64_t>(is_negative ? 0 - size : size);
  if (far < 0 || far >= kMostVertexNumbers) {
    stream.fail();
    return finish_with(0, Kind::far);
  }
  return finish_with(far, Kind::far);
}

}  // namespace watertight::columns
