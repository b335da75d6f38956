// SPDX-License-Identifier: GPL-3.0-or-later
//
// Addresses of the extensible Address Language (xAL) 2 and 3 as members of a CityJSON address.
#include <array>
#include <utility>

#include "formats/gml/city/objects.h"

namespace watertight::formats {
namespace {

struct Member {
  std::string_view parent;  // "" for any
  std::string_view element;
  std::string_view name;
};
constexpr std::array kMembers{
    Member{"", "CountryName", "Country"},
    Member{"", "LocalityName", "Locality"},
    Member{"", "PostalCodeNumber", "Postcode"},
    Member{"Country", "NameElement", "Country"},
    Member{"Locality", "NameElement", "Locality"},
    Member{"Thoroughfare", "NameElement", "ThoroughfareName"},
    Member{"Thoroughfare", "Number", "ThoroughfareNumber"},
    Member{"PostCode", "Identifier", "Postcode"},
};

std::string member_name(std::string_view parent, std::string_view element) {
  for (const Member& member : kMembers) {
    if (member.element == element && (member.parent.empty() || member.parent == parent)) {
      return std::string(member.name);
    }
  }
  if (element != "NameElement" && element != "Number" && element != "Identifier") {
    return std::string(element);
  }
  std::string name(parent);
  return name.append(element);
}

// The members in order, with all the texts of each.
class Members {
 public:
  void add(std::string name, std::string text) {
    const auto [place, is_new] = numbers_.emplace(std::move(name), texts_.size());
    if (is_new) {
      names_.push_back(place->first);
      texts_.emplace_back();
    }
    texts_[place->second].push_back(std::move(text));
  }

  Json take() {
    ObjectBuilder object;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      Json values = Json::array();
      for (std::string& text : texts_[i]) values.push_back(std::move(text));
      object.add(names_[i], texts_[i].size() == 1 ? std::move(values[0]) : std::move(values), "_");
    }
    return object.take();
  }

 private:
  std::map<std::string, std::size_t> numbers_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> texts_;
};

}  // namespace

Json address_members(const GmlTree& tree, TreeMarks& marks, Index address) {
  Members members;
  // The elements below follow in document order, up to the first that is not below.
  for (Index i = address; i < tree.elements().size(); ++i) {
    if (i != address && tree[i].parent < address) break;
    const std::string_view name = tree.name(i);
    if (name == "multiPoint") {
      const Index next = tree[i].next;
      if (next == kNone) break;
      i = next - 1;
      continue;
    }
    marks.mark(i);
    marks.mark_text(i);
    const std::string_view parent = i == address ? "" : tree.name(tree[i].parent);
    const std::string member = i == address ? "" : member_name(parent, name);
    const bool is_leaf = tree[i].first_child == kNone;
    if (i != address && is_leaf && !tree.text(i).empty()) {
      members.add(member, std::string(tree.text(i)));
    } else if (!tree.text(i).empty()) {
      members.add(std::string(name).append("_text"), std::string(tree.text(i)));
    }
    const Index end = tree[i].first_attribute + tree[i].attribute_count;
    for (Index k = tree[i].first_attribute; k < end; ++k) {
      marks.mark_attribute(k);
      std::string key = i == address ? "" : std::string(is_leaf ? member : name) + "_";
      key.append(tree.attribute_name(k));
      members.add(std::move(key), std::string(tree.attribute_value(k)));
    }
  }
  return members.take();
}

}  // namespace watertight::formats
