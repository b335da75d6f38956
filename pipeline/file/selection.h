// SPDX-License-Identifier: GPL-3.0-or-later
//
// Some features of a Watertight file, found by its index. Only the blocks that may have them are
// read.
#pragma once

#include <string>
#include <vector>

#include "formats/document.h"
#include "pipeline/file/container_file.h"

namespace watertight::pipeline {

/// The documents of the file that have chosen features, each with these features only, in the order
/// of the file. A CityJSON that the file has as a whole is split into its features.
struct Selected {
  std::vector<Document> documents;
  std::vector<std::string> missing;  // the ids that nothing has
  std::uint64_t blocks = 0;          // that were read
};

/// The features with these ids, or with city objects that have them. Errors: those of
/// ContainerFile::block() and decode_feature().
Result<Selected> select_ids(ContainerFile& file, const std::vector<std::string>& ids,
                            const Limits& limits = {});
/// The features whose boxes meet a closed box in x, y and z. A feature without solids has no box.
/// Errors: as above.
Result<Selected> select_box(ContainerFile& file, const store::StoredBox& box,
                            const Limits& limits = {});

}  // namespace watertight::pipeline
