// SPDX-License-Identifier: GPL-3.0-or-later
//
// The function of the bridge that reads texts of features in the tables of the service.
#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "packing/feature_text.h"
#include "packing/text_dictionary.h"
#include "sql/reply.h"

namespace watertight::sql {
namespace {

using packing::DictionaryPointer;
using packing::TextDictionary;

/// The dictionary with this content; null for none. A backend keeps the last few, as making one
/// takes much longer than using it.
Result<DictionaryPointer> dictionary_of(ByteView content) {
  if (content.empty()) return DictionaryPointer();
  thread_local std::array<DictionaryPointer, 4> known;  // the last one used is in front
  const auto found = std::ranges::find_if(known, [&](const DictionaryPointer& one) {
    return one && std::ranges::equal(one->content(), content);
  });
  if (found != known.end()) {
    std::rotate(known.begin(), found, found + 1);
    return known.front();
  }
  auto made = TextDictionary::of(Bytes(content.begin(), content.end()));
  if (!made) return std::move(made).error();
  std::rotate(known.begin(), known.end() - 1, known.end());
  known.front() = *std::move(made);
  return known.front();
}

/// Answers a packed text with a part of it, or without bytes where it has none.
void stored_part_into(const wt_job& job, ByteView dictionary, const char* id,
                      const std::function<std::string_view(std::string_view)>& part,
                      wt_reply* reply) {
  const CallLimits call(job);
  const Limits limits = call.of_input();
  const auto known = dictionary_of(dictionary);
  if (!known) return fail(reply, call.of_reading(known.error()));
  const auto marked = packing::unpack(bytes_of(job), known->get(), limits.bytes);
  if (!marked) return fail(reply, call.of_reading(marked.error()));
  const auto text = packing::without_marks(*marked, id, limits.bytes);
  if (!text) return fail(reply, call.of_reading(text.error()));
  const std::string_view found = part(*text);
  if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  if (!found.empty()) answer(reply, as_bytes(found));
}

}  // namespace
}  // namespace watertight::sql

void wt_bridge_stored_model(const wt_job* job, wt_blob_view dictionary, const char* id,
                            wt_reply* reply) noexcept {
  watertight::sql::guarded(reply, [=] {
    watertight::sql::stored_part_into(*job, {dictionary.bytes, dictionary.size}, id,
                                      watertight::packing::model_line, reply);
  });
}

void wt_bridge_stored_repair(const wt_job* job, wt_blob_view dictionary, const char* id,
                             uint32_t solid, wt_reply* reply) noexcept {
  watertight::sql::guarded(reply, [=] {
    watertight::sql::stored_part_into(
        *job, {dictionary.bytes, dictionary.size}, id,
        [=](std::string_view text) { return watertight::packing::repair_of(text, solid); }, reply);
  });
}
