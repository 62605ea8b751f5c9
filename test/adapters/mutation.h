// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "test/support/random.h"

namespace hgrid {
namespace test {

/// Returns `text` with one or two random faults: a changed byte, a missing end, an inserted word, or a part that is
/// doubled or removed.
inline std::string mutated(const std::string& text, const std::vector<std::string>& words, Random& random) {
  std::string harmed = text;
  for (int harms = random.between(1, 2); harms > 0 && !harmed.empty(); --harms) {
    const auto at = static_cast<std::size_t>(random.below(static_cast<int>(harmed.size())));
    const auto length = static_cast<std::size_t>(random.between(1, random.chance(0.5) ? 4 : 200));
    switch (random.below(words.empty() ? 4 : 6)) {
      case 0:
        harmed[at] = static_cast<char>(harmed[at] ^ (1 << random.below(8)));
        break;
      case 1:
        harmed[at] = static_cast<char>(random.below(256));
        break;
      case 2:
        harmed.insert(at, harmed.substr(at, length));
        break;
      case 3:
        if (random.chance(0.3))
          harmed.resize(at);
        else
          harmed.erase(at, length);
        break;
      case 4:
        harmed.insert(at, words[static_cast<std::size_t>(random.below(static_cast<int>(words.size())))]);
        break;
      case 5: {
        const std::string& word = words[static_cast<std::size_t>(random.below(static_cast<int>(words.size())))];
        harmed.replace(at, word.size(), word);
        break;
      }
    }
  }
  return harmed;
}

}  // namespace test
}  // namespace hgrid
