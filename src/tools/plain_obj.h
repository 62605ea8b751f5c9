// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

// Characters that separate the words of a line of an OBJ file.
inline constexpr char kObjBlanks[] = " \t\v\f";

/// Returns the first word of `line` from index `at` on, and moves `at` to its end. Returns an empty text at the end of
/// the line.
inline std::string nextObjWord(const std::string& line, std::size_t& at) {
  const std::size_t begin = std::min(line.find_first_not_of(kObjBlanks, at), line.size());
  at = std::min(line.find_first_of(kObjBlanks, begin), line.size());
  return line.substr(begin, at - begin);
}

/// Whether a word is a corner of a face: v, v/vt, v//vn or v/vt/vn, with or without slashes at its end. Each number may
/// have a minus sign.
inline bool isObjCorner(const std::string& word) {
  std::size_t at = 0;
  const auto readNumber = [&] {
    if (at < word.size() && word[at] == '-') ++at;
    const std::size_t begin = at;
    at = std::min(word.find_first_not_of("0123456789", begin), word.size());
    return at > begin;
  };
  if (!readNumber()) return false;
  for (int part = 0; part < 2 && at < word.size(); ++part) {
    if (word[at++] != '/') return false;
    if (at < word.size() && word[at] != '/' && !readNumber()) return false;
  }
  return at == word.size();
}

/// Checks the corners of a face. The parser would leave out a face with fewer than 3 corners. It would misread other
/// corners than v, v/vt, v//vn and v/vt/vn.
/// @throws Refusal parse
inline void checkObjFace(const std::string& line) {
  std::size_t at = 0;
  if (nextObjWord(line, at) != "f") return;
  int corners = 0;
  for (std::string corner = nextObjWord(line, at); !corner.empty(); corner = nextObjWord(line, at), ++corners) {
    if (isObjCorner(corner)) continue;
    throw Refusal(Code::parse, "its face '" + line + "' has the corner '" + corner +
                                   "'; a corner must be v, v/vt, v//vn or v/vt/vn with whole numbers");
  }
  if (corners < 3) throw Refusal(Code::parse, "its face '" + line + "' has fewer than 3 corners");
}

/// Refuses an OBJ file that ends within a line, or that contains a zero byte. A file that was cut between two lines
/// cannot be told from a complete one.
/// @throws Refusal truncated, parse
inline void checkObjText(const std::string& data) {
  if (data.find('\0') != std::string::npos) {
    throw Refusal(Code::parse, "it has a zero byte at byte " + std::to_string(data.find('\0')) +
                                   "; an OBJ file must be text without zero bytes");
  }
  std::size_t at = data.find_last_of("\r\n") + 1;  // begin of the last line; 0 if there is no line break
  const std::string word = nextObjWord(data, at);
  if (!word.empty() && word[0] != '#') {
    throw Refusal(Code::truncated,
                  "its last line has no line break, so it may have been written only in part; write it again, or add "
                  "a line break if it is complete");
  }
}

/// Returns the text of an OBJ file in the form that the parser reads without loss. The parser would silently leave out
/// indented lines and some lines after a continued line. Therefore, no line of the result is indented, only spaces and
/// tabs separate words, and a line that ends with a backslash is joined with the next one.
/// @throws Refusal truncated, parse
inline std::string plainObj(const std::string& data) {
  checkObjText(data);
  std::string plain, line;
  const auto endLine = [&] {
    line.erase(0, line.find_first_not_of(kObjBlanks));
    checkObjFace(line);
    plain += line + '\n';
    line.clear();
  };
  for (std::size_t at = data.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0; at < data.size(); ++at) {  // the mark of UTF-8
    const char c = data[at];
    if (c != '\n' && c != '\r') {
      line += c == '\v' || c == '\f' ? ' ' : c;
      continue;
    }
    if (data.compare(at, 2, "\r\n") == 0) ++at;
    if (line.empty() || line.back() != '\\') {
      endLine();
    } else {
      line.back() = ' ';
    }
  }
  if (line.empty()) return plain;
  if (line.back() == '\\') line.back() = ' ';
  endLine();
  return plain;
}

}  // namespace hgrid
