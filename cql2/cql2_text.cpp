// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/ascii.h"
#include "cql2/cql2.h"
#include "cql2/parts.h"

namespace watertight::cql2 {
namespace {

using store::Filter;
using Kind = Filter::Kind;

enum class Word : std::uint8_t { end, name, text, number, sign };

struct Token {
  Word word = Word::end;
  std::string text;        // of a name, a text without its quotes, a number, a sign
  std::size_t offset = 0;  // of its first byte
  bool is_quoted = false;  // a name in quotes, which is no keyword
};

bool is_name_start(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || c == ':' ||
         static_cast<unsigned char>(c) >= 0x80U;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_part(char c) { return is_name_start(c) || is_digit(c) || c == '.' || c == '-'; }

Error malformed(std::string message, std::size_t offset) {
  return {ErrorCode::malformed, "filter: " + std::move(message), offset};
}

/// Takes a text apart.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  Result<Token> next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    Token token{Word::end, "", at_};
    if (at_ == text_.size()) return token;
    const char c = text_[at_];
    if (c == '\'') return quoted(Word::text);
    if (c == '"') return quoted(Word::name);
    if (is_digit(c) || ((c == '-' || c == '+' || c == '.') && has_digit_after())) return number();
    if (is_name_start(c)) {
      while (at_ < text_.size() && is_name_part(text_[at_])) token.text.push_back(text_[at_++]);
      token.word = Word::name;
      return token;
    }
    for (const std::string_view sign : {"<=", ">=", "<>", "<", ">", "=", "(", ")", ","}) {
      if (!text_.substr(at_).starts_with(sign)) continue;
      at_ += sign.size();
      return Token{Word::sign, std::string(sign), token.offset};
    }
    return malformed("a character that has no meaning here", at_);
  }

 private:
  bool has_digit_after() const {
    const std::string_view rest = text_.substr(at_ + 1);
    return !rest.empty() && (is_digit(rest[0]) || (rest[0] == '.' && text_[at_] != '.'));
  }

  /// A text or name in quotes; a quote in it is written twice or after a backslash.
  Result<Token> quoted(Word word) {
    const char quote = text_[at_];
    Token token{word, "", at_++, true};
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      const bool has_quote = at_ < text_.size() && text_[at_] == quote;
      if ((c == quote || c == '\\') && has_quote) {
        token.text.push_back(quote);
        ++at_;
      } else if (c == quote) {
        return token;
      } else {
        token.text.push_back(c);
      }
    }
    return malformed("a quote is not closed", token.offset);
  }

  /// A number as JSON writes it.
  Result<Token> number() {
    Token token{Word::number, "", at_};
    if (text_[at_] == '+') ++at_;
    if (text_[at_] == '-') token.text.push_back(text_[at_++]);
    const auto digits = [&] {
      std::size_t count = 0;
      for (; at_ < text_.size() && is_digit(text_[at_]); ++count)
        token.text.push_back(text_[at_++]);
      return count;
    };
    if (digits() == 0) token.text.push_back('0');
    if (at_ < text_.size() && text_[at_] == '.') {
      ++at_;
      token.text.push_back('.');
      if (digits() == 0) token.text.push_back('0');
    }
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      token.text.push_back(text_[at_++]);
      if (at_ < text_.size() && (text_[at_] == '-' || text_[at_] == '+')) {
        token.text.push_back(text_[at_++]);
      }
      if (digits() == 0) return malformed("an exponent without digits", at_);
    }
    if (at_ < text_.size() && is_name_start(text_[at_])) {
      return malformed("a number goes over into a name", at_);
    }
    return token;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// Reads by the grammar of the standard, by recursive descent; each function reads one rule.
class Parser {
 public:
  explicit Parser(std::string_view text) : lexer_(text) {}

  Result<Filter> all() {
    if (Status read = step(); !read) return std::move(read).error();
    auto filter = expression();
    if (!filter) return filter;
    if (token_.word != Word::end) return wrong("AND, OR or the end");
    return filter;
  }

