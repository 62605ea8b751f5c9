// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

constexpr std::size_t kLongestSentence = 4000;  // [bytes]

/// Decodes the UTF-8 character at text[at] and moves `at` behind it. Does not use the product's decoder.
/// @returns -1 if the bytes are not valid UTF-8
long decodedCharacter(const std::string& text, std::size_t& at) {
  const auto lead = static_cast<unsigned char>(text[at++]);
  if (lead < 0x80) return lead;
  int more = 0;
  long least = 0, code = 0;
  if (lead >> 5 == 0x6) more = 1, least = 0x80, code = lead & 0x1f;
  if (lead >> 4 == 0xe) more = 2, least = 0x800, code = lead & 0x0f;
  if (lead >> 3 == 0x1e) more = 3, least = 0x10000, code = lead & 0x07;
  if (more == 0) return -1;
  for (; more > 0; --more, ++at) {
    if (at >= text.size() || static_cast<unsigned char>(text[at]) >> 6 != 2) return -1;
    code = code * 64 + (static_cast<unsigned char>(text[at]) & 0x3f);
  }
  return code < least || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff) ? -1 : code;
}

}  // namespace

std::string flawOfSentence(const std::string& sentence) {
  if (sentence.empty()) return "the sentence is empty";
  if (sentence.size() > kLongestSentence) return "the sentence has " + std::to_string(sentence.size()) + " bytes";
  for (std::size_t at = 0; at < sentence.size();) {
    const std::size_t begin = at;
    const long code = decodedCharacter(sentence, at);
    if (code >= 0x20 && (code < 0x7f || code > 0x9f)) continue;
    return "the sentence is not printable at byte " + std::to_string(begin) + ": " + sentence;
  }
  return {};
}

std::string flawOfRefusal(const Refusal& refusal) {
  if (refusal.code() == Code::ok || refusal.code() > Code::failed) return "the refusal has an invalid code";
  if (refusal.code() == Code::internal) return std::string("the product blames itself: ") + refusal.what();
  return flawOfSentence(refusal.what());
}

}  // namespace test
}  // namespace hgrid
