// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "test/support/grids.h"
#include "test/support/sweep.h"

namespace hgrid {
namespace test {

/// Returns the ids 0 .. count - 1.
inline std::vector<ProxyId> allIds(std::size_t count) {
  std::vector<ProxyId> ids;
  for (ProxyId id = 0; id < count; ++id) ids.push_back(id);
  return ids;
}

/// Expects that the broad phase stores exactly the boxes with these ids. Compares its pairs with those of
/// sweptOverlaps(), and the answers of a few queries with those of a scan of all boxes.
/// @param fixed  whether the box with this id is fixed, by id; boxes with greater ids are not fixed
inline void expectRight(const BroadPhaseReader& broad_phase, const std::vector<Aabb>& boxes,
                        const std::vector<ProxyId>& ids, const std::vector<bool>& fixed = {}) {
  ASSERT_EQ(broad_phase.size(), ids.size());
  ASSERT_NO_THROW(broad_phase.checkInvariants());
  Pairs expected = sweptOverlaps(boxes, ids);
  const auto isFixed = [&](ProxyId id) { return id < fixed.size() && fixed[id]; };
  expected.erase(std::remove_if(expected.begin(), expected.end(),
                                [&](const auto& pair) { return isFixed(pair.first) && isFixed(pair.second); }),
                 expected.end());
  ASSERT_TRUE(pairsOf(broad_phase) == expected);
  for (std::size_t i = 0; i < ids.size(); i += 1 + ids.size() / 10) {
    const Aabb& query = boxes[ids[i]];
    std::vector<ProxyId> found;
    for (const ProxyId id : ids) {
      if (oracleOverlap(query, boxes[id])) found.push_back(id);
    }
    ASSERT_EQ(foundBy(broad_phase, query), found);
  }
}

inline void expectRight(const BroadPhaseReader& broad_phase, const std::vector<Aabb>& boxes) {
  expectRight(broad_phase, boxes, allIds(boxes.size()));
}

}  // namespace test
}  // namespace hgrid
