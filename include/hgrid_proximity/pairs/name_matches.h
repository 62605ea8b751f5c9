// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace hgrid {

/// Says which names match which globs of the allowed-pair rules. PairFilter::match() makes it, on any thread, before
/// bodies with these names are added. PairFilter::forBodies() then need not compare the names with the globs.
struct NameMatches {
  /// The `first` and the `second` of each rule that contains a glob, in the order of the rules. Both are empty where
  /// PairFilter::without() left a rule out.
  using Globs = std::vector<std::pair<std::string, std::string>>;

  Globs globs;                     ///< the globs that were compared with the names
  std::vector<std::string> names;  ///< sorted, each name once
  /// For each name, (globs.size() + 63) / 64 words. Bit k: globs[k].first matches the name.
  std::vector<std::uint64_t> as_first;
  /// Like as_first. Bit k: globs[k].second matches the name.
  std::vector<std::uint64_t> as_second;
};

}  // namespace hgrid
