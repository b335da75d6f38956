// SPDX-License-Identifier: GPL-3.0-or-later
#include "sql/info_json.h"

#include <array>
#include <charconv>

namespace watertight::sql {
namespace {

/// The members of a JSON object in the order in which they are added. Names and texts are ASCII
/// without quotes.
class JsonObject {
 public:
  JsonObject& add(const char* name, const std::string& json) {
    text_ += text_.empty() ? "{\"" : ",\"";
    text_ += name;
    text_ += "\":";
    text_ += json;
    return *this;
  }
  JsonObject& add(const char* name, std::uint64_t value) {
    return add(name, std::to_string(value));
  }
  std::string close() const { return text_.empty() ? "{}" : text_ + "}"; }

 private:
  std::string text_;
};

std::string quoted(std::string_view text) {
  std::string json(1, '"');
  json += text;
  json += '"';
  return json;
}

std::string number(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return std::string(digits.data(), end.ptr);
}

std::string_view kind_name(LatticeKind kind) {
  switch (kind) {
    case LatticeKind::decimal:
      return "decimal";
    case LatticeKind::binary:
      return "binary";
    case LatticeKind::float64:
      return "float64";
  }
  return "";
}

std::string lattice_json(const Lattice& lattice) {
  std::string steps;
  std::string origins;
  for (int axis = 0; axis < 3; ++axis) {
    steps += axis == 0 ? '[' : ',';
    steps += number(lattice.scale(axis));
    origins += axis == 0 ? '[' : ',';
    origins += lattice.world_text(0, axis);
  }
  steps += ']';
  origins += ']';
  return JsonObject()
      .add("kind", quoted(kind_name(lattice.kind)))
      .add("step", steps)
      .add("origin", origins)
      .close();
}

std::string proof_json(Proof proof) {
  return quoted(proof == Proof::boundary ? "boundary" : "tetrahedralization");
}

std::string acceptance_json(const Acceptance& acceptance) {
  const Tolerances& tolerances = acceptance.tolerances;
  return JsonObject()
      .add("proof", proof_json(acceptance.proof))
      .add("rule_set", acceptance.rule_set)
      .add("planarity_metres", number(tolerances.planarity_metres))
      .add("planarity_degrees", number(tolerances.planarity_degrees))
      .add("snap_metres", number(tolerances.snap_metres))
      .close();
}

}  // namespace

std::string info_json(const codec::BlobInfo& info, std::size_t bytes) {
  JsonObject parts;
  for (const codec::BlobInfo::Part& part : info.parts)
    parts.add(part.name.c_str(), number(part.bytes));
  return JsonObject()
      .add("version", info.version)
      .add("models", info.models)
      .add("mode", quoted(codec::to_string(info.mode)))
      .add("bytes", bytes)
      .add("srid", info.srid)
      .add("acceptance", acceptance_json(info.acceptance))
      .add("lattice", lattice_json(info.lattice))
      .add("shells", info.shells)
      .add("facets", info.facets)
      .add("rings", info.rings)
      .add("vertices", info.vertices)
      .add("steiner_vertices", info.steiner_vertices)
      .add("delaunay_faces", info.delaunay_faces)
      .add("marked_faces", info.marked_faces)
      .add("unrecovered_faces", info.unrecovered_faces)
      .add("keeps_order", info.has_order ? "true" : "false")
      .add("checksum", info.checksum)
      .add("parts", parts.close())
      .close();
}

std::string rules_json(const Acceptance& acceptance) {
  const Tolerances& tolerances = acceptance.tolerances;
  JsonObject json;
  json.add("planarity", number(tolerances.planarity_metres))
      .add("planarity_angle", number(tolerances.planarity_degrees))
      .add("proof", proof_json(acceptance.proof))
      .add("rule_set", acceptance.rule_set);
  if (tolerances.snap_metres != 0) json.add("snap", number(tolerances.snap_metres));
  return json.close();
}

}  // namespace watertight::sql
