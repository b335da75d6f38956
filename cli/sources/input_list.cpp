// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sources/input_list.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <utility>

#include "base/ascii.h"
#include "base/quantity.h"
#include "cli/remote/http_file.h"
#include "cli/terminal/printable.h"
#include "files/names.h"
#include "files/zip_documents.h"

namespace watertight::cli {
namespace {

namespace fs = std::filesystem;

/// An input that gives an error when it is opened.
files::InputFile failing(const std::string& name, Error error) {
  return {name, name, name,
          [error = std::move(error)]() -> Result<files::OpenedFile> { return error; }};
}

files::InputFile plain(const std::string& path, const std::string& relative) {
  return {path, path, relative, [path] { return files::open_file(path); }};
}

/// A document on a web server, which is read whole.
files::InputFile remote(const std::string& url) {
  const std::string path = url.substr(0, url.find_first_of("?#"));
  const auto open = [url]() -> Result<files::OpenedFile> {
    auto bytes = read_http_file(url, {});
    if (!bytes) return std::move(bytes).error();
    const std::uint64_t size = bytes->size();
    ByteSource source = [all = *std::move(bytes), given = std::size_t{0}](
                            std::span<std::uint8_t> part) mutable -> Result<std::size_t> {
      const std::size_t count = std::min(part.size(), all.size() - given);
      std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(given), count, part.begin());
      given += count;
      return count;
    };
    return files::OpenedFile{std::move(source), size};
  };
  return {url, url, path.substr(path.find_last_of('/') + 1), open};
}

void tell_skipped(const std::string& name, std::uint64_t count) {
  if (count == 0) return;
  std::fprintf(stderr, "watertight: %s: skipped: %s with the ending of no known format\n",
               printable(name).c_str(), quantity(count, "file").c_str());
}

Error no_document(const char* place) {
  return {ErrorCode::unsupported, std::string("no document in the ") + place};
}

/// Collects the inputs of one argument.
class Collector {
 public:
  explicit Collector(std::vector<files::InputFile>& inputs) : inputs_(inputs) {}

  void add(const std::string& argument) {
    std::error_code ignored;
    if (argument == "-") {
      inputs_.push_back(plain(argument, "standard-input"));
    } else if (is_url(argument)) {
      inputs_.push_back(remote(argument));
    } else if (fs::is_directory(argument, ignored)) {
      add_folder(argument);
    } else if (fs::is_regular_file(argument, ignored) && files::is_zip(argument)) {
      add_zip(argument, fs::path(argument).filename().string(), false);
    } else {
      inputs_.push_back(plain(argument, fs::path(argument).filename().string()));
    }
    tell_skipped(argument, skipped_);
  }

 private:
  void add_folder(const std::string& folder) {
    std::vector<std::string> paths;
    std::error_code error;
    auto entry = fs::recursive_directory_iterator(folder, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
      std::error_code ignored;
      if (!entry->is_regular_file(ignored)) continue;
      const bool is_hidden = entry->path().filename().string().starts_with('.');
      const std::string path = entry->path().string();
      if (!is_hidden && (files::is_document_name(path) || lower_case(path).ends_with(".zip"))) {
        paths.push_back(path);
      } else {
        ++skipped_;
      }
    }
    const std::size_t before = inputs_.size();
    std::sort(paths.begin(), paths.end());
    for (const std::string& path : paths) {
      const std::string relative = fs::path(path).lexically_relative(folder).string();
      if (files::is_zip(path)) {
        add_zip(path, relative, true);
      } else {
        inputs_.push_back(plain(path, relative));
      }
    }
    if (error) {
      inputs_.push_back(failing(folder, {ErrorCode::unavailable, error.message()}));
    } else if (inputs_.size() == before) {
      inputs_.push_back(failing(folder, no_document("folder")));
    }
  }

  void add_zip(const std::string& path, const std::string& relative, bool is_in_folder) {
    auto documents = files::documents_of_zip(path, path);
    if (!documents) {
      inputs_.push_back(failing(path, documents.error()));
      return;
    }
    skipped_ += documents->skipped;
    if (documents->inputs.empty() && !is_in_folder) {
      inputs_.push_back(failing(path, no_document("archive")));
    }
    for (files::InputFile& input : documents->inputs) {
      input.relative = relative + input.name.substr(path.size());
      inputs_.push_back(std::move(input));
    }
  }

  std::vector<files::InputFile>& inputs_;
  std::uint64_t skipped_ = 0;
};

}  // namespace

std::vector<files::InputFile> list_inputs(std::span<const std::string> arguments) {
  std::vector<files::InputFile> inputs;
  for (const std::string& argument : arguments) Collector(inputs).add(argument);
  return inputs;
}

Result<files::InputFile> single_input(const std::string& argument) {
  auto inputs = list_inputs({&argument, 1});
  if (inputs.size() == 1) return std::move(inputs.front());
  return Error{ErrorCode::invalid_argument, "this command reads one document, and there are " +
                                                std::to_string(inputs.size()) + " in it"};
}

}  // namespace watertight::cli
