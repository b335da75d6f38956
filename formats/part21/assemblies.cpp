// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/part21/assemblies.h"

#include <algorithm>
#include <utility>

#include "geometry/disjoint_sets.h"
#include "surfaces/curves/elementary.h"

namespace watertight::formats {
namespace {

using surfaces::Affine;
using surfaces::operator*;

constexpr std::size_t kDeepestUsage = 64;  // assemblies in assemblies

/// The instance to which a value refers; 0 if it refers to none.
std::uint64_t id_at(const StepEntity& entity, std::size_t value) {
  const bool refers =
      value < entity.values.size() && entity.values[value].kind == StepValue::Kind::reference;
  return refers ? entity.values[value].id : 0;
}

const StepEntity* entity_of(const StepInstance& instance, std::string_view type) {
  const auto found = std::find_if(instance.entities.begin(), instance.entities.end(),
                                  [&](const StepEntity& entity) { return entity.type == type; });
  return found == instance.entities.end() ? nullptr : &*found;
}

/// Whether an instance may be a representation of a shape, and no drawing. Complex instances have
/// no type here.
bool is_shape(const Part21& file, std::uint64_t id) {
  const std::string_view type = file.type_of(id);
  return id != 0 && (type.empty() || type.find("SHAPE_REPRESENTATION") != std::string_view::npos);
}

/// The map from the metres in a frame to those around it. `metre` is the unit of the frame.
Result<Affine> from_frame(const EntityReader& reader, std::uint64_t id, double metre) {
  auto frame = reader.frame(id);
  if (!frame) return std::move(frame).error();
  frame->origin = frame->origin * metre;
  return surfaces::affine_of(*frame);
}

/// The map that puts one frame onto another one.
Result<Affine> frame_to_frame(const EntityReader& reader, std::uint64_t from, double from_metre,
                              std::uint64_t to, double to_metre) {
  const auto start = from_frame(reader, from, from_metre);
  if (!start) return start.error();
  const auto end = from_frame(reader, to, to_metre);
  if (!end) return end.error();
  return surfaces::composed(*end, surfaces::inverse_of_motion(*start));
}

}  // namespace

Result<Assemblies> Assemblies::read(const EntityReader& reader, const MetreOf& metre_of) {
  Assemblies assemblies;
  std::vector<Relationship> relationships;
  Products products;
  if (Status status = assemblies.read_relationships(reader, relationships, products); !status) {
    return status.error();
  }
  // First those of one place: they tell which side of a usage is the whole.
  assemblies.join_places(reader.file().places(), relationships);
  for (const Relationship& relationship : relationships) {
    if (relationship.transformation == 0) continue;
    Status status = assemblies.add_usage(reader, metre_of, relationship, products);
    if (!status) return status.error();
  }
  if (Status status = assemblies.read_mapped_items(reader, metre_of); !status) {
    return status.error();
  }
  return assemblies;
}

void Assemblies::join_places(std::span<const StepPlace> places,
                             const std::vector<Relationship>& relationships) {
  const auto index_of = [&](std::uint64_t id) {
    const auto found =
        std::lower_bound(places.begin(), places.end(), id,
                         [](const StepPlace& place, std::uint64_t of) { return place.id < of; });
    return static_cast<Index>(found - places.begin());
  };
  geometry::DisjointSets sets(places.size() + 1);
  for (const Relationship& own : relationships) {
    if (own.transformation == 0) sets.join(index_of(own.first), index_of(own.second));
  }
  for (const Relationship& own : relationships) {
    for (const std::uint64_t id : {own.first, own.second}) {
      const Index root = sets.root(index_of(id));
      if (root < places.size()) same_place_as_.emplace(id, places[root].id);
    }
  }
}

Status Assemblies::read_relationships(const EntityReader& reader, std::vector<Relationship>& all,
                                      Products& products) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> shapes;  // and their representations
  for (const StepPlace& place : reader.file().places()) {
    const std::string_view type = place.type;
    const bool is_relevant =
        type.empty() || type.ends_with("REPRESENTATION_RELATIONSHIP") ||
        type == "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION" || type == "PRODUCT_DEFINITION_SHAPE" ||
        type == "NEXT_ASSEMBLY_USAGE_OCCURRENCE" || type == "SHAPE_DEFINITION_REPRESENTATION";
    if (!is_relevant) continue;
    const auto instance = reader.file().instance(place.id);
    if (!instance) return instance.error();
    const StepEntity& entity = instance->entities.front();
    if (type == "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") {
      products.usage_of.emplace(id_at(entity, 0), id_at(entity, 1));
    } else if (type == "PRODUCT_DEFINITION_SHAPE") {
      products.definition_of.emplace(place.id, id_at(entity, 2));
    } else if (type == "NEXT_ASSEMBLY_USAGE_OCCURRENCE") {
      products.whole_of.emplace(place.id, id_at(entity, 3));
    } else if (type == "SHAPE_DEFINITION_REPRESENTATION") {
      shapes.emplace_back(id_at(entity, 0), id_at(entity, 1));
    } else {
      const StepEntity* relation =
          type.empty() ? entity_of(*instance, "REPRESENTATION_RELATIONSHIP") : &entity;
      if (relation == nullptr) continue;
      const StepEntity* moved =
          entity_of(*instance, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION");
      const Relationship own{place.id, id_at(*relation, 2), id_at(*relation, 3),
                             moved == nullptr ? 0 : id_at(*moved, 0)};
      if (is_shape(reader.file(), own.first) && is_shape(reader.file(), own.second)) {
        all.push_back(own);
      }
    }
  }
  for (const auto& [shape, representation] : shapes) {
    const auto definition = products.definition_of.find(shape);
    if (definition == products.definition_of.end()) continue;
    products.representations_of[definition->second].push_back(representation);
  }
  return Done{};
}

/// The first representation is part of the second one. Some programs write them the other way
/// round; the usage of a product tells.
bool Assemblies::is_reversed(const Relationship& relationship, const Products& products) const {
  const auto follow = [](const std::map<std::uint64_t, std::uint64_t>& next, std::uint64_t from) {
    const auto found = next.find(from);
    return found == next.end() ? std::uint64_t{0} : found->second;
  };
  const std::uint64_t usage =
      follow(products.definition_of, follow(products.usage_of, relationship.instance));
  const auto whole = products.representations_of.find(follow(products.whole_of, usage));
  if (whole == products.representations_of.end()) return false;
  const auto is_whole = [&](std::uint64_t side) {
    return std::any_of(whole->second.begin(), whole->second.end(),
                       [&](std::uint64_t own) { return joint(own) == joint(side); });
  };
  return is_whole(relationship.first) && !is_whole(relationship.second);
}

Status Assemblies::add_usage(const EntityReader& reader, const MetreOf& metre_of,
                             Relationship relationship, const Products& products) {
  const auto first_metre = metre_of(relationship.first);
  if (!first_metre) return first_metre.error();
  const auto second_metre = metre_of(relationship.second);
  if (!second_metre) return second_metre.error();
  const auto read = [&]() -> Result<Affine> {
    const auto transformation = reader.file().instance(relationship.transformation);
    if (!transformation) return transformation.error();
    const StepEntity& entity = transformation->entities.front();
    if (entity.type != "ITEM_DEFINED_TRANSFORMATION") {
      return Error{
          ErrorCode::unsupported,
          instance_name(relationship.transformation) + " is no ITEM_DEFINED_TRANSFORMATION",
          transformation->offset,
          {}};
    }
    return frame_to_frame(reader, id_at(entity, 2), *first_metre, id_at(entity, 3), *second_metre);
  };
  auto placement = read();
  if (!placement) {
    notes_.push_back("the placement " + instance_name(relationship.instance) +
                     " of a part is not applied: " + placement.error().message);
    placement = Affine{};
  }
  std::uint64_t part = relationship.first;
  std::uint64_t whole = relationship.second;
  if (is_reversed(relationship, products)) {
    std::swap(part, whole);
    placement = surfaces::inverse_of_motion(*placement);
  }
  usages_[joint(part)].push_back({whole, *placement, relationship.instance});
  return Done{};
}

Status Assemblies::read_mapped_items(const EntityReader& reader, const MetreOf& metre_of) {
  for (const StepPlace& place : reader.file().places()) {
    if (!place.type.ends_with("SHAPE_REPRESENTATION")) continue;
    const auto found = reader.entity(place.id);
    if (!found) return found.error();
    const auto items = reader.references(*found, 0);
    if (!items) continue;
    for (const std::uint64_t item_id : *items) {
      if (reader.file().type_of(item_id) != "MAPPED_ITEM") continue;
      const auto item = reader.entity(item_id);
      if (!item) return item.error();
      const auto map = reader.entity(*item, 0);
      if (!map) return map.error();
      const auto part = reader.reference(*map, 1);
      if (!part) return part.error();
      const auto part_metre = metre_of(*part);
      const auto whole_metre = metre_of(place.id);
      if (!part_metre) return part_metre.error();
      if (!whole_metre) return whole_metre.error();
      const auto origin = reader.reference(*map, 0);
      const auto target = reader.reference(*item, 1);
      if (!origin) return origin.error();
      if (!target) return target.error();
      auto placement = frame_to_frame(reader, *origin, *part_metre, *target, *whole_metre);
      if (!placement) {
        notes_.push_back("the mapped item " + instance_name(item_id) +
                         " is not moved: " + placement.error().message);
        placement = Affine{};
      }
      usages_[joint(*part)].push_back({place.id, *placement, item_id});
    }
  }
  return Done{};
}

/// The representation that stands for all that have the place of the given one.
std::uint64_t Assemblies::joint(std::uint64_t representation) const {
  const auto found = same_place_as_.find(representation);
  return found == same_place_as_.end() ? representation : found->second;
}

Result<std::vector<PartPlace>> Assemblies::places_of(std::uint64_t representation,
                                                     std::uint64_t& count,
                                                     std::uint64_t most) const {
  std::vector<PartPlace> places;
  Status status = add_places(representation, {}, count, most, places);
  if (!status) return status.error();
  return places;
}

Status Assemblies::add_places(std::uint64_t representation, const PartPlace& inner,
                              std::uint64_t& count, std::uint64_t most,
                              std::vector<PartPlace>& places) const {
  if (inner.usages.size() > kDeepestUsage) {
    return Error{ErrorCode::malformed,
                 instance_name(inner.usages.back()) + ": assemblies in assemblies without end",
                 {},
                 {}};
  }
  const auto found = usages_.find(joint(representation));
  if (found == usages_.end()) {
    if (++count > most) {
      return Error{ErrorCode::limit_exceeded,
                   "assemblies repeat parts more than " + std::to_string(most) + " times",
                   {},
                   {}};
    }
    places.push_back(inner);
    return Done{};
  }
  for (const Usage& usage : found->second) {
    PartPlace outer = inner;
    outer.to_whole = surfaces::composed(usage.to_whole, inner.to_whole);
    outer.usages.push_back(usage.instance);
    if (Status status = add_places(usage.whole, outer, count, most, places); !status) return status;
  }
  return Done{};
}

}  // namespace watertight::formats
