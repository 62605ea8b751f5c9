// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Finds bodies by name or by glob without looking at each: a glob is compared with those names only that begin as it
/// does. Refers to the bodies that it was made from.
class NameIndex {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  explicit NameIndex(const std::vector<Body>& bodies);

  /// Index of the body of this name, or kNone.
  std::uint32_t find(const std::string& name) const;
  /// Replaces `found` by the bodies that the glob matches, in the order of their names.
  void matching(const std::string& glob, std::vector<std::uint32_t>& found) const;
  bool matchesNone(const std::string& glob) const;

 private:
  using Iterator = std::vector<std::uint32_t>::const_iterator;
  /// From the first name that is not before this one.
  Iterator from(const std::string& name) const;
  /// The names that begin as the glob does.
  std::pair<Iterator, Iterator> candidates(const std::string& glob) const;

  const std::vector<Body>& bodies_;
  std::vector<std::uint32_t> order_;  // bodies by name
};

}  // namespace hgrid
