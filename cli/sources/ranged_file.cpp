// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sources/ranged_file.h"

#include <cstdio>
#include <memory>
#include <utility>

#include "base/quantity.h"
#include "cli/remote/http_file.h"
#include "cli/terminal/printable.h"
#include "files/files.h"

namespace watertight::cli {
namespace {

/// A file on a disk.
Result<pipeline::FileBytes> open_disk_file(const std::string& path) {
  auto random = files::open_random(path);
  if (!random) return std::move(random).error();
  pipeline::FileBytes file;
  file.size = random->size;
  file.read = [random = *std::move(random)](std::uint64_t offset,
                                            std::uint64_t count) -> Result<Bytes> {
    Bytes bytes(static_cast<std::size_t>(count));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const auto read = random.read(offset + done, std::span(bytes).subspan(done));
      if (!read) return read.error();
      if (*read == 0) break;
      done += *read;
    }
    bytes.resize(done);
    return bytes;
  };
  return file;
}

/// Standard input, read whole.
Result<pipeline::FileBytes> read_pipe() {
  auto bytes = files::read_file("-", {});
  if (!bytes) return std::move(bytes).error();
  const auto all = std::make_shared<const Bytes>(*std::move(bytes));
  pipeline::FileBytes file;
  file.size = all->size();
  file.read = [all](std::uint64_t offset, std::uint64_t count) -> Result<Bytes> {
    const auto begin = all->begin() + static_cast<std::ptrdiff_t>(offset);
    return Bytes(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  return file;
}

}  // namespace

Result<pipeline::ContainerFile> open_container(const std::string& argument) {
  const bool is_remote = is_url(argument);
  auto bytes = is_remote         ? open_http_file(argument)
               : argument == "-" ? read_pipe()
                                 : open_disk_file(argument);
  if (!bytes) return std::move(bytes).error();
  const auto torn = is_remote ? pipeline::TornTail::refuse : pipeline::TornTail::leave_out;
  auto file = pipeline::ContainerFile::open(*std::move(bytes), {}, torn);
  if (file) warn_of_torn(argument, *file);
  return file;
}

void warn_of_torn(const std::string& name, const pipeline::ContainerFile& file) {
  if (!file.torn()) return;
  std::fprintf(stderr,
               "watertight: %s: warning: the file is torn: %s after its last commit are left out "
               "(%s)\n",
               printable(name).c_str(), quantity(file.size() - file.committed(), "byte").c_str(),
               printable(file.torn()->message).c_str());
}

}  // namespace watertight::cli
