// SPDX-License-Identifier: GPL-3.0-or-later
//
// STEP files: every solid is a feature. Source: ISO 10303-42 (geometry and topology), 10303-43
// (representations and their contexts).
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "formats/curved/curved_files.h"
#include "formats/part21/boundary_reader.h"
#include "formats/part21/solid_instance.h"
#include "formats/part21/units.h"

namespace watertight::formats {
namespace {

class StepReader {
 public:
  StepReader(const Part21& file, std::size_t bytes, const ReadOptions& options)
      : reader_(file), options_(options), budget_(options.limits.claimed_by(bytes)) {}

  Result<Document> read() {
    document_.format = Format::step;
    if (Status status = find_contexts(); !status) return status.error();
    bool has_placements = false;
    for (const StepPlace& place : reader_.file().places()) {
      has_placements = has_placements || place.type == "ITEM_DEFINED_TRANSFORMATION";
      if (!is_solid_type(plain_type(place.type))) continue;
      if (Status status = add_solid(place); !status) return status.error();
    }
    if (document_.features.empty()) document_.notes.push_back("the file has no solid");
    if (has_placements) {
      document_.notes.push_back(
          "placements of parts in assemblies are not applied: each part is where it was drawn");
    }
    return std::move(document_);
  }

 private:
  /// Finds the context of each representation, and so the units of its items.
  Status find_contexts() {
    for (const StepPlace& place : reader_.file().places()) {
      if (!place.type.ends_with("SHAPE_REPRESENTATION")) continue;
      const auto found = reader_.entity(place.id);
      if (!found) return found.error();
      const auto items = reader_.references(*found, 0);
      const auto context = reader_.reference(*found, 1);
      if (!items || !context) continue;
      for (const std::uint64_t item : *items) context_of_.emplace(item, *context);
    }
    return Done{};
  }

  Result<FileUnits> units_of(std::uint64_t solid) {
    const auto context = context_of_.find(solid);
    if (context == context_of_.end()) return FileUnits{0.001, 1, {}};
    if (const auto known = units_.find(context->second); known != units_.end()) {
      return known->second;
    }
    const auto instance = reader_.file().instance(context->second);
    if (!instance) return instance.error();
    FileUnits units{0.001, 1, {}};
    for (const StepEntity& entity : instance->entities) {
      if (entity.type != "GLOBAL_UNIT_ASSIGNED_CONTEXT" || entity.values.empty()) continue;
      std::vector<std::uint64_t> ids;
      for (const StepValue& value : entity.values[0].items) ids.push_back(value.id);
      auto own = read_units(reader_, ids);
      if (!own) return own;
      units = *own;
    }
    for (const StepEntity& entity : instance->entities) {
      if (entity.type != "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT" || entity.values.empty()) continue;
      for (const StepValue& value : entity.values[0].items) add_uncertainty(value.id, units);
    }
    units_.emplace(context->second, units);
    return units;
  }

  void add_uncertainty(std::uint64_t id, FileUnits& units) const {
    const auto found = reader_.entity(id);
    if (!found) return;
    const auto value = reader_.number(*found, 0);
    const auto unit_id = reader_.reference(*found, 1);
    if (!value || !unit_id || !(*value > 0)) return;
    const auto metre = metres_of_unit(reader_, *unit_id);
    if (metre) units.uncertainty = *value * *metre;
  }

  Status add_solid(const StepPlace& place) {
    const auto units = units_of(place.id);
    if (!units) return units.error();
    const std::string id = instance_name(place.id);
    Feature& feature = document_.features.emplace_back();
    feature.id = id;
    const double metre = units->metre;
    const surfaces::Affine placement{{{{metre, 0, 0}, {0, metre, 0}, {0, 0, metre}}}, {}};
    return add_solid_instance(
        reader_.file(), {place.id, units->radian, units->uncertainty},
        {placement, 0, SolidSource{id, std::string(place.type), "", 0, 0, ""}}, options_, budget_,
        document_, feature);
  }

  EntityReader reader_;
  const ReadOptions& options_;
  std::uint64_t budget_;                               // add_curved_solid()
  std::map<std::uint64_t, std::uint64_t> context_of_;  // item of a representation -> its context
  std::map<std::uint64_t, FileUnits> units_;           // context -> units
  Document document_;
};

}  // namespace

Result<Document> read_step(std::string_view text, const ReadOptions& options) {
  const auto file = Part21::read(text, options.limits);
  if (!file) return file.error();
  return StepReader(*file, text.size(), options).read();
}

}  // namespace watertight::formats
