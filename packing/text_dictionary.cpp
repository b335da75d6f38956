// SPDX-License-Identifier: GPL-3.0-or-later
#define ZSTD_STATIC_LINKING_ONLY  // for frames without a magic number
#include "packing/text_dictionary.h"

#include <zdict.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace watertight::packing {
namespace {

constexpr int kLevel = 19;
constexpr int kWindowLog = 27;  // 128 MiB, as in the frames of Watertight files
constexpr std::array<std::size_t, 6> kSizes{2048, 4096, 8192, 16384, 32768, 65536};
constexpr std::size_t kMostTrials = 256;  // the samples on which sizes are compared
constexpr double kWorthwhile = 0.96;
constexpr std::size_t kMostSampleBytes = 8 << 20;

struct Free {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  void operator()(ZSTD_CDict* dictionary) const { ZSTD_freeCDict(dictionary); }
  void operator()(ZSTD_DDict* dictionary) const { ZSTD_freeDDict(dictionary); }
};

Error no_memory() { return {ErrorCode::limit_exceeded, "no memory to compress a text"}; }

Error malformed(std::string_view message) {
  return Error{ErrorCode::malformed, std::string("a packed text: ").append(message), {}, {}};
}

bool is_set(ZSTD_CCtx* context, ZSTD_cParameter parameter, int value) {
  return ZSTD_isError(ZSTD_CCtx_setParameter(context, parameter, value)) == 0;
}

/// A context with the parameters of every text; null without memory. A new one for each text would
/// take longer than the text.
ZSTD_CCtx* compressor() {
  thread_local const std::unique_ptr<ZSTD_CCtx, Free> context(ZSTD_createCCtx());
  if (context == nullptr) return nullptr;
  const bool is_ready = is_set(context.get(), ZSTD_c_compressionLevel, kLevel) &&
                        is_set(context.get(), ZSTD_c_contentSizeFlag, 0) &&
                        is_set(context.get(), ZSTD_c_dictIDFlag, 0) &&
                        is_set(context.get(), ZSTD_c_format, ZSTD_f_zstd1_magicless);
  return is_ready ? context.get() : nullptr;
}

ZSTD_DCtx* decompressor() {
  thread_local const std::unique_ptr<ZSTD_DCtx, Free> context(ZSTD_createDCtx());
  if (context == nullptr) return nullptr;
  ZSTD_DCtx_reset(context.get(), ZSTD_reset_session_and_parameters);
  const bool is_ready =
      ZSTD_isError(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kWindowLog)) == 0 &&
      ZSTD_isError(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_format, ZSTD_f_zstd1_magicless)) ==
          0;
  return is_ready ? context.get() : nullptr;
}

/// A dictionary of at most `size` bytes; empty when the samples give none.
Bytes dictionary_bytes(const std::string& samples, const std::vector<std::size_t>& sizes,
                       std::size_t size) {
  Bytes content(size);
  const std::size_t used = ZDICT_trainFromBuffer(content.data(), content.size(), samples.data(),
                                                 sizes.data(), static_cast<unsigned>(sizes.size()));
  content.resize(ZDICT_isError(used) != 0 ? 0 : used);
  return content;
}

}  // namespace

struct TextDictionary::Prepared {
  std::unique_ptr<ZSTD_CDict, Free> for_packing;
  std::unique_ptr<ZSTD_DDict, Free> for_unpacking;
};

TextDictionary::TextDictionary(Bytes content) : content_(std::move(content)) {}
TextDictionary::~TextDictionary() = default;

Result<DictionaryPointer> TextDictionary::of(Bytes content) {
  std::shared_ptr<TextDictionary> made(new TextDictionary(std::move(content)));
  const Bytes& bytes = made->content_;
  auto prepared = std::make_unique<Prepared>();
  prepared->for_packing.reset(ZSTD_createCDict_byReference(bytes.data(), bytes.size(), kLevel));
  prepared->for_unpacking.reset(ZSTD_createDDict_byReference(bytes.data(), bytes.size()));
  if (!prepared->for_packing || !prepared->for_unpacking) return no_memory();
  made->prepared_ = std::move(prepared);
  return DictionaryPointer(std::move(made));
}

