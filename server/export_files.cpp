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

void ExportFiles::keep(const std::string& key, File file) {
  if (file->size() > most_bytes_) return;
  const std::lock_guard lock(mutex_);
  entries_.remove_if([&](const Entry& entry) { return entry.key == key; });
  entries_.push_front({key, std::move(file), Clock::now()});
  drop_surplus();
}

void ExportFiles::forget_old() {
  const std::lock_guard lock(mutex_);
  drop_surplus();
}

/// Removes the files that are too old, too many or too large together. Requires the lock.
void ExportFiles::drop_surplus() {
  const Clock::time_point now = Clock::now();
  std::size_t files = 0;
  std::uint64_t bytes = 0;
  entries_.remove_if([&](const Entry& entry) {
    bytes += entry.file->size();
    return ++files > most_files_ || bytes > most_bytes_ || now - entry.used > keep_;
  });
}

}  // namespace watertight::server