 private:
  Status step() {
    auto token = lexer_.next();
    if (!token) return std::move(token).error();
    token_ = *std::move(token);
    return Done{};
  }
  bool is_keyword(std::string_view word) const {
    return token_.word == Word::name && !token_.is_quoted && lower_case(token_.text) == word;
  }
  bool is_sign(std::string_view sign) const {
    return token_.word == Word::sign && token_.text == sign;
  }
  Error wrong(const char* expected) const {
    const std::string found = token_.word == Word::end ? "the end" : "'" + token_.text + "'";
    return malformed(std::string("expected ") + expected + ", found " + found, token_.offset);
  }
  Status expect(std::string_view sign, const char* name) {
    if (!is_sign(sign)) return wrong(name);
    return step();
  }
  Status expect_keyword(std::string_view word, const char* name) {
    if (!is_keyword(word)) return wrong(name);
    return step();
  }

  /// booleanExpression: terms with OR between them.
  Result<Filter> expression() { return list("or", Kind::any, &Parser::term); }
  /// booleanTerm: factors with AND between them.
  Result<Filter> term() { return list("and", Kind::all, &Parser::factor); }

  Result<Filter> list(std::string_view word, Kind kind, Result<Filter> (Parser::*part)()) {
    auto first = (this->*part)();
    if (!first || !is_keyword(word)) return first;
    Filter joined{kind};
    joined.parts.push_back(*std::move(first));
    while (is_keyword(word)) {
      if (Status read = step(); !read) return std::move(read).error();
      auto next = (this->*part)();
      if (!next) return next;
      joined.parts.push_back(*std::move(next));
    }
    return joined;
  }

  /// booleanFactor: NOT or not before a primary.
  Result<Filter> factor() {
    if (!is_keyword("not")) return primary();
    if (++depth_ > store::kDeepestFilter) return too_deep();
    if (Status read = step(); !read) return std::move(read).error();
    auto part = factor();
    --depth_;
    if (!part) return part;
    return negated(*std::move(part));
  }

  Error too_deep() const {
    return {ErrorCode::limit_exceeded, "filter: nested too deep", token_.offset};
  }

  /// booleanPrimary: an expression in parentheses, a constant, a function or a predicate.
  Result<Filter> primary() {
    if (is_sign("(")) {
      if (++depth_ > store::kDeepestFilter) return too_deep();
      if (Status read = step(); !read) return std::move(read).error();
      auto inner = expression();
      --depth_;
      if (!inner) return inner;
      if (Status read = expect(")", "a closing parenthesis"); !read) return std::move(read).error();
      return inner;
    }
    if (is_keyword("true") || is_keyword("false")) {
      Filter constant;
      constant.truth = is_keyword("true");
      if (Status read = step(); !read) return std::move(read).error();
      return constant;
    }
    if (token_.word != Word::name) return wrong("the name of an attribute");
    const Token name = token_;
    if (Status read = step(); !read) return std::move(read).error();
    if (is_sign("(") && !name.is_quoted) return function(name);
    return predicate(name.text);
  }

  Result<Filter> function(const Token& name) {
    if (lower_case(name.text) != "s_intersects") {
      return Error{ErrorCode::unsupported,
                   "filter: the function " + name.text + " is not known here; S_INTERSECTS is",
                   name.offset};
    }
    if (Status read = step(); !read) return std::move(read).error();
    if (token_.word != Word::name) return wrong("the name of the geometry");
    if (Status read = step(); !read) return std::move(read).error();
    if (Status read = expect(",", "a comma"); !read) return std::move(read).error();
    auto box = geometry();
    if (!box) return box;
    if (Status read = expect(")", "a closing parenthesis"); !read) return std::move(read).error();
    return box;
  }

