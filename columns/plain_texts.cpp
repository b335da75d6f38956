// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/plain_texts.h"

#include <lzma.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>

namespace watertight::columns {
namespace {

constexpr std::uint64_t kLeastWindow = 4096;
constexpr std::uint64_t kMostWindow = std::uint64_t{64} << 20U;
constexpr int kQuickLevel = 3;
constexpr int kQuickWindowLog = 27;
/// LZMA takes more than this part of what the quick compressor takes.
constexpr std::uint64_t kQuickByLzma = 2;
constexpr std::size_t kStep = std::size_t{1} << 16U;

/// The filter for texts of so many bytes: the slowest and smallest setting of xz, for bytes that
/// are not aligned to each other.
lzma_options_lzma options_for(std::uint64_t bytes) {
  lzma_options_lzma options;
  lzma_lzma_preset(&options, 9U | LZMA_PRESET_EXTREME);
  options.dict_size =
      static_cast<std::uint32_t>(std::bit_ceil(std::clamp(bytes, kLeastWindow, kMostWindow)));
  options.pb = 0;
  return options;
}

std::array<lzma_filter, 2> filters_of(lzma_options_lzma& options) {
  return {{{LZMA_FILTER_LZMA1, &options}, {LZMA_VLI_UNKNOWN, nullptr}}};
}

Bytes joined(std::span<const Text> texts) {
  ByteWriter writer;
  for (const Text& text : texts) writer.varint(text.text.size());
  for (const Text& text : texts) writer.append(as_bytes(text.text));
  return std::move(writer).bytes();
}

/// The bytes that a quick compressor with a wide window takes; 0 without memory.
std::uint64_t quick_bytes(const Bytes& bytes) {
  ZSTD_CCtx* const context = ZSTD_createCCtx();
  if (context == nullptr) return 0;
  ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, kQuickLevel);
  ZSTD_CCtx_setParameter(context, ZSTD_c_enableLongDistanceMatching, 1);
  ZSTD_CCtx_setParameter(context, ZSTD_c_windowLog, kQuickWindowLog);
  Bytes packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress2(context, packed.data(), packed.size(), bytes.data(), bytes.size());
  ZSTD_freeCCtx(context);
  return ZSTD_isError(size) != 0 ? 0 : size;
}

Error too_long(std::uint64_t most_bytes) {
  return Error{ErrorCode::limit_exceeded,
               "packed texts of more than " + std::to_string(most_bytes) + " bytes"};
}

Error malformed(ByteView bytes) {
  return {ErrorCode::malformed, "packed texts that are damaged", bytes.size(), {}};
}

/// A decoder that ends with its scope.
struct Decoder {
  Decoder() = default;
  ~Decoder() { lzma_end(&stream); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  lzma_stream stream = LZMA_STREAM_INIT;
};

/// Exactly `size` bytes out of all of `packed`.
Result<std::string> decompressed(ByteView packed, std::uint64_t size) {
  lzma_options_lzma options = options_for(size);
  const auto filters = filters_of(options);
  Decoder decoder;
  if (lzma_raw_decoder(&decoder.stream, filters.data()) != LZMA_OK)
    return Error{ErrorCode::limit_exceeded, "no memory to expand texts"};
  decoder.stream.next_in = packed.data();
  decoder.stream.avail_in = packed.size();
  std::string out;
  lzma_ret state = LZMA_OK;
  while (state == LZMA_OK) {
    const std::size_t done = out.size();
    // One byte more than there should be, so that the end is seen.
    out.resize(std::min<std::uint64_t>(size + 1, done + std::max(kStep, done)));
    if (out.size() == done) break;
    decoder.stream.next_out = reinterpret_cast<std::uint8_t*>(out.data()) + done;
    decoder.stream.avail_out = out.size() - done;
    state = lzma_code(&decoder.stream, LZMA_FINISH);
    out.resize(out.size() - decoder.stream.avail_out);
  }
  const bool is_whole = state == LZMA_STREAM_END && decoder.stream.avail_in == 0;
  if (!is_whole || out.size() != size) return malformed(packed);
  return out;
}

}  // namespace

std::optional<Bytes> pack_plainly(std::span<const Text> texts, std::uint64_t columns_bytes) {
  const Bytes all = joined(texts);
  if (columns_bytes * kQuickByLzma < quick_bytes(all)) return std::nullopt;
  lzma_options_lzma options = options_for(all.size());
  const auto filters = filters_of(options);
  Bytes packed(columns_bytes);
  std::size_t size = 0;
  if (lzma_raw_buffer_encode(filters.data(), nullptr, all.data(), all.size(), packed.data(), &size,
                             packed.size()) != LZMA_OK) {
    return std::nullopt;  // more bytes than the columns, or no memory
  }
  packed.resize(size);
  ByteWriter writer;
  writer.varint(all.size());
  writer.append(packed);
  return std::move(writer).bytes();
}

Result<std::vector<std::string>> unpack_plainly(ByteView bytes, std::uint64_t count,
                                                std::uint64_t most_bytes) {
  ByteReader reader(bytes);
  const std::uint64_t size = reader.varint();
  if (reader.failed() || count > size) return malformed(bytes);
  // A length takes at most ten bytes.
  if (size > most_bytes && size - most_bytes > 10 * count) return too_long(most_bytes);
  const auto all = decompressed(reader.take(reader.remaining()), size);
  if (!all) return all.error();
  ByteReader rest(as_bytes(*all));
  std::vector<std::uint64_t> lengths;
  for (std::uint64_t i = 0; i < count && !rest.failed(); ++i) lengths.push_back(rest.varint());
  if (rest.remaining() > most_bytes) return too_long(most_bytes);
  std::vector<std::string> texts;
  for (const std::uint64_t length : lengths)
    texts.emplace_back(as_text(rest.take(static_cast<std::size_t>(length))));
  if (rest.failed() || rest.remaining() != 0) return malformed(bytes);
  return texts;
}

}  // namespace watertight::columns
