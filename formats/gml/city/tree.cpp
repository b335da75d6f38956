// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/city/tree.h"

#include <utility>

#include "formats/gml/elements.h"

namespace watertight::formats {
namespace {

// Expat writes a qualified name as the namespace, a line feed and the local name.
std::pair<std::string_view, std::string_view> split_name(std::string_view name) {
  const std::size_t at = name.find('\n');
  if (at == std::string_view::npos) return {{}, name};
  return {name.substr(0, at), name.substr(at + 1)};
}

}  // namespace

bool is_object_name(std::string_view name) {
  return !name.empty() && name.front() >= 'A' && name.front() <= 'Z';
}

class TreeBuilder : public XmlHandler {
 public:
  Status start(const XmlElement& element) override {
    if (tree_.elements_.size() >= kNone - 2 || tree_.attributes_.size() >= kNone - 1'000'000) {
      return error_at(element.place, ErrorCode::limit_exceeded, "too many elements");
    }
    const auto number = static_cast<Index>(tree_.elements_.size());
    TreeElement own;
    own.space = tree_.intern(element.space);
    own.name = tree_.intern(element.name);
    own.place = element.place;
    own.first_attribute = static_cast<Index>(tree_.attributes_.size());
    for (const char** next = element.attributes; next != nullptr && *next != nullptr; next += 2) {
      const auto [space, name] = split_name(next[0]);
      tree_.attributes_.push_back({tree_.intern(space), tree_.intern(name), keep(next[1])});
    }
    own.attribute_count = static_cast<Index>(tree_.attributes_.size()) - own.first_attribute;
    if (!open_.empty()) link(number, own);
    tree_.elements_.push_back(own);
    open_.push_back(number);
    if (texts_.size() < open_.size()) texts_.emplace_back();
    texts_[open_.size() - 1].clear();
    return Done{};
  }

  Status text(std::string_view text) override {
    if (!open_.empty()) texts_[open_.size() - 1].append(text);
    return Done{};
  }

  Status end() override {
    tree_.elements_[open_.back()].text = keep(without_blanks(texts_[open_.size() - 1]));
    open_.pop_back();
    return Done{};
  }

  GmlTree take() { return std::move(tree_); }

 private:
  void link(Index number, TreeElement& own) {
    own.parent = open_.back();
    TreeElement& parent = tree_.elements_[own.parent];
    if (parent.first_child == kNone) {
      parent.first_child = number;
    } else {
      tree_.elements_[parent.last_child].next = number;
    }
    parent.last_child = number;
  }

  TextSpan keep(std::string_view text) {
    const TextSpan span{tree_.texts_.size(), text.size()};
    tree_.texts_.append(text);
    return span;
  }

  GmlTree tree_;
  std::vector<Index> open_;
  std::vector<std::string> texts_;  // the character data of the open elements
};

Result<GmlTree> GmlTree::read(ByteView bytes, const Limits& limits) {
  TreeBuilder builder;
  if (auto status = read_xml(bytes, builder, limits); !status) return std::move(status).error();
  return builder.take();
}

Index GmlTree::intern(std::string_view name) {
  const auto found = numbers_.find(name);
  if (found != numbers_.end()) return found->second;
  const auto number = static_cast<Index>(names_.size());
  names_.emplace_back(name);
  numbers_.emplace(names_.back(), number);
  return number;
}

bool GmlTree::is_gml(Index element) const { return is_gml_space(space(element)); }

bool GmlTree::is_gml(Index element, std::string_view local) const {
  return name(element) == local && is_gml(element);
}

std::string_view GmlTree::text(Index element) const {
  const TextSpan span = elements_[element].text;
  return std::string_view(texts_).substr(span.at, span.size);
}

std::string_view GmlTree::attribute_value(Index attribute) const {
  const TextSpan span = attributes_[attribute].value;
  return std::string_view(texts_).substr(span.at, span.size);
}

Index GmlTree::find_attribute(Index element, std::string_view space, std::string_view local) const {
  const TreeElement& own = elements_[element];
  for (Index i = own.first_attribute; i < own.first_attribute + own.attribute_count; ++i) {
    if (attribute_name(i) == local && attribute_space(i) == space) return i;
  }
  return kNone;
}

std::string_view GmlTree::attribute(Index element, std::string_view space,
                                    std::string_view local) const {
  const Index found = find_attribute(element, space, local);
  return found == kNone ? std::string_view() : without_blanks(attribute_value(found));
}

Index GmlTree::id_attribute(Index element) const {
  const TreeElement& own = elements_[element];
  for (Index i = own.first_attribute; i < own.first_attribute + own.attribute_count; ++i) {
    if (attribute_name(i) == "id" && is_gml_space(attribute_space(i))) return i;
  }
  return kNone;
}

std::string_view GmlTree::id(Index element) const {
  const Index found = id_attribute(element);
  return found == kNone ? std::string_view() : attribute_value(found);
}

Index GmlTree::href_attribute(Index element) const {
  return find_attribute(element, kXlinkSpace, "href");
}

std::string_view GmlTree::href(Index element) const {
  return attribute(element, kXlinkSpace, "href");
}

Index GmlTree::child(Index element, std::string_view local) const {
  for (Index i = elements_[element].first_child; i != kNone; i = elements_[i].next) {
    if (name(i) == local) return i;
  }
  return kNone;
}

std::vector<Index> GmlTree::children(Index element) const {
  std::vector<Index> found;
  for (Index i = elements_[element].first_child; i != kNone; i = elements_[i].next) {
    found.push_back(i);
  }
  return found;
}

TreeMarks::TreeMarks(const GmlTree& tree)
    : elements_(tree.elements().size(), false),
      texts_(tree.elements().size(), false),
      is_lost_(tree.elements().size(), false) {
  const auto& elements = tree.elements();
  const std::size_t attributes =
      elements.empty() ? 0 : elements.back().first_attribute + elements.back().attribute_count;
  attributes_.assign(attributes, false);
}

}  // namespace watertight::formats
