// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs/documents.h"

#include <utility>
#include <vector>

#include "cli/commands.h"
#include "files/files.h"
#include "files/inputs.h"
#include "pipeline/pipeline.h"

namespace watertight::cli {
Exit save_documents(std::span<const Document> documents, const std::string& input,
                    const std::string& output, std::optional<Format> standard) {
  std::vector<std::string> names;
  std::vector<files::FileWriter> files;
  for (const Document& document : documents) {
    const std::string& name = names.emplace_back(files::numbered_name(output, names.size()));
    if (name != "-" && files::is_same_file(name, input)) {
      return fail(input, {ErrorCode::invalid_argument,
                          "the output '" + name + "' would replace the input"});
    }
    const auto format = name == "-" ? Result<Format>(standard.value_or(document.format))
                                    : files::format_of_name(name);
    if (!format) return fail_to_write(name, format.error());
    const auto bytes = pipeline::convert_document(document, *format);
    if (!bytes) return fail(input, bytes.error());
    auto file = files::FileWriter::open(name);
    if (!file) return fail_to_write(name, file.error());
    const Status written = file->write(as_text(*bytes));
    if (!written) return fail_to_write(name, written.error());
    files.push_back(*std::move(file));
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Status status = files[i].commit();
    if (!status) return fail_to_write(names[i], status.error());
  }
  return Exit::valid;
}

Status save_document(const Document& document, const std::string& output) {
  const auto format = files::format_of_name(output);
  if (!format) return format.error();
  const auto bytes = pipeline::convert_document(document, *format);
  if (!bytes) return bytes.error();
  auto file = files::FileWriter::open(output);
  if (!file) return file.error();
  if (Status written = file->write(as_text(*bytes)); !written) return written;
  return file->commit();
}

}  // namespace watertight::cli
