// SPDX-License-Identifier: GPL-3.0-or-later
//
// IFC files: every product with solids is a feature, in metres and in the system of the map
// conversion if there is one. Source: ISO 16739-1 (IFC4), resource schemas for geometry, placement
// and units.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/quantity.h"
#include "formats/curved/curved_files.h"
#include "formats/part21/boundary_reader.h"
#include "formats/part21/solid_instance.h"
#include "formats/part21/units.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

using surfaces::Affine;
using surfaces::Frame;
using surfaces::Vector3;
using surfaces::operator*;

constexpr std::uint32_t kDeepestItem =
    64;  // placements in placements, mapped items in mapped items

class IfcReader {
 public:
  IfcReader(const Part21& file, std::size_t bytes, const ReadOptions& options)
      : reader_(file),
        options_(options),
        most_items_(options.limits.solids_of(bytes)),
        budget_(options.limits.claimed_by(bytes)) {}

  Result<Document> read() {
    document_.format = Format::ifc;
    if (Status status = find_project(); !status) return status.error();
    for (const StepPlace& place : reader_.file().places()) {
      if (Status status = product(place); !status) return status.error();
    }
    if (document_.features.empty()) document_.notes.push_back("no product of the file has a solid");
    for (const auto& [type, count] : left_out_) {
      document_.notes.push_back(quantity(count, "body", "bodies") + " of the kind " + type +
                                " left out");
    }
    return std::move(document_);
  }

 private:
  /// Reads units, and where the model lies on the map.
  Status find_project() {
    to_world_ = Affine{};
    for (const StepPlace& place : reader_.file().places()) {
      if (place.type == "IFCUNITASSIGNMENT") {
        const auto found = reader_.entity(place.id);
        if (!found) return found.error();
        const auto ids = reader_.references(*found, 0);
        if (!ids) return ids.error();
        const auto units = read_units(reader_, *ids);
        if (!units) return units.error();
        units_ = *units;
      }
      if (place.type == "IFCGEOMETRICREPRESENTATIONCONTEXT") add_precision(place.id);
    }
    const double metre = units_.metre;
    to_world_.columns = {Vector3{metre, 0, 0}, Vector3{0, metre, 0}, Vector3{0, 0, metre}};
    for (const StepPlace& place : reader_.file().places()) {
      if (place.type != "IFCMAPCONVERSION") continue;
      if (Status status = map_conversion(place.id); !status) return status;
    }
    return Done{};
  }

  void add_precision(std::uint64_t id) {
    const auto found = reader_.entity(id);
    if (!found || !reader_.has(*found, 3)) return;
    const auto precision = reader_.number(*found, 3);
    if (precision && *precision > 0) precision_ = *precision;
  }

  // source, target, eastings, northings, height, abscissa and ordinate of the axis x, scale
  Status map_conversion(std::uint64_t id) {
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    Vector3 shift{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = reader_.number(*found, 2 + axis);
      if (!value) return value.error();
      shift[axis] = *value;
    }
    double x = 1;
    double y = 0;
    if (reader_.has(*found, 5) && reader_.has(*found, 6)) {
      const auto abscissa = reader_.number(*found, 5);
      const auto ordinate = reader_.number(*found, 6);
      if (!abscissa || !ordinate) return reader_.error(*found, "its axis should be two numbers");
      x = *abscissa;
      y = *ordinate;
    }
    const double size = std::sqrt(x * x + y * y);
    if (!(size > 0)) return reader_.error(*found, "its axis has no length");
    const Frame frame = surfaces::frame_of(shift, {0, 0, 1}, {x / size, y / size, 0});
    // The map's coordinates are taken as metres: the scale of a conversion says the same as the
    // units.
    to_world_ = composed(affine_of(frame), to_world_);
    const auto target = reader_.entity(*found, 1);
    if (target && !target->values.empty() && target->values[0].kind == StepValue::Kind::text) {
      srid_ = epsg_code(decoded_text(target->values[0].text));
    }
    return Done{};
  }

