// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command encode for one document or several: which file each goes to.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>

#include "cli/commands.h"
#include "cli/sources/input_list.h"
#include "cli/terminal/progress.h"
#include "files/files.h"

namespace watertight::cli {
namespace {

namespace fs = std::filesystem;

/// An input and the file that its encoding goes to.
struct Planned {
  const files::InputFile* input = nullptr;
  fs::path output;
};

/// Whether a name from outside stays below a folder that it is appended to.
bool stays_below(const fs::path& name) {
  if (name.empty() || name.is_absolute() || !name.has_filename()) return false;
  return std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

Error wrong(std::string reason) { return {ErrorCode::invalid_argument, std::move(reason)}; }

/// The outputs of several inputs in a folder: "FOLDER/town.zip/a.city.json.wt". Errors:
/// invalid_argument.
Result<std::vector<Planned>> plan(const EncodeCommand& command,
                                  const std::vector<files::InputFile>& inputs) {
  std::error_code ignored;
  const bool is_folder = command.output.ends_with('/') || fs::is_directory(command.output, ignored);
  if (!is_folder) {
    return wrong(std::to_string(inputs.size()) +
                 " documents need a folder for their files: -o FOLDER/");
  }
  if (!command.rejected.empty()) return wrong("--rejected needs one document");
  std::map<std::string, std::string> names;  // the input of each output
  std::vector<Planned> planned;
  for (const files::InputFile& input : inputs) {
    if (!stays_below(input.relative)) {
      return wrong("there is no file in a folder for the name '" + input.relative + "'");
    }
    fs::path output = fs::path(command.output) / (input.relative + ".wt");
    const auto [other, is_new] = names.try_emplace(output.string(), input.name);
    if (!is_new) {
      return wrong("'" + other->second + "' and '" + input.name + "' would both go to '" +
                   output.string() + "'");
    }
    planned.push_back({&input, std::move(output)});
  }
  for (const Planned& one : planned) {
    if (!fs::exists(one.output, ignored)) continue;
    for (const files::InputFile& input : inputs) {
      if (!files::is_same_file(one.output.string(), input.file)) continue;
      return wrong("the output '" + one.output.string() + "' would replace an input");
    }
  }
  return planned;
}

}  // namespace

Exit run(const EncodeCommand& command) {
  const std::vector<files::InputFile> inputs = list_inputs(command.files);
  EncodeCommand one = command;
  if (inputs.size() == 1) {
    one.input = inputs.front().name;
    return encode_input(one, inputs.front(), {});
  }
  const auto planned = plan(command, inputs);
  if (!planned) {
    complain(command.output, planned.error());
    return Exit::error;
  }
  Exit exit = Exit::valid;
  for (std::size_t i = 0; i < planned->size(); ++i) {
    const auto& [input, output] = (*planned)[i];
    std::error_code error;
    fs::create_directories(output.parent_path(), error);
    if (error) {
      complain(output.parent_path().string(), {ErrorCode::unavailable, error.message()});
      exit = worse(exit, Exit::error);
      continue;
    }
    one.input = input->name;
    one.output = output.string();
    exit = worse(exit, encode_input(one, *input, position_among(i + 1, planned->size())));
  }
  return exit;
}

}  // namespace watertight::cli
