// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <utility>

#include "formats/part21/boundary_reader.h"

namespace watertight::formats {
namespace {

using surfaces::Vector3;

/// Joins the entities of a complex instance that is a B-spline, in the order of their values in
/// IFC; "" as type if it is none.
PlainEntity joined(const StepInstance& instance) {
  constexpr std::array<std::string_view, 6> kParts{
      "BSPLINECURVE",   "BSPLINECURVEWITHKNOTS",   "RATIONALBSPLINECURVE",
      "BSPLINESURFACE", "BSPLINESURFACEWITHKNOTS", "RATIONALBSPLINESURFACE"};
  PlainEntity result{instance.id, instance.offset, {}, {}, true};
  std::vector<std::string> types;
  for (const StepEntity& entity : instance.entities) types.push_back(plain_type(entity.type));
  for (const std::string_view part : kParts) {
    const auto at = std::find(types.begin(), types.end(), part);
    if (at == types.end()) continue;
    const auto& values = instance.entities[static_cast<std::size_t>(at - types.begin())].values;
    result.type = part;
    result.values.insert(result.values.end(), values.begin(), values.end());
  }
  return result;
}

}  // namespace

std::string plain_type(std::string_view type) {
  if (type.starts_with("IFC")) type.remove_prefix(3);
  std::string plain(type);
  plain.erase(std::remove(plain.begin(), plain.end(), '_'), plain.end());
  return plain;
}

Result<PlainEntity> EntityReader::entity(std::uint64_t id) const {
  auto instance = file_.instance(id);
  if (!instance) return std::move(instance).error();
  if (instance->entities.size() > 1) {
    PlainEntity plain = joined(*instance);
    if (plain.type.empty()) plain.type = "COMPLEX";
    return plain;
  }
  StepEntity& only = instance->entities.front();
  const bool is_step = !only.type.starts_with("IFC");
  PlainEntity plain{id, instance->offset, plain_type(only.type), std::move(only.values), is_step};
  // Items of representations have a name in STEP, as their first value; some programs omit it.
  if (is_step && !plain.values.empty() &&
      (plain.values[0].kind == StepValue::Kind::text ||
       plain.values[0].kind == StepValue::Kind::omitted)) {
    plain.values.erase(plain.values.begin());
  }
  return plain;
}

Error EntityReader::error(const PlainEntity& from, const std::string& message) const {
  return Error{ErrorCode::malformed,
               instance_name(from.id) + " (" + from.type + "): " + message,
               from.offset,
               {}};
}

bool EntityReader::has(const PlainEntity& from, std::size_t value) const {
  return value < from.values.size() && from.values[value].kind != StepValue::Kind::omitted &&
         from.values[value].kind != StepValue::Kind::derived;
}

Result<std::uint64_t> EntityReader::reference(const PlainEntity& from, std::size_t value) const {
  if (value >= from.values.size() || from.values[value].kind != StepValue::Kind::reference) {
    return error(from, "value " + std::to_string(value + 1) + " should refer to an instance");
  }
  return from.values[value].id;
}

Result<PlainEntity> EntityReader::entity(const PlainEntity& from, std::size_t value) const {
  const auto id = reference(from, value);
  if (!id) return id.error();
  auto found = entity(*id);
  if (!found && !found.error().byte_offset) return error(from, found.error().message);
  return found;
}

Result<double> EntityReader::number(const PlainEntity& from, std::size_t value) const {
  if (value < from.values.size()) {
    const StepValue& own = from.values[value];
    if (own.kind == StepValue::Kind::number) return own.number;
    if (own.kind == StepValue::Kind::typed && own.items.size() == 1 &&
        own.items[0].kind == StepValue::Kind::number) {
      return own.items[0].number;
    }
  }
  return error(from, "value " + std::to_string(value + 1) + " should be a number");
}

Result<std::vector<std::uint64_t>> EntityReader::references(const PlainEntity& from,
                                                            std::size_t value) const {
  std::vector<std::uint64_t> ids;
  const bool is_list =
      value < from.values.size() && from.values[value].kind == StepValue::Kind::list;
  if (is_list) {
    for (const StepValue& item : from.values[value].items) {
      if (item.kind != StepValue::Kind::reference) break;
      ids.push_back(item.id);
    }
  }
  if (!is_list || ids.size() != from.values[value].items.size()) {
    return error(from, "value " + std::to_string(value + 1) + " should be a list of references");
  }
  return ids;
}

Result<std::vector<double>> EntityReader::numbers(const PlainEntity& from,
                                                  std::size_t value) const {
  std::vector<double> numbers;
  const bool is_list =
      value < from.values.size() && from.values[value].kind == StepValue::Kind::list;
  if (is_list) {
    for (const StepValue& item : from.values[value].items) {
      if (item.kind != StepValue::Kind::number) break;
      numbers.push_back(item.number);
    }
  }
  if (!is_list || numbers.size() != from.values[value].items.size()) {
    return error(from, "value " + std::to_string(value + 1) + " should be a list of numbers");
  }
  return numbers;
}

Result<Vector3> EntityReader::triple(std::uint64_t id) const {
  const auto found = entity(id);
  if (!found) return found.error();
  if (found->type != "CARTESIANPOINT" && found->type != "DIRECTION") {
    return error(*found, "a point or a direction should stand here");
  }
  const auto values = numbers(*found, 0);
  if (!values) return values.error();
  if (values->size() < 2 || values->size() > 3) {
    return error(*found, std::to_string(values->size()) + " coordinates");
  }
  return Vector3{(*values)[0], (*values)[1], values->size() == 3 ? (*values)[2] : 0};
}

Result<surfaces::Frame> EntityReader::frame(std::uint64_t id) const {
  const auto found = entity(id);
  if (!found) return found.error();
  const bool is_plane = found->type == "AXIS2PLACEMENT2D";
  if (!is_plane && found->type != "AXIS2PLACEMENT3D" && found->type != "AXIS1PLACEMENT") {
    return error(*found, "a placement should stand here");
  }
  const auto place_id = reference(*found, 0);
  if (!place_id) return place_id.error();
  const auto origin = triple(*place_id);
  if (!origin) return origin.error();
  Vector3 axis{0, 0, 1};
  Vector3 side{1, 0, 0};
  const auto direction = [&](std::size_t value, Vector3& out) -> Status {
    if (!has(*found, value)) return Done{};
    const auto direction_id = reference(*found, value);
    if (!direction_id) return direction_id.error();
    const auto vector = triple(*direction_id);
    if (!vector) return vector.error();
    if (!(surfaces::length(*vector) > 0)) return error(*found, "a direction without length");
    out = *vector;
    return Done{};
  };
  if (Status status = direction(1, is_plane ? side : axis); !status) return status.error();
  if (!is_plane) {
    if (Status status = direction(2, side); !status) return status.error();
  }
  return surfaces::frame_of(*origin, axis, side);
}

}  // namespace watertight::formats