  /// A product has a global id, a history, three texts, a placement and a representation.
  Status product(const StepPlace& place) {
    const std::string_view type = place.type;
    if (!type.starts_with("IFC") || type.starts_with("IFCREL") || type == "IFCPROJECT") {
      return Done{};
    }
    const auto instance = reader_.file().instance(place.id);
    if (!instance) return instance.error();
    const std::vector<StepValue>& values = instance->entities[0].values;
    const bool is_product = values.size() > 6 && values[0].kind == StepValue::Kind::text &&
                            values[6].kind == StepValue::Kind::reference;
    if (!is_product) return Done{};
    const std::string_view shape_type = reader_.file().type_of(values[6].id);
    if (shape_type != "IFCPRODUCTDEFINITIONSHAPE") return Done{};
    Affine placement = to_world_;
    if (values[5].kind == StepValue::Kind::reference) {
      const auto own = placement_of(values[5].id, 0);
      if (!own) return own.error();
      placement = composed(to_world_, *own);
    }
    Feature feature;
    feature.id = decoded_text(values[0].text);
    feature.type = type;
    feature.srid = srid_;
    const auto shape = reader_.entity(values[6].id);
    if (!shape) return shape.error();
    const auto representations = reader_.references(*shape, 2);
    if (!representations) return representations.error();
    for (const std::uint64_t id : *representations) {
      if (Status status = representation(id, placement, true, 0, feature); !status) return status;
    }
    if (solid_count(feature) > 0) document_.features.push_back(std::move(feature));
    return Done{};
  }

  // relative to, placement
  Result<Affine> placement_of(std::uint64_t id, std::uint32_t depth) {
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    if (found->type != "LOCALPLACEMENT") {
      return Error{ErrorCode::unsupported,
                   "placements of the kind " + found->type + " are not read",
                   found->offset,
                   {}};
    }
    if (depth > kDeepestItem) return reader_.error(*found, "placements in placements without end");
    const auto frame_id = reader_.reference(*found, 1);
    if (!frame_id) return frame_id.error();
    const auto frame = reader_.frame(*frame_id);
    if (!frame) return frame.error();
    if (!reader_.has(*found, 0)) return affine_of(*frame);
    const auto outer_id = reader_.reference(*found, 0);
    if (!outer_id) return outer_id.error();
    const auto outer = placement_of(*outer_id, depth + 1);
    if (!outer) return outer.error();
    return composed(*outer, affine_of(*frame));
  }

  // context, identifier, type, items
  Status representation(std::uint64_t id, const Affine& placement, bool is_of_product,
                        std::uint32_t depth, Feature& feature) {
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    if (depth > kDeepestItem)
      return reader_.error(*found, "mapped items in mapped items without end");
    const bool has_name =
        found->values.size() > 1 && found->values[1].kind == StepValue::Kind::text;
    if (is_of_product && has_name && found->values[1].text != "Body") return Done{};
    const auto items = reader_.references(*found, 3);
    if (!items) return items.error();
    for (const std::uint64_t item_id : *items) {
      if (++items_ > most_items_) {
        return Error{
            ErrorCode::limit_exceeded,
            "mapped items repeat bodies more than " + std::to_string(most_items_) + " times",
            found->offset,
            {}};
      }
      const auto type = plain_type(reader_.file().type_of(item_id));
      if (type == "MAPPEDITEM") {
        if (Status status = mapped_item(item_id, placement, depth, feature); !status) return status;
      } else if (is_solid_type(type)) {
        if (Status status = add_solid(item_id, type, placement, feature); !status) return status;
      } else {
        ++left_out_["IFC" + type];
      }
    }
    return Done{};
  }

