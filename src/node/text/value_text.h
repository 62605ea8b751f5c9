// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <locale.h>
#include <stdlib.h>

#include <cstdint>
#include <cstdlib>
#include <iomanip>
#include <istream>
#include <locale>
#include <ostream>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// Writes values as text. A line is a word and values, with spaces between them. TextReader reads this text.
///
/// A function pass(file, value) writes the value if the file is a TextWriter, and reads the value if it is a
/// TextReader. So the values of an object are listed once, and writing and reading cannot differ.
class TextWriter {
 public:
  static constexpr bool kReads = false;
  explicit TextWriter(std::ostream& out) : out_(out) {
    out_.imbue(std::locale::classic());
    out_ << std::setprecision(17);
  }

  /// Begins a line with a word.
  void line(const char* word) { out_ << (std::exchange(first_, false) ? "" : "\n") << word; }
  void value(const double& number) { out_ << ' ' << number; }
  void value(const std::string& text) {
    out_ << " %";
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte > ' ' && byte < 0x7f && c != '%') {
        out_ << c;
      } else {
        out_ << '%' << "0123456789abcdef"[byte >> 4] << "0123456789abcdef"[byte & 15];
      }
    }
  }
  template <class Number, std::enable_if_t<std::is_integral<Number>::value || std::is_enum<Number>::value, int> = 0>
  void value(const Number& number) {
    out_ << ' ' << static_cast<std::int64_t>(number);
  }

 private:
  std::ostream& out_;
  bool first_ = true;
};

/// Reads values that TextWriter wrote.
class TextReader {
 public:
  static constexpr bool kReads = true;
  /// @param what  what the text is, for error sentences: "the audit file"
  TextReader(std::istream& in, std::string what) : in_(in), what_(std::move(what)) {}

  /// Begins to read the next line. @throws Refusal parse, like all functions, unless it begins with the word
  void line(const char* word) {
    ++line_;
    std::string text;
    if (!std::getline(in_, text)) fail("the text ends; there should be '" + std::string(word) + "'");
    values_.clear();
    values_.str(text);
    if (next() != word) fail("it should begin with '" + std::string(word) + "'");
  }
  void value(double& number) {
    // A program with a nodelet may have set a locale with a decimal comma, which std::strtod() would use.
    static const locale_t classic = ::newlocale(LC_ALL_MASK, "C", locale_t{});
    const std::string text = next();
    char* end = nullptr;
    number = ::strtod_l(text.c_str(), &end, classic);
    if (text.empty() || *end != '\0') fail("'" + printable(text) + "' should be a number");
  }
  void value(std::string& result) {
    const std::string text = next();
    if (text.empty() || text[0] != '%') fail("'" + printable(text) + "' should be a text, which begins with %");
    result.clear();
    for (std::size_t i = 1; i < text.size(); ++i) {
      if (text[i] == '%' && i + 2 < text.size()) {
        result += static_cast<char>(std::strtol(text.substr(i + 1, 2).c_str(), nullptr, 16));
        i += 2;
      } else {
        result += text[i];
      }
    }
  }
  template <class Number, std::enable_if_t<std::is_integral<Number>::value || std::is_enum<Number>::value, int> = 0>
  void value(Number& number) {
    const std::string text = next();
    char* end = nullptr;
    number = static_cast<Number>(std::strtoll(text.c_str(), &end, 10));
    if (text.empty() || *end != '\0') fail("'" + printable(text) + "' should be a whole number");
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw Refusal(Code::parse, "line " + std::to_string(line_) + " of " + what_ + " is not valid: " + why);
  }

 private:
  std::string next() {
    std::string word;
    values_ >> word;
    return word;
  }
  std::istream& in_;
  const std::string what_;
  std::istringstream values_;
  std::size_t line_ = 0;
};

/// Writes or reads a list: first a line with `word` and the number of elements, then the elements.
/// @param blank  the value of an element before it is read
/// @param each   writes or reads one element
template <class File, class Element, class Each>
void passAll(File& file, const char* word, std::vector<Element>& elements, const Element& blank, const Each& each) {
  std::size_t count = elements.size();
  file.line(word);
  file.value(count);
  if (File::kReads) elements.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (File::kReads) elements.push_back(blank);  // no reserve(): a wrong count must not allocate much
    each(elements[i]);
  }
}

}  // namespace hgrid
