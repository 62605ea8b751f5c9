// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Readers of parameters that are one of several words, or the name of a topic.
#pragma once

#include <ros/names.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "hgrid_proximity/refusal.h"
#include "node/params/param_value.h"

namespace hgrid {

/// Reads a word of the list `words`. The index of the word in the list is the value of the enum.
/// @param rule  the allowed words, for the error sentence: "ignore, report or occupied"
template <std::size_t count, class Enum>
void readWord(ParamValue& given, const char* const (&words)[count], const char* rule, Enum& value) {
  std::string word = words[static_cast<std::size_t>(value)];
  given.string(word);
  const auto* const found = std::find(std::begin(words), std::end(words), word);
  if (found == std::end(words)) {
    given.error("is '" + printable(word, 48) + "'; it must be " + rule);
  } else {
    value = static_cast<Enum>(found - std::begin(words));
  }
}

/// Adds an error unless `topic` is a valid name of a topic. @param element  the element that has the topic
inline void checkTopic(const ParamValue& element, const std::string& topic) {
  std::string flaw = "it must not be empty";
  if (topic.empty() || !ros::names::validate(topic, flaw)) {
    element.error("has the topic '" + printable(topic) + "': " + printable(flaw, 300));
  }
}

}  // namespace hgrid
