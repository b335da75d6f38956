// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/part21/units.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace watertight::formats {
namespace {

constexpr std::uint32_t kDeepestUnit = 8;  // units that are multiples of units

enum class Quantity : std::uint8_t { length, angle, other };

struct Unit {
  Quantity quantity = Quantity::other;
  double factor = 1;  // metres or radians
};

struct Prefix {
  std::string_view name;
  double factor;
};
constexpr std::array<Prefix, 16> kPrefixes{{{"EXA", 1e18},
                                            {"PETA", 1e15},
                                            {"TERA", 1e12},
                                            {"GIGA", 1e9},
                                            {"MEGA", 1e6},
                                            {"KILO", 1e3},
                                            {"HECTO", 1e2},
                                            {"DECA", 1e1},
                                            {"DECI", 1e-1},
                                            {"CENTI", 1e-2},
                                            {"MILLI", 1e-3},
                                            {"MICRO", 1e-6},
                                            {"NANO", 1e-9},
                                            {"PICO", 1e-12},
                                            {"FEMTO", 1e-15},
                                            {"ATTO", 1e-18}}};

double factor_of(std::string_view prefix) {
  const auto at = std::find_if(kPrefixes.begin(), kPrefixes.end(),
                               [&](const Prefix& known) { return known.name == prefix; });
  return at == kPrefixes.end() ? 1 : at->factor;
}

Quantity quantity_of(std::string_view kind) {
  if (kind == "LENGTHUNIT") return Quantity::length;
  return kind == "PLANEANGLEUNIT" ? Quantity::angle : Quantity::other;
}

std::string_view enumeration(const std::vector<StepValue>& values, std::size_t at) {
  return at < values.size() && values[at].kind == StepValue::Kind::enumeration ? values[at].text
                                                                               : "";
}

/// The unit of an SI prefix and name: ".MILLI.", ".METRE.".
Unit si_unit(std::string_view prefix, std::string_view name) {
  if (name == "METRE") return {Quantity::length, factor_of(prefix)};
  return name == "RADIAN" ? Unit{Quantity::angle, factor_of(prefix)} : Unit{};
}

Result<Unit> read_unit(const EntityReader& reader, std::uint64_t id, std::uint32_t depth);

/// A multiple of a unit: MEASUREWITHUNIT(value, unit).
Result<double> multiple(const EntityReader& reader, std::uint64_t id, std::uint32_t depth) {
  const auto measure = reader.entity(id);
  if (!measure) return measure.error();
  const auto value = reader.number(*measure, 0);
  if (!value) return value.error();
  const auto unit_id = reader.reference(*measure, 1);
  if (!unit_id) return unit_id.error();
  const auto unit = read_unit(reader, *unit_id, depth + 1);
  if (!unit) return unit.error();
  if (!(*value > 0)) return reader.error(*measure, "a unit that is not positive");
  return *value * unit->factor;
}

/// A unit of STEP: several entities in one instance.
Result<Unit> complex_unit(const EntityReader& reader, const StepInstance& instance,
                          std::uint32_t depth) {
  Unit unit;
  for (const StepEntity& entity : instance.entities) {
    const std::string type = plain_type(entity.type);
    if (quantity_of(type) != Quantity::other) unit.quantity = quantity_of(type);
    if (type == "SIUNIT") {
      const Unit si = si_unit(enumeration(entity.values, 0), enumeration(entity.values, 1));
      if (si.quantity != Quantity::other) unit.factor = si.factor;
    }
    const bool is_multiple = type == "CONVERSIONBASEDUNIT" && entity.values.size() > 1 &&
                             entity.values[1].kind == StepValue::Kind::reference;
    if (!is_multiple) continue;
    const auto factor = multiple(reader, entity.values[1].id, depth);
    if (!factor) return factor.error();
    unit.factor = *factor;
  }
  return unit;
}

Result<Unit> read_unit(const EntityReader& reader, std::uint64_t id, std::uint32_t depth) {
  if (depth > kDeepestUnit) {
    return Error{ErrorCode::malformed, "units refer to each other without end", {}, {}};
  }
  const auto instance = reader.file().instance(id);
  if (!instance) return instance.error();
  if (instance->entities.size() > 1) return complex_unit(reader, *instance, depth);
  const auto found = reader.entity(id);
  if (!found) return found.error();
  if (found->type == "SIUNIT") {
    const Unit unit = si_unit(enumeration(found->values, 2), enumeration(found->values, 3));
    return quantity_of(enumeration(found->values, 1)) == unit.quantity ? unit : Unit{};
  }
  if (found->type == "CONVERSIONBASEDUNIT" && found->values.size() > 3) {
    const Quantity quantity = quantity_of(enumeration(found->values, 1));
    if (quantity == Quantity::other) return Unit{};
    const auto measure = reader.reference(*found, 3);
    if (!measure) return measure.error();
    const auto factor = multiple(reader, *measure, depth);
    if (!factor) return factor.error();
    return Unit{quantity, *factor};
  }
  return Unit{};
}

}  // namespace

Result<FileUnits> read_units(const EntityReader& reader, const std::vector<std::uint64_t>& units) {
  std::optional<double> length;
  std::optional<double> angle;
  for (const std::uint64_t id : units) {
    const auto unit = read_unit(reader, id, 0);
    if (!unit) return unit.error();
    if (unit->quantity == Quantity::other) continue;
    std::optional<double>& known = unit->quantity == Quantity::length ? length : angle;
    if (known && *known != unit->factor) {
      return Error{ErrorCode::malformed,
                   std::string("two units of ") +
                       (unit->quantity == Quantity::length ? "length" : "plane angles") +
                       " contradict each other: " + std::to_string(*known) + " and " +
                       std::to_string(unit->factor) +
                       (unit->quantity == Quantity::length ? " m" : " rad"),
                   {},
                   {}};
    }
    known = unit->factor;
  }
  return FileUnits{length.value_or(1), angle.value_or(1), {}};
}

Result<double> metres_of_unit(const EntityReader& reader, std::uint64_t id) {
  const auto unit = read_unit(reader, id, 0);
  if (!unit) return unit.error();
  if (unit->quantity != Quantity::length) {
    return Error{ErrorCode::malformed, instance_name(id) + " is no unit of length", {}, {}};
  }
  return unit->factor;
}

}  // namespace watertight::formats
