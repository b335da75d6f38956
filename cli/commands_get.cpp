// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command get, which reads some features of a Watertight file.
#include <cmath>
#include <limits>

#include "cli/commands.h"
#include "cli/outputs/documents.h"
#include "cli/sources/ranged_file.h"
#include "pipeline/file/selection.h"

namespace watertight::cli {
namespace {

/// The box of 4 or 6 numbers. Errors: invalid_argument.
Result<store::StoredBox> box_of_numbers(const std::vector<double>& numbers) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const std::size_t axes = numbers.size() / 2;
  bool is_box = numbers.size() == 4 || numbers.size() == 6;
  store::StoredBox box{{0, 0, -kEndless}, {0, 0, kEndless}};
  for (std::size_t axis = 0; is_box && axis < axes; ++axis) {
    box.min[axis] = numbers[axis];
    box.max[axis] = numbers[axes + axis];
    is_box = std::isfinite(box.min[axis]) && std::isfinite(box.max[axis]) &&
             box.min[axis] <= box.max[axis];
  }
  if (is_box) return box;
  return Error{ErrorCode::invalid_argument,
               "a box is minx,miny,maxx,maxy or minx,miny,minz,maxx,maxy,maxz, with the smaller "
               "numbers first"};
}

}  // namespace

Exit run(const GetCommand& command) {
  const bool has_box = !command.box.empty();
  const auto box =
      has_box ? box_of_numbers(command.box) : Result<store::StoredBox>(store::StoredBox());
  if (!box) return fail("--bbox", box.error());
  auto file = open_container(command.input);
  if (!file) return fail(command.input, file.error());
  const auto selected =
      has_box ? pipeline::select_box(*file, *box) : pipeline::select_ids(*file, command.ids);
  if (!selected) return fail(command.input, selected.error());
  for (const std::string& id : selected->missing) {
    complain(command.input, {ErrorCode::not_found, "nothing has the id '" + id + "'"});
  }
  if (selected->documents.empty()) {
    if (has_box) complain(command.input, {ErrorCode::not_found, "no feature is in the box"});
    return Exit::invalid;
  }
  if (selected->documents.size() > 1 && command.output == "-") {
    return fail(command.input, Error{ErrorCode::unsupported,
                                     "the features are of several documents with different "
                                     "headers, which need names: -o FILE"});
  }
  const Exit saved =
      save_documents(selected->documents, command.input, command.output, Format::city_json_seq);
  return selected->missing.empty() ? saved : worse(saved, Exit::invalid);
}

}  // namespace watertight::cli
