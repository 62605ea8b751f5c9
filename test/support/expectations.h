// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "test/support/grids.h"
#include "test/support/sweep.h"

namespace hgrid {
namespace test {

/// The ids of boxes that stand in an array by id.
inline std::vector<ProxyId> allIds(std::size_t count) {
  std::vector<ProxyId> ids;
  for (ProxyId id = 0; id < count; ++id) ids.push_back(id);
  return ids;
}

/// The broad phase holds exactly the boxes of these ids: its pairs are those of a sweep, and a few queries those of a
/// scan.
/// @param fixed  by id; may be shorter
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
