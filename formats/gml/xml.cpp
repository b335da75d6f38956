// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/xml.h"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

namespace watertight::formats {
namespace {

// The separator of namespace and local name in expat's names. Neither can hold it: expat refuses a
// namespace with the separator.
constexpr char kSeparator = '\n';

struct ParserDeleter {
  void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};
using ParserOwner = std::unique_ptr<std::remove_pointer_t<XML_Parser>, ParserDeleter>;

std::pair<std::string_view, std::string_view> split_name(std::string_view name) {
  const std::size_t at = name.find(kSeparator);
  if (at == std::string_view::npos) return {{}, name};
  return {name.substr(0, at), name.substr(at + 1)};
}

// Passes the events of expat to the handler, and keeps the first failure.
class Events {
 public:
  Events(XML_Parser parser, XmlHandler& handler, std::uint32_t nesting)
      : parser_(parser), handler_(handler), nesting_(nesting) {
    XML_SetUserData(parser, this);
    XML_SetElementHandler(parser, on_start, on_end);
    XML_SetCharacterDataHandler(parser, on_text);
    XML_SetStartDoctypeDeclHandler(parser, on_doctype);
  }

  // The first failure. Rethrows what the handler threw, as exceptions must not pass through C.
  Status status() const {
    if (exception_) std::rethrow_exception(exception_);
    return error_ ? Status(*error_) : Status(Done{});
  }

 private:
  XmlPlace place() const {
    return {static_cast<std::uint64_t>(std::max<XML_Index>(0, XML_GetCurrentByteIndex(parser_))),
            XML_GetCurrentLineNumber(parser_)};
  }

  template <class Action>
  void run(Action action) {
    if (error_ || exception_) return;
    try {
      Status status = action();
      if (!status) error_ = std::move(status).error();
    } catch (...) {
      exception_ = std::current_exception();
    }
    if (error_ || exception_) XML_StopParser(parser_, XML_FALSE);
  }

  Status start(const char* name, const char** attributes) {
    if (++depth_ > nesting_) {
      return error_at(place(), ErrorCode::limit_exceeded,
                      "elements are nested deeper than " + std::to_string(nesting_));
    }
    const auto [space, local] = split_name(name);
    const auto tag_bytes =
        static_cast<std::uint64_t>(std::max(0, XML_GetCurrentByteCount(parser_)));
    const XmlPlace tag = place();
    return handler_.start(XmlElement{space, local, attributes, tag, tag.byte + tag_bytes});
  }

  static void on_start(void* self, const char* name, const char** attributes) {
    auto& events = *static_cast<Events*>(self);
    events.run([&] { return events.start(name, attributes); });
  }
  static void on_end(void* self, const char*) {
    auto& events = *static_cast<Events*>(self);
    --events.depth_;
    events.run([&] { return events.handler_.end(); });
  }
  static void on_text(void* self, const char* text, int size) {
    auto& events = *static_cast<Events*>(self);
    events.run([&] { return events.handler_.text({text, static_cast<std::size_t>(size)}); });
  }
  static void on_doctype(void* self, const char*, const char*, const char*, int) {
    auto& events = *static_cast<Events*>(self);
    events.run([&]() -> Status {
      return error_at(events.place(), ErrorCode::unsupported,
                      "a document type declaration (DOCTYPE) is refused, and entities with it");
    });
  }

  XML_Parser parser_;
  XmlHandler& handler_;
  std::uint32_t nesting_;
  std::uint32_t depth_ = 0;
  std::optional<Error> error_;
  std::exception_ptr exception_;
};

Error syntax_error(XML_Parser parser) {
  const XML_Error code = XML_GetErrorCode(parser);
  const XmlPlace place{
      static_cast<std::uint64_t>(std::max<XML_Index>(0, XML_GetCurrentByteIndex(parser))),
      XML_GetCurrentLineNumber(parser)};
  if (code == XML_ERROR_UNKNOWN_ENCODING) {
    return error_at(place, ErrorCode::unsupported,
                    "the encoding is not read; UTF-8, UTF-16, ISO-8859-1 and US-ASCII are");
  }
  const char* reason = XML_ErrorString(code);
  return error_at(place, ErrorCode::malformed,
                  std::string("not well-formed XML: ").append(reason ? reason : "unknown error"));
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kXmlBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kXmlBlanks) + 1 - begin);
}

std::string_view take_word(std::string_view& text, std::string_view separators) {
  text.remove_prefix(std::min(text.find_first_not_of(separators), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(separators));
  text.remove_prefix(word.size());
  return word;
}

std::vector<std::string_view> words_of(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> words;
  for (auto word = take_word(text, separators); !word.empty(); word = take_word(text, separators)) {
    words.push_back(word);
  }
  return words;
}

Error error_at(XmlPlace place, ErrorCode code, std::string_view message) {
  std::string text = "line ";
  text.append(std::to_string(place.line)).append(": ").append(message);
  return Error{code, std::move(text), place.byte, {}};
}

std::optional<std::string_view> XmlElement::attribute(std::string_view attribute_space,
                                                      std::string_view attribute_name) const {
  for (const char** next = attributes; next != nullptr && *next != nullptr; next += 2) {
    const auto [its_space, its_name] = split_name(next[0]);
    if (its_name == attribute_name && its_space == attribute_space) return next[1];
  }
  return std::nullopt;
}

Status read_xml(ByteView bytes, XmlHandler& handler, const Limits& limits) {
  const ParserOwner parser(XML_ParserCreateNS(nullptr, kSeparator));
  if (!parser) return Error{ErrorCode::unavailable, "no memory for an XML parser"};
  Events events(parser.get(), handler, limits.nesting);
  // The pieces are as large as an int can count: expat 2.5 reads a token that the end of a piece
  // cuts again from its beginning, which takes quadratic time with small pieces.
  constexpr std::size_t kPiece = std::size_t{1} << 30;
  for (std::size_t at = 0;;) {
    const std::size_t size = std::min(kPiece, bytes.size() - at);
    const bool is_last = at + size == bytes.size();
    const auto* piece = reinterpret_cast<const char*>(bytes.data()) + at;
    const XML_Status parsed = XML_Parse(parser.get(), piece, static_cast<int>(size), is_last);
    if (auto status = events.status(); !status) return status;
    if (parsed != XML_STATUS_OK) return syntax_error(parser.get());
    if (is_last) return Done{};
    at += size;
  }
}

}  // namespace watertight::formats
