// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/part21/solid_instance.h"

#include <utility>

#include "formats/part21/boundary_reader.h"

namespace watertight::formats {

Status add_solid_instance(const Part21& file, const SolidInstance& instance, CurvedSource from,
                          const ReadOptions& options, std::uint64_t& budget, Document& document,
                          Feature& feature) {
  auto read = read_boundary(file, instance.id, instance.radian, options.limits);
  if (!read) {
    return add_curved_solid(std::move(read).error(), std::move(from), options, budget, feature);
  }
  document.notes.insert(document.notes.end(), read->notes.begin(), read->notes.end());
  if (instance.tolerance) read->solid.tolerance = *instance.tolerance;
  return add_curved_solid(std::move(read->solid), std::move(from), options, budget, feature);
}

}  // namespace watertight::formats
