// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <unordered_map>
#include <vector>

#include "hgrid_proximity/scene/body.h"

namespace hgrid {

/// A candidate: two bodies whose boxes come within their margin.
struct NearPair {
  std::uint32_t first = 0;  ///< index into Structure::bodies, first < second
  std::uint32_t second = 0;
  double gap = 0.0;     ///< [m] least distance of their boxes
  double margin = 0.0;  ///< [m] margin that selected the pair, growth of stale bodies included
  Time since{0};        ///< stamp of the tick in which it was first seen without interruption
};

/// Remembers since when each pair is near. Bodies are known by their handles, so that a new numbering of
/// the bodies does not interrupt a pair.
class PairTracker {
 public:
  /// Fills `since` of every pair: kept where the pair was there in the last call, else `stamp`.
  /// @param ids  handle per body index
  void update(const std::vector<BodyId>& ids, Time stamp, std::vector<NearPair>& pairs);
  void clear() { since_.clear(); }

 private:
  struct Key {
    BodyId first, second;
    bool operator==(const Key& other) const { return first == other.first && second == other.second; }
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  std::unordered_map<Key, Time, KeyHash> since_, next_;
};

}  // namespace hgrid