Result<Bytes> pack(std::string_view text, const TextDictionary* dictionary) {
  ZSTD_CCtx* const context = compressor();
  if (context == nullptr) return no_memory();
  const ZSTD_CDict* const shared =
      dictionary == nullptr ? nullptr : dictionary->prepared_->for_packing.get();
  if (ZSTD_isError(ZSTD_CCtx_refCDict(context, shared)) != 0) return no_memory();
  Bytes packed(ZSTD_compressBound(text.size()));
  const std::size_t size =
      ZSTD_compress2(context, packed.data(), packed.size(), text.data(), text.size());
  // The context must not outlive its reference to a dictionary.
  if (ZSTD_isError(ZSTD_CCtx_refCDict(context, nullptr)) != 0) return no_memory();
  if (ZSTD_isError(size) != 0) return no_memory();
  packed.resize(size);
  packed.shrink_to_fit();
  return packed;
}

Result<std::string> unpack(ByteView packed, const TextDictionary* dictionary,
                           std::uint64_t most_bytes) {
  ZSTD_DCtx* const context = decompressor();
  if (context == nullptr) return no_memory();
  if (dictionary != nullptr &&
      ZSTD_isError(ZSTD_DCtx_refDDict(context, dictionary->prepared_->for_unpacking.get())) != 0) {
    return no_memory();
  }
  std::string text;
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  for (std::size_t room = std::max<std::size_t>(4096, packed.size() * 16);;) {
    const std::size_t size = text.size();
    text.resize(size + std::min<std::size_t>(room, ZSTD_DStreamOutSize()));
    ZSTD_outBuffer out{text.data() + size, text.size() - size, 0};
    const std::size_t more = ZSTD_decompressStream(context, &out, &in);
    if (ZSTD_isError(more) != 0) return malformed(ZSTD_getErrorName(more));
    const bool is_full = out.pos == out.size;
    text.resize(size + out.pos);
    if (text.size() > most_bytes) {
      return Error{ErrorCode::limit_exceeded,
                   "a packed text of more than " + std::to_string(most_bytes) + " bytes"};
    }
    if (more == 0) break;
    if (in.pos == in.size && !is_full) return malformed("truncated");
    room *= 2;
  }
  if (in.pos != in.size) return malformed("bytes after its end");
  return text;
}

Result<std::uint64_t> packed_bytes(std::span<const std::string> texts,
                                   const TextDictionary* dictionary) {
  std::uint64_t bytes = 0;
  for (const std::string& text : texts) {
    const auto packed = pack(text, dictionary);
    if (!packed) return packed.error();
    bytes += packed->size();
  }
  return bytes;
}

Result<DictionaryPointer> train(std::span<const std::string> samples, std::uint64_t expected,
                                const DictionaryPointer& current) {
  if (samples.size() < kFewestSamples) return current;
  std::string all;
  std::vector<std::size_t> sizes;
  for (const std::string& sample : samples) {
    if (all.size() + sample.size() > kMostSampleBytes) break;
    all += sample;
    sizes.push_back(sample.size());
  }
  // Every n-th sample, so that trials are like all.
  std::vector<std::string> trials;
  const std::size_t step = samples.size() / kMostTrials + 1;
  for (std::size_t i = 0; i < samples.size(); i += step) trials.push_back(samples[i]);
  const auto scaled = [&](std::uint64_t bytes) {
    return static_cast<double>(bytes) / static_cast<double>(trials.size()) *
           static_cast<double>(expected);
  };
  DictionaryPointer best = current;
  const auto now = packed_bytes(trials, current.get());
  if (!now) return now.error();
  double least = scaled(*now) * kWorthwhile;
  for (const std::size_t size : kSizes) {
    Bytes content = dictionary_bytes(all, sizes, size);
    if (content.empty()) continue;
    auto made = TextDictionary::of(std::move(content));
    if (!made) return std::move(made).error();
    const auto bytes = packed_bytes(trials, made->get());
    if (!bytes) return bytes.error();
    const double total = scaled(*bytes) + static_cast<double>((*made)->content().size());
    if (total >= least) continue;
    least = total;
    best = *std::move(made);
  }
  return best;
}

}  // namespace watertight::packing
