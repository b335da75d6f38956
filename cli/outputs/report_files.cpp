// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs/report_files.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <utility>

namespace watertight::cli {
Status ReportFiles::open(const std::string& path, ReportForm form, const report::ReportHead& head) {
  const auto is_it = [&](const Open& open) { return files::is_same_file(path, open.path); };
  if (std::ranges::any_of(reports_, is_it)) {
    return Error{ErrorCode::invalid_argument, "two reports of this run go to one file"};
  }
  auto file = files::FileWriter::open(path);
  if (!file) return std::move(file).error();
  auto writer = std::make_unique<files::FileWriter>(*std::move(file));
  auto sink = [to = writer.get()](std::string_view text) { return to->write(text); };
  auto report = report::make_report(form, std::move(sink), head);
  reports_.push_back({std::move(writer), std::move(report), path});
  return Done{};
}

Status ReportFiles::tell(const Call& call) {
  for (Open& open : reports_) {
    Status status = call(*open.report);
    if (status) continue;
    Error error = std::move(status).error();
    error.message.insert(0, output_name(open.path) + ": ");
    return error;
  }
  return Done{};
}

void ReportFiles::finish(const Complaint& complain) {
  for (Open& open : reports_) {
    Status status = open.report->finish();
    if (status) status = open.file->commit();
    if (!status) complain(output_name(open.path), status.error());
  }
}

std::string output_name(const std::string& path) { return path == "-" ? "standard output" : path; }

std::string time_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return std::string(text.data(), size);
}

}  // namespace watertight::cli
