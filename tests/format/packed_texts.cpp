// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the program says of packed texts, for the tests of the format:
//   packed_texts unpack FILE         the texts of packed texts
//   packed_texts pack KIND FILE      packed texts of one text (bytes, json, xml or table)
//   packed_texts rows FILE COUNT     a dictionary of the first lines; each of them packed with it;
//                                    the first one packed without
//   packed_texts examples file|row   the examples of the format
// Each item is its length, a line feed and its bytes; the examples are bytes only.
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "columns/columns.h"
#include "packing/text_dictionary.h"
#include "tests/files.h"

namespace {

using namespace watertight;

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30U;

void print(std::string_view item) { std::cout << item.size() << '\n' << item; }

template <class Value>
Value require(Result<Value> result) {
  if (!result) throw std::runtime_error(to_string(result.error()));
  return *std::move(result);
}

columns::TextKind kind_of(const std::string& name) {
  if (name == "json") return columns::TextKind::json;
  if (name == "xml") return columns::TextKind::xml;
  if (name == "table") return columns::TextKind::table;
  return columns::TextKind::bytes;
}

void unpack(const std::string& file) {
  for (const std::string& text :
       require(columns::unpack_texts(test::read_bytes(file), kMostBytes))) {
    print(text);
  }
}

void pack(const std::string& kind, const std::string& file) {
  const std::string text = test::read_text(file);
  const std::vector<columns::Text> texts{{kind_of(kind), text}};
  print(as_text(columns::pack_texts(texts)));
}

void pack_rows(const std::string& file, std::size_t count) {
  const std::string text = test::read_text(file);
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end = 0;
       (end = text.find('\n', begin)) != std::string::npos && lines.size() < count;
       begin = end + 1) {
    lines.push_back(text.substr(begin, end - begin));
  }
  const auto dictionary = require(packing::best_dictionary(lines, 100 * lines.size()));
  if (dictionary == nullptr) throw std::runtime_error("no dictionary");
  print(as_text(dictionary->content()));
  for (const std::string& line : lines) {
    print(as_text(require(packing::pack(line, dictionary.get()))));
  }
  print(as_text(require(packing::pack(lines.front(), nullptr))));
}

void run(const std::vector<std::string>& arguments) {
  if (arguments.size() == 2 && arguments[0] == "unpack") return unpack(arguments[1]);
  if (arguments.size() == 3 && arguments[0] == "pack") return pack(arguments[1], arguments[2]);
  if (arguments.size() == 3 && arguments[0] == "rows") {
    return pack_rows(arguments[1], std::stoul(arguments[2]));
  }
  if (arguments.size() == 2 && arguments[0] == "examples") {
    std::cout << as_text(columns::packed_examples(arguments[1] == "row"));
    return;
  }
  throw std::runtime_error("packed_texts unpack|pack|rows|examples ...");
}

}  // namespace

int main(int count, char** values) {
  try {
    run({values + 1, values + count});
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
