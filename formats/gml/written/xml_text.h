// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes XML 1.0, a line for each element. Internal to formats/.
#pragma once

#include <initializer_list>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace watertight::formats {

/// An attribute: its name and its value, which need not be escaped. One without a value is left
/// out.
using XmlAttribute = std::pair<std::string_view, std::string_view>;

class XmlText {
 public:
  void open(std::string_view name, std::span<const XmlAttribute> attributes);
  void open(std::string_view name, std::initializer_list<XmlAttribute> attributes = {}) {
    open(name, std::span(attributes.begin(), attributes.size()));
  }
  void close();
  /// An element with text; without content if the text is empty.
  void leaf(std::string_view name, std::string_view text,
            std::initializer_list<XmlAttribute> attributes = {});
  void comment(std::string_view text);

  /// The text so far. Characters that XML cannot have stand there as U+FFFD.
  std::string take() && { return std::move(text_); }

 private:
  void start(std::string_view name, std::span<const XmlAttribute> attributes);
  void append_escaped(std::string_view text, bool is_attribute);

  std::string text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  std::vector<std::string> open_;
};

/// The text itself if it can be the name of an element and so a gml:id, else such a name for it,
/// which no other text has. Requires UTF-8.
std::string xml_name(std::string_view text);

/// The ids of a document.
class XmlIds {
 public:
  /// The xml_name() of an id; "" if the document has it already.
  std::string take(std::string_view id) {
    std::string name = xml_name(id);
    return taken_.insert(name).second ? name : std::string();
  }

 private:
  std::set<std::string> taken_;
};

}  // namespace watertight::formats
