// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/fuzz/obj_oracle.h"

#include <cstring>

namespace hgrid {
namespace test {

std::vector<std::vector<std::string>> wordsOfObj(std::string_view text) {
  std::string clean(text.substr(text.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0));
  for (const char* line_break : {"\r\n", "\r"}) {
    for (std::size_t at = clean.find(line_break); at != std::string::npos; at = clean.find(line_break, at)) {
      clean.replace(at, std::strlen(line_break), "\n");
    }
  }
  for (std::size_t at = clean.find("\\\n"); at != std::string::npos; at = clean.find("\\\n", at)) {
    clean.replace(at, 2, " ");
  }
  if (!clean.empty() && clean.back() == '\\') clean.back() = ' ';
  std::vector<std::vector<std::string>> lines(1);
  bool in_word = false;
  for (const char c : clean) {
    if (c == '\n') lines.emplace_back();
    const bool blank = c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\n';
    if (!blank && !in_word) lines.back().emplace_back();
    if (!blank) lines.back().back() += c;
    in_word = !blank;
  }
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

}  // namespace test
}  // namespace hgrid
