// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/remote/http_file.h"

#include <curl/curl.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <utility>

#include "base/ascii.h"

namespace watertight::cli {
namespace {

constexpr std::uint64_t kTailBytes = 12U << 10U;  // what a reader of a Watertight file wants first
constexpr std::uint64_t kMostWhole = 16ULL << 20U;  // of a file without ranges
constexpr long kMostRedirects = 5;
constexpr long kConnectSeconds = 15;
constexpr long kSilentSeconds = 30;  // without a byte

struct FreeHandle {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreeList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

/// The parts of an answer that a reader of ranges needs.
struct HttpAnswer {
  long status = 0;
  Bytes body;
  bool is_too_long = false;  // the body has more bytes than were allowed
  std::string etag;
  std::string modified;
  std::optional<std::uint64_t> first;  // of the range
  std::optional<std::uint64_t> size;   // of the file, as the range states it
  std::uint64_t most = 0;              // the most bytes of the body
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Reads "bytes 0-99/1234".
void read_content_range(std::string_view value, HttpAnswer& answer) {
  constexpr std::string_view kUnit = "bytes ";
  if (!value.starts_with(kUnit)) return;
  value.remove_prefix(kUnit.size());
  const std::size_t dash = value.find('-');
  const std::size_t slash = value.find('/');
  if (dash == std::string_view::npos || slash == std::string_view::npos) return;
  answer.first = number(value.substr(0, dash));
  answer.size = number(value.substr(slash + 1));
}

std::size_t take_header(char* data, std::size_t /*one*/, std::size_t count, void* place) {
  HttpAnswer& answer = *static_cast<HttpAnswer*>(place);
  const std::string_view line(data, count);
  if (line.starts_with("HTTP/")) {  // of this answer, not of the redirects before it
    answer.etag.clear();
    answer.modified.clear();
    answer.first.reset();
    answer.size.reset();
  }
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return count;
  const std::string name = lower_case(line.substr(0, colon));
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (name == "etag") answer.etag = value;
  if (name == "last-modified") answer.modified = value;
  if (name == "content-range") read_content_range(value, answer);
  return count;
}

std::size_t take_body(char* data, std::size_t /*one*/, std::size_t count, void* place) {
  HttpAnswer& answer = *static_cast<HttpAnswer*>(place);
  if (count > answer.most - std::min<std::uint64_t>(answer.most, answer.body.size())) {
    answer.is_too_long = true;
    return 0;
  }
  const ByteView bytes = as_bytes(std::string_view(data, count));
  answer.body.insert(answer.body.end(), bytes.begin(), bytes.end());
  return count;
}

Error unavailable(std::string message) { return {ErrorCode::unavailable, std::move(message)}; }

class HttpFile {
 public:
  static Result<std::shared_ptr<HttpFile>> open(const std::string& url) {
    static const CURLcode started = curl_global_init(CURL_GLOBAL_DEFAULT);
    auto file = std::make_shared<HttpFile>();
    file->handle_.reset(started == CURLE_OK ? curl_easy_init() : nullptr);
    if (!file->handle_) return unavailable("libcurl cannot be used");
    file->set_up(url);
    return file;
  }

  /// Asks for a range such as "0-99"; "" for the whole file.
  Result<HttpAnswer> ask(const std::string& range, std::uint64_t most_bytes) {
    CURL* const handle = handle_.get();
    HttpAnswer answer;
    answer.most = most_bytes;
    const std::unique_ptr<curl_slist, FreeList> headers(
        validator_.empty() || range.empty()
            ? nullptr
            : curl_slist_append(nullptr, ("If-Range: " + validator_).c_str()));
    curl_easy_setopt(handle, CURLOPT_HTTPHEADER, headers.get());
    curl_easy_setopt(handle, CURLOPT_RANGE, range.empty() ? nullptr : range.c_str());
    curl_easy_setopt(handle, CURLOPT_HEADERDATA, &answer);
    curl_easy_setopt(handle, CURLOPT_WRITEDATA, &answer);
    error_[0] = '\0';
    const CURLcode code = curl_easy_perform(handle);
    curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &answer.status);
    if (code != CURLE_OK && !answer.is_too_long) {
      return unavailable(error_[0] != '\0' ? error_ : curl_easy_strerror(code));
    }
    if (answer.status == 404 || answer.status == 410) {
      return Error{ErrorCode::not_found,
                   "the server has no such file (" + std::to_string(answer.status) + ")"};
    }
    if (answer.status != 200 && answer.status != 206 && answer.status != 416) {
      return unavailable("the server answers " + std::to_string(answer.status));
    }
    return answer;
  }

