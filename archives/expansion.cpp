// SPDX-License-Identifier: GPL-3.0-or-later
#include "archives/expansion.h"

#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace watertight::archives {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16U;

/// The bytes that a step of a decoder has used and made.
struct Step {
  std::size_t taken = 0;
  std::size_t given = 0;
  bool is_at_end = false;  // of a gzip member or a Zstandard frame
};

class Decoder {
 public:
  Decoder() = default;
  virtual ~Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  /// Decodes some of `in` to `out`. After an end the next step begins a new member or frame.
  /// Errors: malformed.
  virtual Result<Step> step(ByteView in, std::span<std::uint8_t> out) = 0;
};

class GzipDecoder final : public Decoder {
 public:
  GzipDecoder() {
    constexpr int kGzipOnly = 16;
    is_ready_ = inflateInit2(&stream_, kGzipOnly + MAX_WBITS) == Z_OK;
  }
  ~GzipDecoder() override { inflateEnd(&stream_); }
  GzipDecoder(const GzipDecoder&) = delete;
  GzipDecoder& operator=(const GzipDecoder&) = delete;

  Result<Step> step(ByteView in, std::span<std::uint8_t> out) override {
    if (!is_ready_) return Error{ErrorCode::limit_exceeded, "gzip: not enough memory"};
    if (std::exchange(is_at_end_, false)) inflateReset(&stream_);
    // zlib reads through a pointer that is not const, and does not write.
    stream_.next_in = const_cast<Bytef*>(in.data());  // NOLINT(*-const-cast)
    stream_.avail_in = static_cast<uInt>(in.size());
    stream_.next_out = out.data();
    stream_.avail_out = static_cast<uInt>(out.size());
    const int result = inflate(&stream_, Z_NO_FLUSH);
    const Step step{in.size() - stream_.avail_in, out.size() - stream_.avail_out,
                    result == Z_STREAM_END};
    is_at_end_ = step.is_at_end;
    if (result == Z_OK || result == Z_STREAM_END || result == Z_BUF_ERROR) return step;
    if (result == Z_MEM_ERROR) return Error{ErrorCode::limit_exceeded, "gzip: not enough memory"};
    std::string reason = stream_.msg == nullptr ? "broken data" : stream_.msg;
    return Error{ErrorCode::malformed, "gzip: " + reason, step.taken};
  }

 private:
  z_stream stream_{};
  bool is_ready_ = false;
  bool is_at_end_ = false;
};

class ZstdDecoder final : public Decoder {
 public:
  explicit ZstdDecoder(int window) : context_(ZSTD_createDCtx()) {
    if (context_ != nullptr) {
      ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, window);
    }
  }

  Result<Step> step(ByteView in, std::span<std::uint8_t> out) override {
    if (context_ == nullptr) return Error{ErrorCode::limit_exceeded, "zstd: not enough memory"};
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    const std::size_t more = ZSTD_decompressStream(context_.get(), &output, &input);
    if (ZSTD_isError(more) != 0) {
      const bool is_window = ZSTD_getErrorCode(more) == ZSTD_error_frameParameter_windowTooLarge;
      return Error{is_window ? ErrorCode::limit_exceeded : ErrorCode::malformed,
                   std::string("zstd: ").append(ZSTD_getErrorName(more)), input.pos};
    }
    return Step{input.pos, output.pos, more == 0};
  }

 private:
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  std::unique_ptr<ZSTD_DCtx, Free> context_;
};

/// The state of a source of expanded bytes.
class Expansion {
 public:
  Expansion(ByteSource packed, Compression compression, const ExpansionLimit& limit, int window)
      : packed_(std::move(packed)), limit_(limit), name_(to_string(compression)), input_(kChunk) {
    if (compression == Compression::gzip) {
      decoder_ = std::make_unique<GzipDecoder>();
    } else {
      decoder_ = std::make_unique<ZstdDecoder>(window);
    }
  }

  Result<std::size_t> read(std::span<std::uint8_t> out) {
    if (failure_) return *failure_;
    auto count = expand(out);
    if (!count) failure_ = count.error();
    return count;
  }

 private:
  Result<std::size_t> expand(std::span<std::uint8_t> out) {
    for (;;) {
      if (Status status = fill(); !status) return std::move(status).error();
      const ByteView in = ByteView(input_).subspan(begin_, end_ - begin_);
      if (in.empty() && is_between_) return std::size_t{0};
      auto step = decoder_->step(in, out);
      if (!step) return located(std::move(step).error());
      begin_ += step->taken;
      taken_ += step->taken;
      given_ += step->given;
      is_between_ = step->is_at_end;
      if (given_ > limit_.most(taken_)) return too_much();
      if (step->given > 0) return step->given;
      if (step->taken > 0 || step->is_at_end) continue;
      return Error{ErrorCode::malformed, name_ + ": the data end too early", taken_};
    }
  }

  /// Reads more compressed bytes if there are none.
  Status fill() {
    if (begin_ < end_ || has_ended_) return Done{};
    auto count = packed_(input_);
    if (!count) return std::move(count).error();
    begin_ = 0;
    end_ = *count;
    has_ended_ = *count == 0;
    return Done{};
  }

  Error located(Error error) const {
    error.byte_offset = taken_ + error.byte_offset.value_or(0);
    return error;
  }

  Error too_much() const {
    std::string message =
        name_ + ": expands to more than " + std::to_string(limit_.bytes) + " bytes";
    if (limit_.ratio > 0) {
      message += " and more than " + std::to_string(limit_.ratio) + " times its size";
    }
    return {ErrorCode::limit_exceeded, std::move(message), taken_};
  }

  ByteSource packed_;
  ExpansionLimit limit_;
  std::string name_;
  std::unique_ptr<Decoder> decoder_;
  Bytes input_;
  std::size_t begin_ = 0;  // of the bytes of input_ that are not used yet
  std::size_t end_ = 0;
  std::uint64_t taken_ = 0;  // compressed bytes that were used
  std::uint64_t given_ = 0;  // expanded bytes
  bool has_ended_ = false;   // the compressed bytes
  bool is_between_ = false;  // after the end of a member or frame
  std::optional<Error> failure_;
};

}  // namespace

std::string_view to_string(Compression compression) {
  switch (compression) {
    case Compression::none:
      return "";
    case Compression::gzip:
      return "gzip";
    case Compression::zstd:
      return "zstd";
    case Compression::zip:
      return "zip";
  }
  return "";
}

Compression compression_of(ByteView first) {
  const std::string_view text = as_text(first);
  if (text.starts_with("\x1F\x8B")) return Compression::gzip;
  if (text.starts_with("\x28\xB5\x2F\xFD")) return Compression::zstd;
  // A skippable frame, which parallel compressors write first.
  const bool is_skippable = text.size() >= kMagicBytes && (first[0] & 0xF0U) == 0x50U &&
                            text.substr(1).starts_with("\x2A\x4D\x18");
  if (is_skippable) return Compression::zstd;
  const bool is_zip = text.starts_with("PK\x03\x04") || text.starts_with("PK\x05\x06");
  return is_zip ? Compression::zip : Compression::none;
}

std::uint64_t ExpansionLimit::most(std::uint64_t packed_bytes) const {
  return std::max(bytes, ratio * packed_bytes);
}

ByteSource expanded(ByteSource packed, Compression compression, const ExpansionLimit& limit,
                    int window) {
  const auto expansion = std::make_shared<Expansion>(std::move(packed), compression, limit, window);
  return [expansion](std::span<std::uint8_t> bytes) { return expansion->read(bytes); };
}

}  // namespace watertight::archives
