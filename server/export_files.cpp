// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/export_files.h"

#include <algorithm>
#include <utility>

namespace watertight::server {

ExportFiles::File ExportFiles::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  drop_surplus();
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  if (found == entries_.end()) return nullptr;
  found->used = Clock::now();
  entries_.splice(entries_.begin(), entries_, found);
  return entries_.front().file;
}

bool ExportFiles::make_room(std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  while (*bytes_ + bytes > most_bytes_ && !entries_.empty()) entries_.pop_back();
  return *bytes_ + bytes <= most_bytes_;
}

ExportFiles::File ExportFiles::keep(const std::string& key, TemporaryFile file) {
  const std::uint64_t size = file.size();
  const File kept(new TemporaryFile(std::move(file)),
                  [size, bytes = bytes_](const TemporaryFile* gone) {
                    delete gone;
                    *bytes -= size;
                  });
  *bytes_ += size;
  const std::lock_guard lock(mutex_);
  entries_.remove_if([&](const Entry& entry) { return entry.key == key; });
  entries_.push_front({key, kept, Clock::now()});
  drop_surplus();
  return kept;
}

void ExportFiles::forget_old() {
  const std::lock_guard lock(mutex_);
  drop_surplus();
}

/// Removes the files that are too old or too many. Requires the lock.
void ExportFiles::drop_surplus() {
  const Clock::time_point now = Clock::now();
  std::size_t files = 0;
  entries_.remove_if(
      [&](const Entry& entry) { return ++files > most_files_ || now - entry.used > keep_; });
}

}  // namespace watertight::server