  // map (origin, representation), target
  Status mapped_item(std::uint64_t id, const Affine& placement, std::uint32_t depth,
                     Feature& feature) {
    const auto found = reader_.entity(id);
    if (!found) return found.error();
    const auto map = reader_.entity(*found, 0);
    if (!map) return map.error();
    const auto origin_id = reader_.reference(*map, 0);
    if (!origin_id) return origin_id.error();
    const auto origin = reader_.frame(*origin_id);
    if (!origin) return origin.error();
    const auto target_entity = reader_.entity(*found, 1);
    if (!target_entity) return target_entity.error();
    const auto target = operator_of(*target_entity);
    if (!target) return target.error();
    const auto inner = reader_.reference(*map, 1);
    if (!inner) return inner.error();
    const Affine own =
        composed(composed(placement, *target), inverse_of_motion(affine_of(*origin)));
    return representation(*inner, own, false, depth + 1, feature);
  }

  // axes x and y, origin, scale, axis z, scales of y and z
  Result<Affine> operator_of(const PlainEntity& from) {
    std::array<std::optional<Vector3>, 3> axes;
    constexpr std::array<std::size_t, 3> kAxes{0, 1, 4};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!reader_.has(from, kAxes[axis])) continue;
      const auto id = reader_.reference(from, kAxes[axis]);
      if (!id) return id.error();
      const auto direction = reader_.triple(*id);
      if (!direction) return direction.error();
      if (!(surfaces::length(*direction) > 0)) return reader_.error(from, "an axis of length 0");
      axes[axis] = *direction;
    }
    const auto origin_id = reader_.reference(from, 2);
    if (!origin_id) return origin_id.error();
    const auto origin = reader_.triple(*origin_id);
    if (!origin) return origin.error();
    const Frame frame = surfaces::frame_of(*origin, axes[2].value_or(Vector3{0, 0, 1}),
                                           axes[0].value_or(Vector3{1, 0, 0}));
    Affine result = affine_of(frame);
    // A second axis on the other side makes a mirror image.
    if (axes[1] && surfaces::dot(*axes[1], frame.y) < 0) {
      result.columns[1] = result.columns[1] * -1.0;
    }
    double scale = 1;
    if (reader_.has(from, 3)) {
      const auto own = reader_.number(from, 3);
      if (!own) return own.error();
      scale = *own;
    }
    std::array<double, 3> scales{scale, scale, scale};
    for (const std::size_t axis : {1, 2}) {
      if (!reader_.has(from, 4 + axis)) continue;
      const auto own = reader_.number(from, 4 + axis);
      if (!own) return own.error();
      scales[axis] = *own;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(scales[axis] > 0)) return reader_.error(from, "a scale that is not positive");
      result.columns[axis] = result.columns[axis] * scales[axis];
    }
    return result;
  }

  Status add_solid(std::uint64_t id, const std::string& type, const Affine& placement,
                   Feature& feature) {
    SolidSource source{instance_name(id),
                       "Ifc" + type,
                       "",
                       static_cast<std::uint32_t>(solid_count(feature)),
                       0,
                       ""};
    if (solid_count(feature) >= options_.limits.solids) {
      return Error{
          ErrorCode::limit_exceeded,
          "more solids in one product than the limit of " + std::to_string(options_.limits.solids),
          {},
          {}};
    }
    return add_solid_instance(reader_.file(), {id, units_.radian, precision_ * units_.metre},
                              {placement, srid_, std::move(source)}, options_, budget_, document_,
                              feature);
  }

  EntityReader reader_;
  const ReadOptions& options_;
  std::uint64_t most_items_;
  std::uint64_t budget_;     // add_curved_solid()
  std::uint64_t items_ = 0;  // of representations, counted each time they are used
  FileUnits units_;
  double precision_ = 1e-5;  // in units of length
  Affine to_world_;          // from the units of the file to metres on the map
  std::uint32_t srid_ = 0;
  std::map<std::string, std::uint64_t> left_out_;  // kinds of bodies that are no solids here
  Document document_;
};

}  // namespace

Result<Document> read_ifc(std::string_view text, const ReadOptions& options) {
  const auto file = Part21::read(text, options.limits);
  if (!file) return file.error();
  return IfcReader(*file, text.size(), options).read();
}

}  // namespace watertight::formats