  /// BBOX(west, south, [low,] east, north[, high]) or POINT(x y), also POINT Z(x y z).
  Result<Filter> geometry() {
    const bool is_point = is_keyword("point");
    if (!is_point && !is_keyword("bbox")) {
      return Error{ErrorCode::unsupported, "filter: the geometry can be BBOX(...) or POINT(...)",
                   token_.offset};
    }
    const std::size_t offset = token_.offset;
    if (Status read = step(); !read) return std::move(read).error();
    if (is_point && is_keyword("z")) {
      if (Status read = step(); !read) return std::move(read).error();
    }
    if (Status read = expect("(", "a parenthesis"); !read) return std::move(read).error();
    std::vector<double> numbers;
    while (token_.word == Word::number && numbers.size() < 6) {
      numbers.push_back(number_of(token_.text));
      if (Status read = step(); !read) return std::move(read).error();
      if (is_point) continue;
      if (!is_sign(",")) break;
      if (Status read = step(); !read) return std::move(read).error();
    }
    if (Status read = expect(")", "a closing parenthesis"); !read) return std::move(read).error();
    auto filter = is_point ? point_filter(numbers) : box_filter(numbers);
    if (!filter) return malformed(filter.error().message, offset);
    return filter;
  }

  /// What follows the name of an attribute.
  Result<Filter> predicate(std::string name) {
    const bool is_not = is_keyword("not");
    if (is_not) {
      if (Status read = step(); !read) return std::move(read).error();
    }
    Result<Filter> filter = Filter{};
    if (is_keyword("like")) {
      filter = like(std::move(name));
    } else if (is_keyword("between")) {
      filter = between(std::move(name));
    } else if (is_keyword("in")) {
      filter = in(std::move(name));
    } else if (is_not) {
      return wrong("LIKE, BETWEEN or IN");
    } else if (is_keyword("is")) {
      filter = is_null(std::move(name));
    } else {
      filter = comparison(std::move(name));
    }
    if (!filter || !is_not) return filter;
    return negated(*std::move(filter));
  }

  Result<Filter> comparison(std::string name) {
    const auto compared = comparison_named(token_.word == Word::sign ? token_.text : "");
    if (!compared) return wrong("a comparison, LIKE, BETWEEN, IN or IS NULL");
    if (Status read = step(); !read) return std::move(read).error();
    auto value = literal();
    if (!value) return std::move(value).error();
    Filter filter{Kind::compare, {}, std::move(name), *compared};
    filter.values.push_back(*std::move(value));
    return filter;
  }

  Result<Filter> like(std::string name) {
    if (Status read = step(); !read) return std::move(read).error();
    if (token_.word != Word::text) return wrong("a text with % or _");
    if (!is_pattern(token_.text))
      return malformed("a pattern ends with a backslash", token_.offset);
    Filter filter{Kind::like, {}, std::move(name)};
    filter.values.push_back({AttributeValue::Type::text, token_.text});
    if (Status read = step(); !read) return std::move(read).error();
    return filter;
  }

  Result<Filter> between(std::string name) {
    if (Status read = step(); !read) return std::move(read).error();
    auto low = literal();
    if (!low) return std::move(low).error();
    if (Status read = expect_keyword("and", "AND"); !read) return std::move(read).error();
    auto high = literal();
    if (!high) return std::move(high).error();
    Filter filter{Kind::between, {}, std::move(name)};
    filter.values = {*std::move(low), *std::move(high)};
    return filter;
  }

  Result<Filter> in(std::string name) {
    if (Status read = step(); !read) return std::move(read).error();
    if (Status read = expect("(", "a parenthesis"); !read) return std::move(read).error();
    Filter filter{Kind::compare, {}, std::move(name)};
    for (;;) {
      auto value = literal();
      if (!value) return std::move(value).error();
      filter.values.push_back(*std::move(value));
      if (!is_sign(",")) break;
      if (Status read = step(); !read) return std::move(read).error();
    }
    if (Status read = expect(")", "a closing parenthesis"); !read) return std::move(read).error();
    return filter;
  }