  /// Remembers which state of the file an answer is of, and the URL to which redirects led.
  void remember(const HttpAnswer& answer) {
    const char* url = nullptr;
    curl_easy_getinfo(handle_.get(), CURLINFO_EFFECTIVE_URL, &url);
    if (url != nullptr) curl_easy_setopt(handle_.get(), CURLOPT_URL, std::string(url).c_str());
    size_ = answer.size.value_or(answer.body.size());
    etag_ = answer.etag;
    modified_ = answer.modified;
    // Only a strong tag can stand for bytes.
    validator_ = etag_.starts_with("W/") ? "" : etag_;
  }
  std::uint64_t size() const { return size_; }

  Result<Bytes> read(std::uint64_t offset, std::uint64_t count) {
    const std::string range = std::to_string(offset) + "-" + std::to_string(offset + count - 1);
    auto answer = ask(range, count);
    if (!answer) return std::move(answer).error();
    const bool is_same = answer->status == 206 && answer->size == size_ && answer->etag == etag_ &&
                         answer->modified == modified_;
    if (!is_same) {
      return Error{ErrorCode::conflict, "the file changed on the server while it was read"};
    }
    if (answer->first != offset || answer->body.size() != count || answer->is_too_long) {
      return unavailable("the server gives another range than the one that was asked for");
    }
    return std::move(answer->body);
  }

 private:
  void set_up(const std::string& url) {
    CURL* const handle = handle_.get();
    const bool is_secure = lower_case(url.substr(0, 6)) == "https:";
    curl_easy_setopt(handle, CURLOPT_URL, url.c_str());
    curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(handle, CURLOPT_REDIR_PROTOCOLS_STR, is_secure ? "https" : "http,https");
    curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 1L);
    curl_easy_setopt(handle, CURLOPT_MAXREDIRS, kMostRedirects);
    curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT, kConnectSeconds);
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, 1L);
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, kSilentSeconds);
    curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(handle, CURLOPT_USERAGENT, "watertight");
    curl_easy_setopt(handle, CURLOPT_ERRORBUFFER, error_);
    curl_easy_setopt(handle, CURLOPT_HEADERFUNCTION, &take_header);
    curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, &take_body);
  }

  std::unique_ptr<CURL, FreeHandle> handle_;
  char error_[CURL_ERROR_SIZE] = {};
  std::uint64_t size_ = 0;
  std::string etag_;
  std::string modified_;
  std::string validator_;  // for If-Range
};

/// A file of which the last bytes, from `first` on, are known.
pipeline::FileBytes file_with_tail(std::shared_ptr<HttpFile> http, std::uint64_t first,
                                   Bytes tail) {
  pipeline::FileBytes file;
  file.size = first + tail.size();
  file.read = [http = std::move(http), first, tail = std::move(tail)](
                  std::uint64_t offset, std::uint64_t count) -> Result<Bytes> {
    if (offset < first) return http->read(offset, count);
    const auto begin = tail.begin() + static_cast<std::ptrdiff_t>(offset - first);
    return Bytes(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  return file;
}

}  // namespace

bool is_url(std::string_view argument) {
  const std::string start = lower_case(argument.substr(0, 8));
  return start.starts_with("http://") || start == "https://";
}

Result<pipeline::FileBytes> open_http_file(const std::string& url) {
  auto http = HttpFile::open(url);
  if (!http) return std::move(http).error();
  auto answer = (*http)->ask(std::string("-").append(std::to_string(kTailBytes)), kMostWhole);
  if (!answer) return std::move(answer).error();
  if (answer->status == 416) return Error{ErrorCode::malformed, "the file is empty"};
  if (answer->is_too_long) {
    return Error{ErrorCode::unsupported,
                 "the server gives no byte ranges, and the file has more than " +
                     std::to_string(kMostWhole) + " bytes: download it"};
  }
  (*http)->remember(*answer);
  if (answer->status == 200) return file_with_tail(*std::move(http), 0, std::move(answer->body));
  const bool is_tail =
      answer->first && answer->size && *answer->first + answer->body.size() == *answer->size;
  if (!is_tail) return unavailable("the server's Content-Range is not that of the end of a file");
  const std::uint64_t first = *answer->first;
  return file_with_tail(*std::move(http), first, std::move(answer->body));
}

Result<Bytes> read_http_file(const std::string& url, const Limits& limits) {
  auto http = HttpFile::open(url);
  if (!http) return std::move(http).error();
  auto answer = (*http)->ask("", limits.bytes);
  if (!answer) return std::move(answer).error();
  if (answer->is_too_long) {
    return Error{ErrorCode::limit_exceeded, "more than " + std::to_string(limits.bytes) + " bytes"};
  }
  return std::move(answer->body);
}

}  // namespace watertight::cli
