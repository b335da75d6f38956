// SPDX-License-Identifier: GPL-3.0-or-later
//
// mutate_blobs N SEED [WORST]: decodes N damaged blobs and pages. Prints how many were rejected and
// with which code, the time of the slowest one, and the memory that all of them needed. Solids that
// fail only by the end of the stream or the checksum, and solids of a page before its failure, are
// checked too. Also to be run in a sanitizer build. A decoded blob must give a boundary that can be
// encoded again. With the name of a file, the slowest inputs are damaged further, and the slowest
// of all is written to the file.
#include <sys/resource.h>

#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <string>

#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "tests/generated/mutated_blobs.h"

using namespace watertight;

namespace {

constexpr std::size_t kHunted = 64;

std::uint64_t number(const char* text) {
  std::uint64_t value = 0;
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

bool is_page(ByteView bytes) { return bytes.size() > 2 && (bytes[2] & 0x80U) != 0; }

Result<std::vector<Decoded>> decode_any(ByteView bytes) {
  if (is_page(bytes)) return codec::decode_page(bytes);
  auto one = decode(bytes);
  if (!one) return one.error();
  return std::vector<Decoded>{std::move(one).value()};
}

/// True if the solid was read, and the error is in the bytes after it.
bool is_whole(const Error& error) {
  return error.message.find("does not end where") != std::string::npos ||
         error.message.find("checksum does not match") != std::string::npos;
}

long peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

class Hunt {
 public:
  Hunt(std::uint64_t seed, bool is_on) : random_(seed), blobs_(generated::seed_blobs(seed)) {
    for (Bytes& page : generated::seed_pages(seed)) blobs_.push_back(std::move(page));
    is_on_ = is_on;
  }

  /// Decodes one damaged blob; returns false if a decoded boundary cannot be encoded again.
  bool round() {
    Bytes blob = generated::mutated(
        is_on_ && !slow_.empty() && random_.below(2) == 0 ? slow_ : blobs_, random_);
    const double start = cpu_seconds();
    const auto decoded = decode_any(blob);
    Result<std::vector<Decoded>> unchecked = Error{ErrorCode::malformed, "not looked at"};
    if (!decoded && (is_page(blob) || is_whole(decoded.error()))) {
      unchecked = generated::decode_unchecked(blob);
    }
    const double seconds = cpu_seconds() - start;
    ++outcomes_[decoded ? "decoded" : std::string(to_string(decoded.error().code))];
    bool is_good = !decoded || encodes_again(*decoded);
    if (unchecked) ++outcomes_["of these decoded but for the end, the checksum or later solids"];
    is_good = is_good && (!unchecked || encodes_again(*unchecked));
    note(seconds, std::move(blob));
    return is_good;
  }

  double slowest() const { return slowest_; }
  const Bytes& worst() const { return worst_; }
  const std::map<std::string, std::uint64_t>& outcomes() const { return outcomes_; }

 private:
  static bool encodes_again(const std::vector<Decoded>& solids) {
    for (const Decoded& decoded : solids) {
      const auto boundary = OrientedBoundary::make(decoded.solid);
      if (!boundary ||
          !codec::encode_boundary(*boundary, decoded.info.acceptance, {.mode = Mode::raw})) {
        return false;
      }
    }
    return true;
  }

  void note(double seconds, Bytes blob) {
    if (is_on_ && seconds > slow_enough_ && blob.size() < 100'000) {
      slow_.push_back(blob);
      if (slow_.size() > kHunted) {
        slow_.erase(slow_.begin());
        slow_enough_ *= 1.05;
      }
    }
    if (seconds <= slowest_) return;
    slowest_ = seconds;
    worst_ = std::move(blob);
    if (is_on_) std::fprintf(stderr, "%.4f s for %zu bytes\n", seconds, worst_.size());
  }

  generated::Random random_;
  std::vector<Bytes> blobs_;
  std::vector<Bytes> slow_;
  std::map<std::string, std::uint64_t> outcomes_;
  Bytes worst_;
  double slowest_ = 0;
  double slow_enough_ = 0.002;
  bool is_on_ = false;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3 && count != 4) {
    std::fprintf(stderr, "usage: mutate_blobs N SEED [WORST]\n");
    return 2;
  }
  const std::uint64_t rounds = number(arguments[1]);
  const char* path = count == 4 ? arguments[3] : nullptr;
  Hunt hunt(number(arguments[2]), path != nullptr);
  const double start = cpu_seconds();
  for (std::uint64_t i = 0; i < rounds; ++i) {
    if (i % 100'000 == 99'999) {
      std::fprintf(stderr, "%llu, %.0f s\n", static_cast<unsigned long long>(i + 1),
                   cpu_seconds() - start);
    }
    if (!hunt.round()) {
      std::fprintf(stderr, "round %llu: decoded, but no boundary that encodes\n",
                   static_cast<unsigned long long>(i));
      return 1;
    }
  }
  for (const auto& [outcome, times] : hunt.outcomes()) {
    std::printf("%s %llu\n", outcome.c_str(), static_cast<unsigned long long>(times));
  }
  std::printf("%llu in %.0f s; the slowest took %.4f s for %zu bytes; at most %ld MB of memory\n",
              static_cast<unsigned long long>(rounds), cpu_seconds() - start, hunt.slowest(),
              hunt.worst().size(), peak_megabytes());
  if (path != nullptr) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(hunt.worst().data()),
               static_cast<std::streamsize>(hunt.worst().size()));
  }
  return 0;
}
