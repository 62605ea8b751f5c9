// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/tools/plain_obj.h"
#include "test/fuzz/obj_oracle.h"
#include "test/fuzz/targets.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

/// Returns what is wrong with the text that plainObj() made of an OBJ file; empty if nothing is wrong.
std::string flawOfPlain(const std::string& plain, std::string_view file) {
  if (plain.compare(0, 3, "\xef\xbb\xbf") == 0) return {};  // a second call would remove a second mark of UTF-8
  if (plainObj(plain) != plain) return "the text is not plain";
  if (plain.find_first_of(std::string("\r\0", 2)) != std::string::npos) return "a character does not belong there";
  for (std::size_t at = 0; at < plain.size(); at = plain.find('\n', at) + 1) {
    if (std::string_view(" \t\v\f").find(plain[at]) != std::string_view::npos) return "a line is indented";
  }
  const std::vector<std::vector<std::string>> lines = wordsOfObj(file);
  if (wordsOfObj(plain) != lines) return "the words are not those of the file";
  for (const std::vector<std::string>& words : lines) {
    if (!words.empty() && words[0] == "f" && words.size() < 4) return "a face has fewer than 3 corners";
  }
  return {};
}

}  // namespace

FuzzResult fuzzObj(std::string_view input) {
  try {
    return {true, flawOfPlain(plainObj(std::string(input)), input)};
  } catch (const Refusal& refusal) {
    return {false, flawOfSentence(printable(refusal.what(), 200))};  // the loader makes the sentence printable
  }
}

}  // namespace test
}  // namespace hgrid
