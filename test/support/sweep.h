// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <vector>

#include "test/support/worlds.h"

namespace hgrid {
namespace test {

/// Returns all pairs of overlapping boxes with these ids. Sorts the boxes by their minimum x. Compares each box only
/// with later boxes that begin before it ends. Use it for worlds that are too large for allOverlaps().
inline Pairs sweptOverlaps(const std::vector<Aabb>& boxes, std::vector<std::uint32_t> ids) {
  std::sort(ids.begin(), ids.end(), [&](std::uint32_t a, std::uint32_t b) {
    return boxes[a].min.x() != boxes[b].min.x() ? boxes[a].min.x() < boxes[b].min.x() : a < b;
  });
  Pairs pairs;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Aabb& box = boxes[ids[i]];
    for (std::size_t j = i + 1; j < ids.size() && boxes[ids[j]].min.x() <= box.max.x(); ++j) {
      if (oracleOverlap(box, boxes[ids[j]])) pairs.emplace_back(std::min(ids[i], ids[j]), std::max(ids[i], ids[j]));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

inline Pairs sweptOverlaps(const std::vector<Aabb>& boxes) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 0; id < boxes.size(); ++id) ids.push_back(id);
  return sweptOverlaps(boxes, std::move(ids));
}

}  // namespace test
}  // namespace hgrid
