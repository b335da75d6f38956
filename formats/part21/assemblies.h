// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where STEP files put the parts of assemblies. A part is a representation (a list of solids with
// the units of its context); a relationship with a transformation makes it part of another one, and
// so does a mapped item. Source: ISO 10303-43 (relationships of representations), 10303-41
// (products and their definitions), 10303-44 (usages in assemblies). Internal to formats/part21/.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "formats/part21/boundary_reader.h"
#include "surfaces/curves/pieces.h"

namespace watertight::formats {

/// A place of a representation in the whole.
struct PartPlace {
  surfaces::Affine to_whole;          // metres of the representation to metres of the whole
  std::vector<std::uint64_t> usages;  // the instances that put it there, the innermost first
};

class Assemblies {
 public:
  /// The metres of a unit of length of a representation.
  using MetreOf = std::function<Result<double>(std::uint64_t representation)>;

  /// Reads all relationships of a file. A placement that cannot be read leaves its part where it
  /// was drawn, and is named in notes(). Errors: those of reading an instance and of `metre_of`.
  /// Cost: linear but for searching by number.
  static Result<Assemblies> read(const EntityReader& reader, const MetreOf& metre_of);

  /// The places of a representation; that of one that is no part of another leaves it where it was
  /// drawn. Adds their number to `count`. Errors: malformed for assemblies that contain themselves;
  /// limit_exceeded if `count` exceeds `most`.
  Result<std::vector<PartPlace>> places_of(std::uint64_t representation, std::uint64_t& count,
                                           std::uint64_t most) const;

  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Usage {
    std::uint64_t whole = 0;  // a representation
    surfaces::Affine to_whole;
    std::uint64_t instance = 0;
  };
  struct Relationship {
    std::uint64_t instance = 0;
    std::uint64_t first = 0;
    std::uint64_t second = 0;
    std::uint64_t transformation = 0;  // 0 if both representations have one place
  };
  struct Products {
    std::map<std::uint64_t, std::uint64_t> usage_of;       // relationship -> shape of a usage
    std::map<std::uint64_t, std::uint64_t> definition_of;  // shape -> product or usage
    std::map<std::uint64_t, std::uint64_t> whole_of;       // usage -> product that contains it
    std::map<std::uint64_t, std::vector<std::uint64_t>> representations_of;  // of a product
  };

  Status read_relationships(const EntityReader& reader, std::vector<Relationship>& all,
                            Products& products);
  void join_places(std::span<const StepPlace> places,
                   const std::vector<Relationship>& relationships);
  Status read_mapped_items(const EntityReader& reader, const MetreOf& metre_of);
  Status add_usage(const EntityReader& reader, const MetreOf& metre_of, Relationship relationship,
                   const Products& products);
  bool is_reversed(const Relationship& relationship, const Products& products) const;
  std::uint64_t joint(std::uint64_t representation) const;
  Status add_places(std::uint64_t representation, const PartPlace& inner, std::uint64_t& count,
                    std::uint64_t most, std::vector<PartPlace>& places) const;

  std::map<std::uint64_t, std::uint64_t> same_place_as_;  // representation -> one with its place
  std::map<std::uint64_t, std::vector<Usage>> usages_;    // joint() of a part -> where it is used
  std::vector<std::string> notes_;
};

}  // namespace watertight::formats
