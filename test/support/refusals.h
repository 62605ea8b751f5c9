// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace test {

/// Runs `act`. Returns the code with which `act` is refused, or Code::ok if it is not refused. Stores the error
/// sentence in `*sentence`.
template <class Act>
Code refusalOf(Act&& act, std::string* sentence = nullptr) {
  try {
    act();
  } catch (const Refusal& refusal) {
    if (sentence) *sentence = refusal.what();
    return refusal.code();
  }
  return Code::ok;
}

/// Returns whether the error sentence contains `word`. An error sentence must name the thing, the value and the rule.
inline ::testing::AssertionResult says(const std::string& sentence, const std::string& word) {
  if (sentence.find(word) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << sentence << "\" does not contain \"" << word << "\"";
}

}  // namespace test

inline void PrintTo(Code code, std::ostream* out) { *out << name(code); }

}  // namespace hgrid
