// SPDX-License-Identifier: GPL-3.0-or-later
//
// Instances of geometry templates in CityJSON documents, under random matrices. All numbers are
// decimals, so the position of each vertex is exact.
#include "bench/verdict/families.h"

namespace watertight::verdict {
namespace {

/// A matrix of integers times a power of ten.
struct DecimalMatrix {
  AffineMap map;  // the shift of the map is not used
  int exponent = 0;
};

AffineMap product(const AffineMap& a, const AffineMap& b) {
  AffineMap result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result.matrix[i][j] = 0;
      for (std::size_t k = 0; k < 3; ++k) result.matrix[i][j] += a.matrix[i][k] * b.matrix[k][j];
    }
  }
  return result;
}

/// A rotation about an axis by an angle of a Pythagorean triple; its entries must be divided by the
/// third number.
AffineMap rotation(std::size_t axis, std::int64_t cosine, std::int64_t sine, std::int64_t radius) {
  AffineMap map;
  map.matrix = {};
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  map.matrix[axis][axis] = radius;
  map.matrix[u][u] = cosine;
  map.matrix[u][v] = -sine;
  map.matrix[v][u] = sine;
  map.matrix[v][v] = cosine;
  return map;
}

/// A random similarity: rotations and mirror images, with the scale 10^exponent.
DecimalMatrix similarity(Random& random, int exponent) {
  DecimalMatrix matrix;
  matrix.exponent = exponent;
  for (std::uint64_t k = random.below(3); k > 0; --k) {
    const std::int64_t sign = one_in(random, 2) ? 1 : -1;
    if (one_in(random, 2)) {
      matrix.map = product(matrix.map, rotation(random.below(3), 8, 6 * sign, 10));
      matrix.exponent -= 1;
    } else {
      matrix.map = product(matrix.map, rotation(random.below(3), 28, 96 * sign, 100));
      matrix.exponent -= 2;
    }
  }
  if (one_in(random, 3)) {
    for (std::int64_t& entry : matrix.map.matrix[random.below(3)]) entry = -entry;
  }
  return matrix;
}

void shear(DecimalMatrix& matrix, Random& random) {
  AffineMap map;
  const std::size_t row = random.below(3);
  map.matrix[row][(row + 1) % 3] = random.between(-3, 3);
  matrix.map = product(matrix.map, map);
}

/// Makes the matrix singular: a column becomes 0, or a row a multiple of another.
void flatten(DecimalMatrix& matrix, Random& random) {
  auto& m = matrix.map.matrix;
  const std::size_t i = random.below(3);
  const bool is_column = one_in(random, 2);
  const std::int64_t factor = random.between(-2, 2);
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_column) {
      m[k][i] = 0;
    } else {
      m[i][k] = factor * m[(i + 1) % 3][k];
    }
  }
}

std::string number(std::int64_t mantissa, int exponent) {
  std::string text = std::to_string(mantissa);
  if (exponent != 0) text.append("e").append(std::to_string(exponent));
  return text;
}

std::string text_of(const DecimalMatrix& matrix, const std::array<std::int64_t, 3>& offset) {
  std::string text = "[";
  for (std::size_t row = 0; row < 3; ++row) {
    for (const std::int64_t entry : matrix.map.matrix[row]) {
      text += number(entry, matrix.exponent) + ", ";
    }
    text += number(offset[row], matrix.exponent) + ", ";
  }
  return text + "0, 0, 0, 1]";
}

struct Template {
  std::string type = "Solid";
  std::string boundaries;
};

/// A document of templates, and of objects that have instances of them or solids of their own.
class Document {
 public:
  /// Adds a template. The vertices of the shapes are multiplied by 10^exponent. Several shapes
  /// become a composite solid.
  void add_template(const std::vector<Shape>& members, int exponent) {
    Template form;
    for (const Shape& member : members) {
      if (!form.boundaries.empty()) form.boundaries += ", ";
      form.boundaries += boundaries_on(solids::solid_of(member), template_vertices_, exponent);
    }
    if (members.size() > 1) {
      form.type = "CompositeSolid";
      form.boundaries.insert(0, "[").append("]");
    }
    templates_.push_back(std::move(form));
  }

