// SPDX-License-Identifier: GPL-3.0-or-later
//
// Instances of geometry templates in CityJSON documents, under random matrices. All numbers are
// decimals, so the place of each vertex is exact.
#include "bench/verdict/families.h"

namespace watertight::verdict {
namespace {

/// Integers times a power of ten.
struct DecimalMatrix {
  AffineMap map;  // the shift is not used
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

/// A rotation about an axis by an angle of a Pythagorean triple, to be divided by the third number.
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

/// Rotations, mirror images, and `exponent` as scale: a similarity.
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

/// Makes the matrix singular: a column is nothing, or a row is a multiple of another.
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

std::string text_of(const DecimalMatrix& matrix) {
  std::string text = "[";
  for (const auto& row : matrix.map.matrix) {
    for (const std::int64_t entry : row) text += number(entry, matrix.exponent) + ", ";
    text += "0, ";
  }
  return text + "0, 0, 0, 1]";
}

struct Template {
  std::string boundaries;
  std::string vertices;
};

Template template_of(const Shape& shape, int exponent) {
  const Solid solid = solids::solid_of(shape);
  Template result;
  for (const Point& p : solid.vertices()) {
    result.vertices += result.vertices.empty() ? "[" : ", [";
    for (int axis = 0; axis < 3; ++axis) {
      if (axis != 0) result.vertices += ", ";
      result.vertices += number(static_cast<std::int64_t>(p[axis]), exponent);
    }
    result.vertices += "]";
  }
  result.boundaries = boundaries_text(solid);
  return result;
}

struct Instance {
  DecimalMatrix matrix;
  std::array<std::int64_t, 3> place{};
};

std::string document_of(const Template& form, const std::vector<Instance>& instances) {
  std::string objects;
  std::string vertices;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const std::string index = std::to_string(i);
    objects += (i == 0 ? "\"i" : ", \"i") + index +
               "\": {\"type\": \"CityFurniture\", \"geometry\": [{\"type\": \"GeometryInstance\", "
               "\"template\": 0, \"boundaries\": [" +
               index + "], \"transformationMatrix\": " + text_of(instances[i].matrix) + "}]}";
    const auto& [x, y, z] = instances[i].place;
    vertices += (i == 0 ? "[" : ", [") + std::to_string(x) + ", " + std::to_string(y) + ", " +
                std::to_string(z) + "]";
  }
  return "{\"type\": \"CityJSON\", \"version\": \"2.0\", \"transform\": {\"scale\": [0.001, 0.001, "
         "0.001], \"translate\": [0, 0, 0]}, \"CityObjects\": {" +
         objects + "}, \"vertices\": [" + vertices +
         "], \"geometry-templates\": {\"templates\": [{\"type\": \"Solid\", \"lod\": \"2\", "
         "\"boundaries\": " +
         form.boundaries + "}], \"vertices-templates\": [" + form.vertices + "]}}";
}

/// A cube of 10 m in place, with a corner raised by 0.016 m or 0.12 m: a quarter of it is the
/// distance from the best plane, so it is within 0.01 m or beyond.
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

}  // namespace

std::string boundaries_text(const Solid& solid) {
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
          text += std::to_string(vertex);
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
  // In place a unit of the form is a millimetre.
  const Template form =
      template_of(is_folded ? folded_cube(is_folded_far) : planar_form(random), -3 - scale);
  Sample sample;
  Truth truth;
  std::vector<Instance> instances;
  for (std::uint64_t k = 1 + random.below(2); k > 0; --k) {
    Instance instance;
    instance.matrix = similarity(random, scale);
    if (!is_folded && one_in(random, 2)) shear(instance.matrix, random);
    if (one_in(random, 6)) flatten(instance.matrix, random);
    for (std::int64_t& coordinate : instance.place) {
      coordinate = random.between(-1'000'000, 1'000'000);
    }
    const std::int64_t sign = sign_of_determinant(instance.matrix);
    if (sign == 0) truth.codes.insert(kAnyCode);
    if (sign < 0) truth.codes.insert(405);
    if (sign != 0 && is_folded && is_folded_far) truth.codes.insert(203);
    instances.push_back(instance);
  }
  sample.document = document_of(form, instances);
  sample.truth = truth;
  return sample;
}

}  // namespace watertight::verdict
