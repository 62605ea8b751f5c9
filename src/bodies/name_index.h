// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"

namespace hgrid {

/// Finds bodies by name or by glob without visiting every body. A glob is compared only with the names that start with
/// the text before its first `*`. The list of bodies must outlive the index.
class NameIndex {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  explicit NameIndex(const BodyList& bodies);
  explicit NameIndex(BodyList&&) = delete;  // a temporary list would not outlive the index
  /// Creates an index that finds only some of the bodies. @param chosen  indices of these bodies
  NameIndex(const BodyList& bodies, std::vector<std::uint32_t> chosen);

  /// Returns the index of the body with this name, or kNone.
  std::uint32_t find(const std::string& name) const;
  /// Replaces `found` with the indices of the bodies whose names match the glob, in the order of their names.
  void matching(const std::string& glob, std::vector<std::uint32_t>& found) const;
  /// Whether the glob matches the name of no body.
  bool matchesNone(const std::string& glob) const;

 private:
  using Iterator = std::vector<std::uint32_t>::const_iterator;
  /// Returns the place in order_ of the first body whose name is not less than `name`.
  Iterator from(const std::string& name) const;
  /// Returns the range in order_ of the bodies whose names start with the text of the glob before its first `*`.
  std::pair<Iterator, Iterator> candidates(const std::string& glob) const;

  const BodyList& bodies_;
  std::vector<std::uint32_t> order_;  // indices of the bodies, sorted by name
};

}  // namespace hgrid