  /// The text of a solid in millimetres.
  std::string solid(const Shape& shape) {
    return R"({"type": "Solid", "lod": "2", "boundaries": )" +
           boundaries_on(solids::solid_of(shape), vertices_, 0) + "}";
  }

  /// The text of an instance. `offset` is multiplied by the matrix's power of ten; `place` is in
  /// millimetres.
  std::string instance(std::size_t number_of_template, const DecimalMatrix& matrix,
                       const std::array<std::int64_t, 3>& offset,
                       const std::array<std::int64_t, 3>& place) {
    std::string vertex("[");
    vertex.append(std::to_string(place[0])).append(", ");
    vertex.append(std::to_string(place[1])).append(", ");
    vertices_.push_back(vertex.append(std::to_string(place[2])).append("]"));
    return R"({"type": "GeometryInstance", "template": )" + std::to_string(number_of_template) +
           R"(, "boundaries": [)" + std::to_string(vertices_.size() - 1) +
           R"(], "transformationMatrix": )" + text_of(matrix, offset) + "}";
  }

  /// Adds an object. `family` is the JSON member with its parents or children, if any.
  void add_object(const std::string& id, const std::string& type, const std::string& geometry,
                  const std::string& family = "") {
    std::string object("\"");
    object.append(id).append(R"(": {"type": ")").append(type).append("\", ").append(family);
    objects_.push_back(object.append(R"("geometry": [)").append(geometry).append("]}"));
  }

  std::string text() const {
    std::vector<std::string> templates;
    for (const Template& form : templates_) {
      templates.push_back(R"({"type": ")" + form.type + R"(", "lod": "2", "boundaries": )" +
                          form.boundaries + "}");
    }
    return R"({"type": "CityJSON", "version": "2.0", "transform": {"scale": [0.001, 0.001, )"
           R"(0.001], "translate": [0, 0, 0]}, "CityObjects": {)" +
           joined(objects_) + R"(}, "vertices": [)" + joined(vertices_) +
           R"(], "geometry-templates": {"templates": [)" + joined(templates) +
           R"(], "vertices-templates": [)" + joined(template_vertices_) + "]}}";
  }

 private:
  static std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) {
      if (!text.empty()) text += ", ";
      text += part;
    }
    return text;
  }

  static std::string boundaries_on(const Solid& solid, std::vector<std::string>& vertices,
                                   int exponent) {
    const std::size_t first = vertices.size();
    for (const Point& p : solid.vertices()) {
      std::string text;
      for (int axis = 0; axis < 3; ++axis) {
        text += axis == 0 ? "[" : ", ";
        text += number(static_cast<std::int64_t>(p[axis]), exponent);
      }
      vertices.push_back(text + "]");
    }
    return boundaries_text(solid, static_cast<Index>(first));
  }

  std::vector<Template> templates_;
  std::vector<std::string> template_vertices_;
  std::vector<std::string> vertices_;
  std::vector<std::string> objects_;
};

