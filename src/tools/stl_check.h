// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// Whether the bytes are a binary STL file: after a header of 80 bytes, the number of triangles determines its size.
inline bool isBinaryStl(const std::string& data) {
  if (data.size() < 84) return false;
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, data.data() + 80, sizeof(triangles));
  return data.size() == 84 + std::uint64_t{50} * triangles;
}

/// Counts the words of a text STL file. The names after `solid` and `endsolid` do not count.
struct StlWords {
  explicit StlWords(const std::string& data) {
    for (std::size_t at = 0, end = 0; at < data.size(); at = end) {
      at = std::min(data.find_first_not_of(kBlanks, at), data.size());
      end = std::min(data.find_first_of(kBlanks, at), data.size());
      std::string word = data.substr(at, end - at);
      for (char& letter : word) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
      facets += word == "facet" ? 1 : 0;
      vertices += word == "vertex" ? 1 : 0;
      if (word != "solid" && word != "endsolid") continue;
      ended = word == "endsolid";
      end = std::min(data.find_first_of("\r\n", end), data.size());
    }
  }

  static constexpr char kBlanks[] = " \t\r\n\v\f";
  std::size_t facets = 0, vertices = 0;
  bool ended = false;  ///< whether an `endsolid` follows the last `solid`
};

/// Refuses a text STL file that ends before `endsolid`, has a zero byte, or has a facet without 3 vertices. The parser
/// would accept such a file and leave out triangles.
/// @throws Refusal truncated, parse
inline void checkStl(const std::string& data) {
  const std::size_t first = std::min(data.find_first_not_of(StlWords::kBlanks), data.size());
  if (isBinaryStl(data) || data.compare(first, 5, "solid") != 0) return;
  if (data.find('\0') != std::string::npos) {
    throw Refusal(Code::parse, "it has a zero byte at byte " + std::to_string(data.find('\0')) +
                                   "; a text STL file must not contain one");
  }
  const StlWords words(data);
  if (!words.ended) {
    throw Refusal(Code::truncated,
                  "it does not end with 'endsolid', so it may have been written only in part; write it again");
  }
  if (words.vertices != 3 * words.facets) {
    throw Refusal(Code::parse, "it has " + std::to_string(words.facets) + " facets and " +
                                   std::to_string(words.vertices) + " vertices; each facet must have 3 vertices");
  }
}

}  // namespace hgrid
