// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/name.h"

#include <algorithm>

#include "hgrid_proximity/refusal.h"
#include "utf8.h"

namespace hgrid {

void checkLocal(const std::string& local, const std::string& what) {
  const auto refuse = [&](const std::string& rule) {
    throw Refusal(Code::bad_id, what + " is '" + printable(local, 48) + "'; " + rule);
  };
  if (local.empty()) refuse("it must not be empty");
  if (local.size() > kLongestName) {
    refuse("it has " + std::to_string(local.size()) + " bytes; at most " + std::to_string(kLongestName) +
           " are allowed");
  }
  for (std::size_t i = 0; i < local.size();) {
    const std::size_t length = utf8Length(local, i);
    if (length == 0) refuse("it must be UTF-8 without control characters");
    i += length;
  }
}

void checkSource(const std::string& source, const std::string& what) {
  checkLocal(source, what);
  if (source.find('/') != std::string::npos) {
    throw Refusal(Code::bad_id, what + " is '" + printable(source, 48) + "'; it must not contain a slash");
  }
}

std::string joined(const std::string& source, const std::string& local) { return source + "/" + local; }

bool matches(const std::string& glob, const std::string& name) {
  // After a mismatch, the last star before the mismatch is tried again with a longer match. The earlier stars are not,
  // because a longer match of an earlier star would not help.
  std::size_t g = 0, n = 0, star = std::string::npos, resume = 0;
  while (n < name.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      resume = n;
    } else if (g < glob.size() && glob[g] == name[n]) {
      ++g;
      ++n;
    } else if (star != std::string::npos) {
      g = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  while (g < glob.size() && glob[g] == '*') ++g;
  return g == glob.size();
}

bool canMatchTogether(const std::string& first, const std::string& second) {
  // possible[j]: whether some name matches both the rest of `first` from i on and the rest of `second` from j on.
  std::vector<bool> possible(second.size() + 1), below;
  for (std::size_t i = first.size() + 1; i-- > 0;) {
    below = possible;  // the values for i + 1
    for (std::size_t j = second.size() + 1; j-- > 0;) {
      const bool a = i < first.size(), b = j < second.size();
      const bool star_a = a && first[i] == '*', star_b = b && second[j] == '*';
      bool here = !a && !b;
      if (star_a) here = below[j] || (b && possible[j + 1]);
      if (star_b && !here) here = possible[j + 1] || (a && below[j]);
      if (a && b && !star_a && !star_b && first[i] == second[j]) here = below[j + 1];
      possible[j] = here;
    }
  }
  return possible[0];
}

bool coversGlob(const std::string& wide, const std::string& narrow) {
  // Works like matches() with `narrow` as the name. A star in `narrow` stands for any bytes, so only a star in `wide`
  // can match it.
  std::size_t w = 0, n = 0, star = std::string::npos, resume = 0;
  while (n < narrow.size()) {
    if (w < wide.size() && wide[w] == '*') {
      star = w++;
      resume = n;
    } else if (w < wide.size() && narrow[n] != '*' && wide[w] == narrow[n]) {
      ++w;
      ++n;
    } else if (star != std::string::npos) {
      w = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  while (w < wide.size() && wide[w] == '*') ++w;
  return w == wide.size();
}

bool matchesAny(const std::vector<std::string>& globs, const std::string& name) {
  return std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) { return matches(glob, name); });
}

}  // namespace hgrid