/// A cube of 10 m where the instance stands, with a corner raised by 0.016 m or 0.12 m. A quarter
/// of that is the distance from the best plane, which is within 0.01 m or beyond it.
Shape folded_cube(bool is_folded_far) {
  Shell box = solids::box({0, 0, 0}, {10'000, 10'000, 10'000});
  for (Facet& facet : box) {
    for (Point& p : facet[0]) {
      if (p == Point{10'000, 10'000, 10'000}) p.z += is_folded_far ? 120 : 16;
    }
  }
  return {box};
}

Shape planar_form(Random& random) {
  switch (random.below(4)) {
    case 0:
      return {solids::gable_house(10'000, 8'000, 3'000, 5'000)};
    case 1:
      return {solids::box({0, 0, 0}, {24, 24, 24}), as_cavity(touching_tetrahedron(random, 24))};
    case 2:
      return {solids::pierced_box(1)};
    default:
      return {solids::box({-500, 0, 0}, {500, 7'000, 2'000})};
  }
}

std::int64_t sign_of_determinant(const DecimalMatrix& matrix) {
  const std::int64_t determinant = matrix.map.determinant();
  return determinant > 0 ? 1 : determinant < 0 ? -1 : 0;
}

/// A random box on a small grid, so that two boxes often touch, or an L-shaped block.
Shape small_form(Random& random, double unit) {
  const auto at = [&](std::int64_t least) {
    return static_cast<double>(random.between(least, least + 2)) * unit;
  };
  const Point low{at(0), at(0), at(0)};
  const Point high{at(3), at(3), at(3)};
  if (one_in(random, 3)) {
    return {solids::gable_house(high.x, high.y, low.z + unit, low.z + 2 * unit)};
  }
  return {solids::box(low, high)};
}

/// The shape under matrix.map, divided by `divisor`, which leaves no remainder, and shifted.
Shape mapped(const Shape& shape, const DecimalMatrix& matrix, const Point& shift, double divisor) {
  Shape result = shape;
  for (Shell& shell : result) {
    for (Facet& facet : shell) {
      for (Ring& ring : facet) {
        for (Point& p : ring) {
          const Point from = p;
          for (std::size_t row = 0; row < 3; ++row) {
            double sum = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
              sum +=
                  static_cast<double>(matrix.map.matrix[row][axis]) * from[static_cast<int>(axis)];
            }
            p[static_cast<int>(row)] = sum / divisor + shift[static_cast<int>(row)];
          }
        }
      }
    }
  }
  return result;
}

/// Adds a composite solid of two members.
void add_composite(const Shape& first, const Shape& second, const DecimalMatrix& matrix,
                   Random& random, Document& document) {
  document.add_template({first, second}, -3);
  for (std::uint64_t k = 0; k <= random.below(2); ++k) {
    document.add_object(std::to_string(k), "CityFurniture",
                        document.instance(0, matrix, {}, {random.between(-9, 9), 0, 5}));
  }
}

/// Adds a building with a part: a solid in place and an instance, or two instances whose matrices
/// differ in their shifts.
void add_building(const Shape& first, const Shape& second, const DecimalMatrix& matrix,
                  Random& random, Document& document) {
  const std::array<std::int64_t, 3> place{random.between(-1'000'000, 1'000'000),
                                          random.between(-1'000'000, 1'000'000),
                                          random.between(-1'000, 1'000)};
  const Point shift{static_cast<double>(place[0]), static_cast<double>(place[1]),
                    static_cast<double>(place[2])};
  double divisor = 1;
  for (int k = matrix.exponent; k < 0; ++k) divisor *= 10;
  document.add_template({second}, -3);
  std::string own;
  if (one_in(random, 2)) {
    own = document.solid(mapped(first, matrix, shift, divisor));
  } else {  // the solid is moved in the template by -t, and in the world by the matrix times t
    const Point t{static_cast<double>(random.between(-5, 5)),
                  static_cast<double>(random.between(-5, 5)), 3};
    Shape moved = first;
    for (Facet& facet : moved[0]) {
      for (Ring& ring : facet) {
        for (Point& p : ring) p = plus(p, times(t, -1000));
      }
    }
    std::array<std::int64_t, 3> offset{};
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        offset[row] +=
            matrix.map.matrix[row][axis] * static_cast<std::int64_t>(t[static_cast<int>(axis)]);
      }
    }
    document.add_template({moved}, -3);
    own = document.instance(1, matrix, offset, place);
  }
  document.add_object("b", "Building", own, R"("children": ["p"], )");
  document.add_object("p", "BuildingPart", document.instance(0, matrix, {}, place),
                      R"("parents": ["b"], )");
}

}  // namespace

