// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/text_dictionary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace watertight::packing {
namespace {

using columns::Examples;
using columns::Text;
using columns::TextKind;

constexpr std::array<std::size_t, 4> kNumbers{8, 24, 64, 160};  // of examples
constexpr std::size_t kTrials = 24;  // the samples with which dictionaries are compared
constexpr double kWorthwhile = 0.96;
constexpr double kOutgrown = 1.25;
constexpr double kFitUnit = 4096;
constexpr std::uint64_t kForm = 0;  // of dictionaries, and of the texts that are packed with them

const Examples& no_examples() {
  static const auto kNone = Examples::of(Examples::pack_examples({}), 0);
  return **kNone;
}

/// Samples at even distances, from the first or from the middle of a distance.
std::vector<std::string> spread(std::span<const std::string> samples, std::size_t number,
                                bool from_middle) {
  std::vector<std::string> chosen;
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < number; ++i) {
    const std::string& sample =
        samples[(2 * i + (from_middle ? 1 : 0)) * samples.size() / (2 * number)];
    if (bytes + sample.size() > kMostExampleBytes) continue;
    bytes += sample.size();
    chosen.push_back(sample);
  }
  return chosen;
}

/// The share of the texts' bytes that is left when they are packed.
Result<double> packed_share(std::span<const std::string> texts, const TextDictionary* dictionary) {
  double before = 1;
  double after = 0;
  for (const std::string& text : texts) {
    const auto packed = pack(text, dictionary);
    if (!packed) return packed.error();
    before += static_cast<double>(text.size());
    after += static_cast<double>(packed->size());
  }
  return after / before;
}

/// The content of a dictionary: its form, how well it fits, then its examples.
Bytes content_of(std::span<const std::string> examples, double fit) {
  std::vector<Text> texts;
  for (const std::string& example : examples) texts.push_back({TextKind::json, example});
  ByteWriter writer;
  writer.varint(kForm);
  writer.varint(static_cast<std::uint64_t>(std::lround(fit * kFitUnit)));
  writer.append(Examples::pack_examples(texts));
  return std::move(writer).bytes();
}

}  // namespace

Result<DictionaryPointer> TextDictionary::of(Bytes content) {
  ByteReader reader(content);
  const std::uint64_t form = reader.varint();
  if (form != kForm) return columns::unknown_form(form);
  const double fit = static_cast<double>(reader.varint()) / kFitUnit;
  if (reader.failed()) return reader.error("dictionary");
  auto examples = Examples::of(reader.take(reader.remaining()), 2 * kMostExampleBytes);
  if (!examples) return examples.error();
  return DictionaryPointer(new TextDictionary(std::move(content), fit, *std::move(examples)));
}

Result<Bytes> pack(std::string_view text, const TextDictionary* dictionary) {
  const Examples& examples = dictionary == nullptr ? no_examples() : *dictionary->examples_;
  return examples.pack({TextKind::json, text});
}

Result<std::string> unpack(ByteView packed, const TextDictionary* dictionary,
                           std::uint64_t most_bytes) {
  const Examples& examples = dictionary == nullptr ? no_examples() : *dictionary->examples_;
  return examples.unpack(packed, most_bytes);
}

Result<bool> still_fits(const TextDictionary* dictionary, std::span<const std::string> samples) {
  if (dictionary == nullptr) return false;
  if (samples.empty()) return true;
  const auto now = packed_share(spread(samples, kTrials, true), dictionary);
  if (!now) return now.error();
  return *now < dictionary->fit() * kOutgrown;
}

Result<DictionaryPointer> best_dictionary(std::span<const std::string> samples,
                                          std::uint64_t expected,
                                          const DictionaryPointer& current) {
  if (samples.size() < kFewestSamples) return current;
  const std::vector<std::string> trials = spread(samples, kTrials, true);
  if (trials.empty()) return current;
  const auto now = packed_share(trials, current.get());
  if (!now) return now.error();
  double bytes = 0;
  for (const std::string& sample : samples) bytes += static_cast<double>(sample.size());
  bytes *= static_cast<double>(expected) / static_cast<double>(samples.size());
  double least = *now * bytes * kWorthwhile;
  DictionaryPointer best = current;
  for (const std::size_t number : kNumbers) {
    if (number > samples.size() / 2) break;
    const std::vector<std::string> examples = spread(samples, number, false);
    auto trial = TextDictionary::of(content_of(examples, 0));
    if (!trial) return trial;
    const auto share = packed_share(trials, trial->get());
    if (!share) return share.error();
    const double total = *share * bytes + static_cast<double>((*trial)->content().size());
    if (total >= least) break;
    least = total;
    auto made = TextDictionary::of(content_of(examples, *share));
    if (!made) return made;
    best = *std::move(made);
  }
  return best;
}

}  // namespace watertight::packing
