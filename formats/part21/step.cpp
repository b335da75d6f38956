// SPDX-License-Identifier: GPL-3.0-or-later
//
// STEP files: every solid is a feature, once for each place of its part. Source: ISO 10303-42
// (geometry and topology), 10303-43 (representations and their contexts).
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "formats/curved/curved_files.h"
#include "formats/part21/assemblies.h"
#include "formats/part21/boundary_reader.h"
#include "formats/part21/solid_instance.h"
#include "formats/part21/units.h"

namespace watertight::formats {
namespace {

class StepReader {
 public:
  StepReader(const Part21& file, std::size_t bytes, const ReadOptions& options)
      : reader_(file),
        options_(options),
        most_solids_(options.limits.solids_of(bytes)),
        budget_(options.limits.claimed_by(bytes)) {}

  Result<Document> read() {
    document_.format = Format::step;
    if (Status status = find_contexts(); !status) return status.error();
    const auto assemblies =
        Assemblies::read(reader_, [&](std::uint64_t representation) -> Result<double> {
          const auto units = units_of(representation);
          if (!units) return units.error();
          return units->metre;
        });
    if (!assemblies) return assemblies.error();
    document_.notes = assemblies->notes();
    for (const StepPlace& place : reader_.file().places()) {
      if (!is_solid_type(plain_type(place.type))) continue;
      if (Status status = add_solids(place, *assemblies); !status) return status.error();
    }
    if (document_.features.empty()) document_.notes.push_back("the file has no solid");
    return std::move(document_);
  }

 private:
  /// Finds the representation of each item, and the context of each representation with its units.
  Status find_contexts() {
    for (const StepPlace& place : reader_.file().places()) {
      if (!place.type.ends_with("SHAPE_REPRESENTATION")) continue;
      const auto found = reader_.entity(place.id);
      if (!found) return found.error();
      const auto items = reader_.references(*found, 0);
      const auto context = reader_.reference(*found, 1);
      if (!items || !context) continue;
      context_of_.emplace(place.id, *context);
      for (const std::uint64_t item : *items) representation_of_.emplace(item, place.id);
    }
    return Done{};
  }

  Result<FileUnits> units_of(std::uint64_t representation) {
    const auto context = context_of_.find(representation);
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

  /// Adds a feature for each place of a solid.
  Status add_solids(const StepPlace& place, const Assemblies& assemblies) {
    const auto own = representation_of_.find(place.id);
    const std::uint64_t representation = own == representation_of_.end() ? 0 : own->second;
    const auto units = units_of(representation);
    if (!units) return units.error();
    const auto places = assemblies.places_of(representation, solids_, most_solids_);
    if (!places) return places.error();
    const double metre = units->metre;
    const surfaces::Affine to_metres{{{{metre, 0, 0}, {0, metre, 0}, {0, 0, metre}}}, {}};
    for (const PartPlace& part : *places) {
      std::string id = instance_name(place.id);
      if (places->size() > 1) {
        for (const std::uint64_t usage : part.usages) id += "@" + instance_name(usage);
      }
      Feature& feature = document_.features.emplace_back();
      feature.id = id;
      const surfaces::Affine placement = surfaces::composed(part.to_whole, to_metres);
      Status status =
          add_solid_instance(reader_.file(), {place.id, units->radian, units->uncertainty},
                             {placement, 0, SolidSource{id, std::string(place.type), "", 0, 0, ""}},
                             options_, budget_, document_, feature);
      if (!status) return status;
    }
    return Done{};
  }

  EntityReader reader_;
  const ReadOptions& options_;
  std::uint64_t most_solids_;
  std::uint64_t solids_ = 0;
  std::uint64_t budget_;                                      // add_curved_solid()
  std::map<std::uint64_t, std::uint64_t> representation_of_;  // item -> its representation
  std::map<std::uint64_t, std::uint64_t> context_of_;         // representation -> its context
  std::map<std::uint64_t, FileUnits> units_;                  // context -> units
  Document document_;
};

}  // namespace

Result<Document> read_step(std::string_view text, const ReadOptions& options) {
  const auto file = Part21::read(text, options.limits);
  if (!file) return file.error();
  return StepReader(*file, text.size(), options).read();
}

}  // namespace watertight::formats