std::string boundaries_text(const Solid& solid, Index first_vertex) {
  std::string text = "[";
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    text += shell == 0 ? "[" : ", [";
    for (Index f = solid.facets_of(shell).begin; f < solid.facets_of(shell).end; ++f) {
      text += f == solid.facets_of(shell).begin ? "[" : ", [";
      for (Index r = solid.rings_of(f).begin; r < solid.rings_of(f).end; ++r) {
        text += r == solid.rings_of(f).begin ? "[" : ", [";
        bool is_first = true;
        for (const Index vertex : solid.ring(r)) {
          if (!is_first) text += ", ";
          text += std::to_string(first_vertex + vertex);
          is_first = false;
        }
        text += "]";
      }
      text += "]";
    }
    text += "]";
  }
  return text + "]";
}

Sample make_instance(Random& random) {
  const bool is_folded = one_in(random, 2);
  const bool is_folded_far = one_in(random, 2);
  const int scale = static_cast<int>(random.between(-3, 3));
  // In the world, a unit of the template is a millimetre.
  Document document;
  document.add_template({is_folded ? folded_cube(is_folded_far) : planar_form(random)}, -3 - scale);
  Sample sample;
  Truth truth;
  for (std::uint64_t k = 1 + random.below(2); k > 0; --k) {
    DecimalMatrix matrix = similarity(random, scale);
    if (!is_folded && one_in(random, 2)) shear(matrix, random);
    if (one_in(random, 6)) flatten(matrix, random);
    std::array<std::int64_t, 3> place{};
    for (std::int64_t& coordinate : place) coordinate = random.between(-1'000'000, 1'000'000);
    const std::int64_t sign = sign_of_determinant(matrix);
    if (sign == 0) truth.codes.insert(kAnyCode);
    if (sign < 0) truth.codes.insert(405);
    if (sign != 0 && is_folded && is_folded_far) truth.codes.insert(203);
    document.add_object(std::to_string(k), "CityFurniture",
                        document.instance(0, matrix, {}, place));
  }
  sample.document = document.text();
  sample.truth = truth;
  return sample;
}

/// An affine map with an inverse keeps the relation of two solids.
Sample make_placed_group(Random& random) {
  const Shape first = small_form(random, 10'000);
  Shape second = one_in(random, 8) ? first : small_form(random, 10'000);
  const Point shift{static_cast<double>(random.between(-3, 3)) * 10'000,
                    static_cast<double>(random.between(-3, 3)) * 10'000, 0};
  if (one_in(random, 2)) {
    for (Facet& facet : second[0]) {
      for (Ring& ring : facet) {
        for (Point& p : ring) p = plus(p, shift);
      }
    }
  }
  const PairTruth pair = pair_truth_of(solids::solid_of(first), solids::solid_of(second));
  DecimalMatrix matrix = similarity(random, 0);
  if (one_in(random, 2)) shear(matrix, random);
  const bool is_mirrored = sign_of_determinant(matrix) < 0;
  const auto turned = [&](const Shape& shape) {
    return is_mirrored ? Shape{solids::inside_out(shape[0])} : shape;
  };
  Truth truth;
  Document document;
  if (one_in(random, 2)) {
    add_composite(turned(first), turned(second), matrix, random, document);
    if (pair.are_equal) {
      truth.codes = {502};
    } else if (pair.overlap) {
      truth.codes = {501};
    } else if (!pair.share_area) {
      truth.codes = {503};
    }
  } else {
    add_building(turned(first), turned(second), matrix, random, document);
    if (pair.overlap) truth.codes = {601};
  }
  Sample sample;
  sample.document = document.text();
  sample.truth = truth;
  return sample;
}

}  // namespace watertight::verdict
