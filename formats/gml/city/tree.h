// SPDX-License-Identifier: GPL-3.0-or-later
//
// A GML document as a tree of elements in document order, with a mark on every element and
// attribute whose content reached the CityJSON. What stays without a mark is listed
// (formats/gml/city/losses.h). Internal to formats/.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "base/result.h"
#include "formats/gml/model.h"
#include "formats/gml/xml.h"
#include "geometry/point.h"

namespace watertight::formats {

/// An attribute of an element: indices of GmlTree::names(), and a part of the tree's texts.
struct TreeAttribute {
  Index space = kNone;
  Index name = kNone;
  TextSpan value;
};

/// An element. Its number is its position in the document, so parents come before children.
struct TreeElement {
  Index space = kNone;
  Index name = kNone;
  Index parent = kNone;
  Index first_child = kNone;
  Index last_child = kNone;
  Index next = kNone;  // the next child of the same parent
  Index first_attribute = 0;
  Index attribute_count = 0;
  TextSpan text;  // the character data of the element itself, in one piece
  XmlPlace place;
};

/// The elements of a document. Views stay valid as long as the tree.
class GmlTree {
 public:
  /// Reads a document. Errors: those of read_xml(); limit_exceeded for more elements than an Index
  /// can number. Cost: linear (n log n in the number of different names); memory proportional to
  /// the document.
  static Result<GmlTree> read(ByteView bytes, const Limits& limits);

  const std::vector<TreeElement>& elements() const { return elements_; }
  const TreeElement& operator[](Index element) const { return elements_[element]; }

  std::string_view name(Index element) const { return names_[elements_[element].name]; }
  std::string_view space(Index element) const { return names_[elements_[element].space]; }
  /// True for an element in a namespace of GML.
  bool is_gml(Index element) const;
  /// True for a GML element of this local name.
  bool is_gml(Index element, std::string_view local) const;

  /// The character data without blanks at both ends.
  std::string_view text(Index element) const;

  std::string_view attribute_name(Index attribute) const {
    return names_[attributes_[attribute].name];
  }
  std::string_view attribute_space(Index attribute) const {
    return names_[attributes_[attribute].space];
  }
  std::string_view attribute_value(Index attribute) const;
  /// The number of an attribute of this element, kNone without one.
  Index find_attribute(Index element, std::string_view space, std::string_view local) const;
  /// The trimmed value of an attribute, "" without one.
  std::string_view attribute(Index element, std::string_view space, std::string_view local) const;

  /// The gml:id, "" without one.
  std::string_view id(Index element) const;
  /// The number of the attribute gml:id, kNone without one.
  Index id_attribute(Index element) const;
  /// The xlink:href, "" without one.
  std::string_view href(Index element) const;
  Index href_attribute(Index element) const;

  /// The first child with this local name, kNone without one. Cost: linear in the children.
  Index child(Index element, std::string_view local) const;
  /// The child elements in order.
  std::vector<Index> children(Index element) const;

 private:
  friend class TreeBuilder;
  Index intern(std::string_view name);

  std::vector<TreeElement> elements_;
  std::vector<TreeAttribute> attributes_;
  std::vector<std::string> names_;
  std::map<std::string, Index, std::less<>> numbers_;  // of the names
  std::string texts_;
};

/// Which elements and attributes of a tree reached the CityJSON.
class TreeMarks {
 public:
  explicit TreeMarks(const GmlTree& tree);

  void mark(Index element) { elements_[element] = true; }
  void mark_attribute(Index attribute) {
    if (attribute != kNone) attributes_[attribute] = true;
  }
  /// Says that what an element means did not reach the CityJSON, even if parts of it did through
  /// references.
  void lose(Index element) { is_lost_[element] = true; }
  bool is_lost(Index element) const { return is_lost_[element]; }

  /// Marks the text of an element that has children or a reference. The text of others goes with
  /// the element.
  void mark_text(Index element) { texts_[element] = true; }
  bool is_text_marked(Index element) const { return texts_[element]; }

  bool is_marked(Index element) const { return elements_[element]; }
  bool is_attribute_marked(Index attribute) const { return attributes_[attribute]; }

 private:
  std::vector<bool> elements_;
  std::vector<bool> attributes_;
  std::vector<bool> texts_;
  std::vector<bool> is_lost_;
};

/// True for a name that begins with a capital letter: objects and values, not properties.
bool is_object_name(std::string_view name);

}  // namespace watertight::formats
