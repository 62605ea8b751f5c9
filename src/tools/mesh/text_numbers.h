// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// Moves `at` to the begin of the next word of `text` and returns the index after its end. At the end of the text, both
/// are its length.
inline std::size_t nextWord(const std::string& text, std::size_t& at, const char* blanks) {
  at = std::min(text.find_first_not_of(blanks, at), text.size());
  return std::min(text.find_first_of(blanks, at), text.size());
}

/// Returns the decimal number that a word is. The locale of the process must be "C", as it is without setlocale().
/// @throws Refusal parse if the word is anything else, such as "1,5", "nan" or "0x1"
inline double readNumber(const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || word.find_first_not_of("+-.0123456789eE") != std::string::npos || *end != '\0') {
    throw Refusal(Code::parse, "'" + printable(word, 40) + "' is not a decimal number such as -1.5e-3");
  }
  return value;
}

/// Returns the whole number that a word is.
/// @throws Refusal parse if it is none, or less than 0, or larger than a 32-bit number
inline std::uint32_t readIndex(const std::string& word) {
  const bool digits = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
  const unsigned long long value = digits && word.size() < 19 ? std::strtoull(word.c_str(), nullptr, 10) : ~0ull;
  if (value > std::numeric_limits<std::uint32_t>::max()) {
    throw Refusal(Code::parse, "'" + printable(word, 40) + "' is not a whole number from 0 to 4294967295");
  }
  return static_cast<std::uint32_t>(value);
}

}  // namespace hgrid
