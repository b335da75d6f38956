// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/part21/boundary_curves.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "surfaces/curves/nurbs.h"

namespace watertight::formats {
namespace {

using surfaces::Curve;
using surfaces::Frame;
using surfaces::Surface;
using surfaces::Vector3;
using surfaces::operator+;
using surfaces::operator*;

constexpr std::uint32_t kDeepestCurve = 8;     // curves within curves
constexpr std::size_t kMostKnots = 1'000'000;  // of a B-spline, with multiplicities
constexpr double kUpright = 1.5707;            // radians: a cone of this angle is a plane

Error unsupported(const PlainEntity& from, const std::string& kind) {
  return Error{ErrorCode::unsupported,
               instance_name(from.id) + " (" + from.type + "): " + kind +
                   " of this kind "
                   "are not read",
               from.offset,
               {}};
}

/// The error of `result`, at the place of an entity if it has none.
template <class Value>
Error at_entity(const EntityReader& reader, const PlainEntity& from, const Result<Value>& result) {
  Error error = result.error();
  if (error.byte_offset) return error;
  const ErrorCode code = error.code;
  error = reader.error(from, error.message);
  error.code = code;
  return error;
}

Result<std::vector<Vector3>> points_of(const EntityReader& reader,
                                       const std::vector<std::uint64_t>& ids) {
  std::vector<Vector3> points;
  points.reserve(ids.size());
  for (const std::uint64_t id : ids) {
    auto point = reader.triple(id);
    if (!point) return std::move(point).error();
    points.push_back(*point);
  }
  return points;
}

Result<double> positive(const EntityReader& reader, const PlainEntity& from, std::size_t value) {
  auto number = reader.number(from, value);
  if (number && !(*number > 0)) return reader.error(from, "a radius that is not positive");
  return number;
}

Result<surfaces::Knots> knots_of(const EntityReader& reader, const PlainEntity& from,
                                 std::size_t degree, std::size_t counts, std::size_t values) {
  const auto own_degree = reader.number(from, degree);
  if (!own_degree) return own_degree.error();
  const auto multiplicities = reader.numbers(from, counts);
  if (!multiplicities) return multiplicities.error();
  const auto knots = reader.numbers(from, values);
  if (!knots) return knots.error();
  if (multiplicities->size() != knots->size()) {
    return reader.error(from, std::to_string(knots->size()) + " knots with " +
                                  std::to_string(multiplicities->size()) + " multiplicities");
  }
  if (!(*own_degree >= 1 && *own_degree <= 1000)) return reader.error(from, "its degree");
  surfaces::Knots result{static_cast<std::size_t>(*own_degree), {}};
  for (std::size_t i = 0; i < knots->size(); ++i) {
    const double count = (*multiplicities)[i];
    if (!(count >= 1 && count <= 1000) || result.values.size() > kMostKnots) {
      return reader.error(from, "a multiplicity of " + std::to_string(count));
    }
    if (i > 0 && !((*knots)[i] > (*knots)[i - 1])) return reader.error(from, "knots decrease");
    result.values.insert(result.values.end(), static_cast<std::size_t>(count), (*knots)[i]);
  }
  return result;
}

// degree, points, form, closed, crossing, multiplicities, knots, form of knots, weights
Result<Curve> spline(const EntityReader& reader, const PlainEntity& from) {
  const auto knots = knots_of(reader, from, 0, 5, 6);
  if (!knots) return knots.error();
  const auto ids = reader.references(from, 1);
  if (!ids) return ids.error();
  const auto points = points_of(reader, *ids);
  if (!points) return points.error();
  std::vector<double> weights(points->size(), 1);
  if (from.type.starts_with("RATIONAL")) {
    const auto own = reader.numbers(from, 8);
    if (!own) return own.error();
    weights = *own;
  }
  auto curve = surfaces::curve_of(*knots, *points, weights);
  if (!curve) return at_entity(reader, from, curve);
  return curve;
}

Result<Curve> line(const EntityReader& reader, const PlainEntity& from) {
  const auto origin_id = reader.reference(from, 0);
  if (!origin_id) return origin_id.error();
  const auto origin = reader.triple(*origin_id);
  if (!origin) return origin.error();
  const auto vector = reader.entity(from, 1);
  if (!vector) return vector.error();
  const auto direction_id = reader.reference(*vector, 0);
  if (!direction_id) return direction_id.error();
  const auto direction = reader.triple(*direction_id);
  if (!direction) return direction.error();
  if (!(surfaces::length(*direction) > 0)) return reader.error(from, "a line without direction");
  return surfaces::polyline({*origin, *origin + *direction});
}

Result<Curve> conic(const EntityReader& reader, const PlainEntity& from) {
  const auto frame_id = reader.reference(from, 0);
  if (!frame_id) return frame_id.error();
  const auto frame = reader.frame(*frame_id);
  if (!frame) return frame.error();
  const auto first = positive(reader, from, 1);
  if (!first) return first.error();
  const auto second = from.type == "ELLIPSE" ? positive(reader, from, 2) : first;
  if (!second) return second.error();
  return surfaces::ellipse(*frame, *first, *second);
}

/// The place of a trimming point; nothing if only a parameter is given.
Result<std::optional<Vector3>> trim_place(const EntityReader& reader, const PlainEntity& from,
                                          std::size_t value) {
  if (value >= from.values.size() || from.values[value].kind != StepValue::Kind::list) {
    return reader.error(from, "value " + std::to_string(value + 1) + " should be a list");
  }
  for (const StepValue& item : from.values[value].items) {
    if (item.kind != StepValue::Kind::reference) continue;
    auto place = reader.triple(item.id);
    if (!place) return std::move(place).error();
    return std::optional<Vector3>(*place);
  }
  return std::optional<Vector3>();
}

Result<Curve> trimmed(const EntityReader& reader, const PlainEntity& from, std::uint32_t depth) {
  const auto basis_id = reader.reference(from, 0);
  if (!basis_id) return basis_id.error();
  auto basis = read_curve(reader, *basis_id, depth + 1);
  if (!basis) return basis;
  const auto first = trim_place(reader, from, 1);
  if (!first) return first.error();
  const auto second = trim_place(reader, from, 2);
  if (!second) return second.error();
  const bool agrees = from.values.size() > 3 && from.values[3].is_true();
  Curve curve = agrees ? *std::move(basis) : surfaces::reversed(*basis);
  if (!first->has_value() || !second->has_value()) return unsupported(from, "trims by parameters");
  if (curve.pieces.size() == 1 && curve.pieces[0].degree() == 1) {
    return surfaces::polyline({**first, **second});
  }
  double start = surfaces::nearest_parameter(curve, **first);
  double end = surfaces::nearest_parameter(curve, **second);
  if (!curve.is_closed && end <= start) {
    start = curve.breaks.front();
    end = curve.breaks.back();
  }
  Curve part = surfaces::part_of(curve, start, end);
  if (part.pieces.empty()) return reader.error(from, "a curve of no length");
  return part;
}

Result<Curve> composite(const EntityReader& reader, const PlainEntity& from, std::uint32_t depth) {
  const auto segments = reader.references(from, 0);
  if (!segments) return segments.error();
  Curve whole;
  whole.breaks.push_back(0);
  for (const std::uint64_t id : *segments) {
    const auto segment = reader.entity(id);
    if (!segment) return segment.error();
    const auto parent = reader.reference(*segment, 2);
    if (!parent) return parent.error();
    auto part = read_curve(reader, *parent, depth + 1);
    if (!part) return part;
    const bool agrees = segment->values[1].is_true();
    Curve curve = agrees ? *std::move(part) : surfaces::reversed(*part);
    for (surfaces::BezierCurve& piece : curve.pieces) {
      whole.pieces.push_back(std::move(piece));
      whole.breaks.push_back(whole.breaks.back() + 1);
    }
  }
  if (whole.pieces.empty()) return reader.error(from, "a curve without segments");
  return whole;
}

}  // namespace

Result<Curve> read_curve(const EntityReader& reader, std::uint64_t id, std::uint32_t depth) {
  if (depth > kDeepestCurve) {
    return Error{ErrorCode::limit_exceeded,
                 "curves within curves deeper than " + std::to_string(kDeepestCurve),
                 {},
                 {}};
  }
  const auto found = reader.entity(id);
  if (!found) return found.error();
  const std::string& type = found->type;
  if (type == "LINE") return line(reader, *found);
  if (type == "CIRCLE" || type == "ELLIPSE") return conic(reader, *found);
  if (type == "BSPLINECURVEWITHKNOTS" || type == "RATIONALBSPLINECURVE" ||
      type == "RATIONALBSPLINECURVEWITHKNOTS") {
    return spline(reader, *found);
  }
  if (type == "POLYLINE") {
    const auto ids = reader.references(*found, 0);
    if (!ids) return ids.error();
    const auto points = points_of(reader, *ids);
    if (!points) return points.error();
    if (points->size() < 2) return reader.error(*found, "a polyline of fewer than two points");
    return surfaces::polyline(*points);
  }
  if (type == "TRIMMEDCURVE") return trimmed(reader, *found, depth);
  if (type == "COMPOSITECURVE") return composite(reader, *found, depth);
  // Curves that lie on surfaces: the curve in space says where.
  if (type == "SURFACECURVE" || type == "SEAMCURVE" || type == "INTERSECTIONCURVE") {
    const auto inner = reader.reference(*found, 0);
    if (!inner) return inner.error();
    return read_curve(reader, *inner, depth + 1);
  }
  return unsupported(*found, "curves");
}

namespace {

Result<Frame> frame_at(const EntityReader& reader, const PlainEntity& from, std::size_t value) {
  const auto id = reader.reference(from, value);
  if (!id) return id.error();
  return reader.frame(*id);
}

Result<Surface> cone_surface(const EntityReader& reader, const PlainEntity& from, Frame frame,
                             double radians) {
  auto radius = reader.number(from, 1);
  if (!radius) return radius.error();
  const auto angle = reader.number(from, 2);
  if (!angle) return angle.error();
  const double opening = *angle * radians;
  if (!(std::abs(opening) > 0 && std::abs(opening) < kUpright) || *radius < 0) {
    return reader.error(from, "a cone with this angle or radius");
  }
  if (opening < 0) {  // narrower with z: the cone about the opposite axis
    frame.z = frame.z * -1;
    frame.y = frame.y * -1;
  }
  return surfaces::cone(frame, *radius, surfaces::tangent(std::abs(opening)));
}

/// The curve of a profile, or of a surface that has none.
Result<Curve> swept_curve(const EntityReader& reader, const PlainEntity& from) {
  const auto swept = reader.entity(from, 0);
  if (!swept) return swept.error();
  const bool is_profile =
      swept->type == "ARBITRARYCLOSEDPROFILEDEF" || swept->type == "ARBITRARYOPENPROFILEDEF";
  if (!is_profile) return read_curve(reader, swept->id);
  const auto curve = reader.reference(*swept, 2);
  if (!curve) return curve.error();
  return read_curve(reader, *curve);
}

/// IFC: profile, position or none, axis. STEP: curve, axis.
Result<Surface> revolution(const EntityReader& reader, const PlainEntity& from) {
  auto curve = swept_curve(reader, from);
  if (!curve) return curve.error();
  const bool has_position = from.values.size() > 2;
  const auto axis = frame_at(reader, from, has_position ? 2 : 1);
  if (!axis) return axis.error();
  const bool is_line = curve->pieces.size() == 1 && curve->pieces[0].degree() == 1;
  Surface surface = surfaces::revolved(*curve, *axis);
  surface.is_endless[1] = is_line;
  if (has_position && reader.has(from, 1)) {
    const auto position = frame_at(reader, from, 1);
    if (!position) return position.error();
    surfaces::move({{position->x, position->y, position->z}, position->origin}, surface);
  }
  return surface;
}

/// IFC: profile, position or none, direction, depth. STEP: curve, vector.
Result<Surface> extrusion(const EntityReader& reader, const PlainEntity& from) {
  auto curve = swept_curve(reader, from);
  if (!curve) return curve.error();
  const bool is_ifc = from.values.size() > 2;
  auto direction_id = reader.reference(from, is_ifc ? 2 : 1);
  if (!direction_id) return direction_id.error();
  if (!is_ifc) {
    const auto vector = reader.entity(*direction_id);
    if (!vector) return vector.error();
    direction_id = reader.reference(*vector, 0);
    if (!direction_id) return direction_id.error();
  }
  const auto direction = reader.triple(*direction_id);
  if (!direction) return direction.error();
  if (!(surfaces::length(*direction) > 0)) return reader.error(from, "no direction");
  Surface surface = surfaces::extruded(*curve, *direction);
  if (is_ifc && reader.has(from, 1)) {
    const auto position = frame_at(reader, from, 1);
    if (!position) return position.error();
    surfaces::move({{position->x, position->y, position->z}, position->origin}, surface);
  }
  return surface;
}

// degrees of u and v, points, form, closed along u and v, crossing, multiplicities along u and v,
// knots along u and v, form of knots, weights
Result<Surface> spline_surface(const EntityReader& reader, const PlainEntity& from) {
  const auto u = knots_of(reader, from, 0, 7, 9);
  if (!u) return u.error();
  const auto v = knots_of(reader, from, 1, 8, 10);
  if (!v) return v.error();
  const bool is_rational = from.type.starts_with("RATIONAL");
  const std::size_t list = is_rational ? 12 : 2;
  const auto is_list = [](const StepValue& value) { return value.kind == StepValue::Kind::list; };
  if (from.values.size() <= list || !is_list(from.values[2]) || !is_list(from.values[list])) {
    return reader.error(from, "its values do not fit the entity");
  }
  const std::vector<StepValue>& rows = from.values[2].items;  // along u, each along v
  const std::size_t columns = rows.size();
  std::vector<Vector3> points;
  std::vector<double> weights;
  for (std::size_t i = 0; i < columns; ++i) {
    if (!is_list(rows[i]) || rows[i].items.size() != rows[0].items.size()) {
      return reader.error(from, "its lists of control points differ in length");
    }
  }
  for (std::size_t k = 0; columns > 0 && k < rows[0].items.size(); ++k) {
    for (std::size_t i = 0; i < columns; ++i) {
      const StepValue& point = rows[i].items[k];
      if (point.kind != StepValue::Kind::reference) return reader.error(from, "a control point");
      const auto place = reader.triple(point.id);
      if (!place) return place.error();
      points.push_back(*place);
      if (!is_rational) continue;
      const std::vector<StepValue>& lists = from.values[list].items;
      if (i >= lists.size() || !is_list(lists[i]) || k >= lists[i].items.size()) {
        return reader.error(from, "fewer weights than control points");
      }
      weights.push_back(lists[i].items[k].number);
    }
  }
  if (!is_rational) weights.assign(points.size(), 1);
  if (u->values.size() != columns + u->degree + 1) {
    return reader.error(from, std::to_string(columns) + " control points along u with " +
                                  std::to_string(u->values.size()) + " knots");
  }
  auto surface = surfaces::surface_of(*u, *v, points, weights);
  if (!surface) return at_entity(reader, from, surface);
  return surface;
}

std::optional<Surface> some(Surface surface) { return surface; }

template <class Made>
Result<std::optional<Surface>> optional_of(Made made) {
  if (!made) return std::move(made).error();
  return some(*std::move(made));
}

}  // namespace

Result<std::optional<Surface>> read_surface(const EntityReader& reader, std::uint64_t id,
                                            double radians) {
  const auto found = reader.entity(id);
  if (!found) return found.error();
  const std::string& type = found->type;
  if (type == "PLANE") return std::optional<Surface>();
  if (type.ends_with("BSPLINESURFACEWITHKNOTS") || type == "RATIONALBSPLINESURFACE") {
    return optional_of(spline_surface(reader, *found));
  }
  if (type == "SURFACEOFREVOLUTION") return optional_of(revolution(reader, *found));
  if (type == "SURFACEOFLINEAREXTRUSION") return optional_of(extrusion(reader, *found));
  const bool is_torus = type == "TOROIDALSURFACE" || type == "DEGENERATETOROIDALSURFACE";
  if (!is_torus && type != "CYLINDRICALSURFACE" && type != "CONICALSURFACE" &&
      type != "SPHERICALSURFACE") {
    return unsupported(*found, "surfaces");
  }
  const auto frame = frame_at(reader, *found, 0);
  if (!frame) return frame.error();
  if (type == "CONICALSURFACE") return optional_of(cone_surface(reader, *found, *frame, radians));
  const auto radius = positive(reader, *found, 1);
  if (!radius) return radius.error();
  if (type == "CYLINDRICALSURFACE") return some(surfaces::cylinder(*frame, *radius));
  if (type == "SPHERICALSURFACE") return some(surfaces::sphere(*frame, *radius));
  const auto minor = positive(reader, *found, 2);
  if (!minor) return minor.error();
  return some(surfaces::torus(*frame, *radius, *minor));
}

}  // namespace watertight::formats