  Result<Filter> is_null(std::string name) {
    if (Status read = step(); !read) return std::move(read).error();
    const bool is_not = is_keyword("not");
    if (is_not) {
      if (Status read = step(); !read) return std::move(read).error();
    }
    if (Status read = expect_keyword("null", "NULL"); !read) return std::move(read).error();
    Filter filter{Kind::is_null, {}, std::move(name)};
    if (!is_not) return filter;
    return negated(std::move(filter));
  }

  /// A number, a text, TRUE, FALSE, DATE('...') or TIMESTAMP('...').
  Result<AttributeValue> literal() {
    using Type = AttributeValue::Type;
    AttributeValue value;
    if (token_.word == Word::number) {
      value = {Type::number, token_.text};
    } else if (token_.word == Word::text) {
      value = {Type::text, token_.text};
    } else if (is_keyword("true") || is_keyword("false")) {
      value = {Type::truth, lower_case(token_.text)};
    } else if (is_keyword("date") || is_keyword("timestamp")) {
      if (Status read = step(); !read) return std::move(read).error();
      if (Status read = expect("(", "a parenthesis"); !read) return std::move(read).error();
      if (token_.word != Word::text || !is_instant(token_.text)) return wrong("a date in quotes");
      value = {Type::text, token_.text};
      if (Status read = step(); !read) return std::move(read).error();
      if (!is_sign(")")) return wrong("a closing parenthesis");
    } else {
      return wrong("a number, a text in single quotes, TRUE, FALSE or DATE('...')");
    }
    if (Status read = step(); !read) return std::move(read).error();
    return value;
  }

  static double number_of(const std::string& text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} ? number : std::numeric_limits<double>::quiet_NaN();
  }

  Lexer lexer_;
  Token token_;
  std::size_t depth_ = 0;
};

}  // namespace

Result<store::Filter> read_text(std::string_view text) {
  auto filter = Parser(text).all();
  if (!filter) return filter;
  if (Status checked = store::check_filter(*filter); !checked) return std::move(checked).error();
  return filter;
}

Filter negated(Filter part) {
  Filter filter{Kind::no};
  filter.parts.push_back(std::move(part));
  return filter;
}

std::optional<store::Comparison> comparison_named(std::string_view sign) {
  using store::Comparison;
  constexpr std::array<std::pair<std::string_view, Comparison>, 6> kSigns{
      {{"=", Comparison::equal},
       {"<>", Comparison::different},
       {"<", Comparison::less},
       {"<=", Comparison::at_most},
       {">", Comparison::greater},
       {">=", Comparison::at_least}}};
  for (const auto& [name, comparison] : kSigns) {
    if (name == sign) return comparison;
  }
  return std::nullopt;
}

bool is_instant(std::string_view text) {
  return text.size() >= 10 &&
         text.find_first_not_of("0123456789-:.+TZtz") == std::string_view::npos;
}

bool is_pattern(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && ++i == text.size()) return false;
  }
  return true;
}

Result<Filter> box_filter(std::span<const double> numbers) {
  const std::size_t axes = numbers.size() / 2;
  const bool is_box = numbers.size() == 4 || numbers.size() == 6;
  const bool is_finite = std::all_of(numbers.begin(), numbers.end(),
                                     [](double number) { return std::isfinite(number); });
  if (!is_box || !is_finite) {
    return Error{ErrorCode::malformed, "a box has 4 or 6 finite numbers"};
  }
  Filter filter{Kind::box};
  filter.box.min[2] = std::numeric_limits<double>::lowest();
  filter.box.max[2] = std::numeric_limits<double>::max();
  for (std::size_t axis = 0; axis < axes; ++axis) {
    filter.box.min[axis] = numbers[axis];
    filter.box.max[axis] = numbers[axes + axis];
  }
  return filter;
}

Result<Filter> point_filter(std::span<const double> numbers) {
  if (numbers.size() != 2 && numbers.size() != 3) {
    return Error{ErrorCode::malformed, "a point has 2 or 3 finite numbers"};
  }
  std::vector<double> twice(numbers.begin(), numbers.end());
  twice.insert(twice.end(), numbers.begin(), numbers.end());
  return box_filter(twice);
}

}  // namespace watertight::cql2
