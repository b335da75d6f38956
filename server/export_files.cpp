// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/export_files.h"

#include <algorithm>
#include <utility>

namespace watertight::server {

ExportFiles::File ExportFiles::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  forget_old();
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  if (found == entries_.end()) return nullptr;
  found->used = Clock::now();
  entries_.splice(entries_.begin(), entries_, found);
  return entries_.front().file;
}

void ExportFiles::keep(const std::string& key, File file) {
  const std::lock_guard lock(mutex_);
  entries_.remove_if([&](const Entry& entry) { return entry.key == key; });
  entries_.push_front({key, std::move(file), Clock::now()});
  forget_old();
}

void ExportFiles::forget_old() {
  const Clock::time_point now = Clock::now();
  std::size_t files = 0;
  std::uint64_t bytes = 0;
  entries_.remove_if([&](const Entry& entry) {
    bytes += entry.file->size();
    return ++files > most_files_ || bytes > most_bytes_ || now - entry.used > keep_;
  });
}

}  // namespace watertight::server
