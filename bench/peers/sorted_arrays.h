// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <limits>
#include <vector>

#include "bench/peers/radix_sort.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// Boxes sorted by their minimum along one axis, stored as a structure of arrays.
struct SortedArrays {
  static constexpr std::size_t kPad = 16;  ///< boxes at infinity after the last one, for SIMD loads of eight boxes

  std::vector<float> min[3], max[3];  ///< [0]: along the sort axis; [1], [2]: along the other axes
  std::vector<ProxyId> id;

  /// Replaces the contents with `boxes`, sorted along `axis`. The id of a box is its index in `boxes`.
  void take(const std::vector<Aabb>& boxes, int axis) {
    const std::size_t n = boxes.size();
    if (id.size() != n) resize(n);
    std::vector<RadixSort::Item>& items = sort_.items();
    items.resize(n);
    for (std::size_t i = 0; i < n; ++i) items[i] = {sortable(boxes[i].min[axis]), static_cast<std::uint32_t>(i)};
    const std::vector<RadixSort::Item>& order = sort_.sorted();
    const int axes[3] = {axis, (axis + 1) % 3, (axis + 2) % 3};
    for (std::size_t i = 0; i < n; ++i) {
      const Aabb& box = boxes[order[i].number];
      for (int k = 0; k < 3; ++k) {
        min[k][i] = box.min[axes[k]];
        max[k][i] = box.max[axes[k]];
      }
      id[i] = order[i].number;
    }
  }

 private:
  void resize(std::size_t n) {
    for (int k = 0; k < 3; ++k) {
      min[k].assign(n + kPad, std::numeric_limits<float>::infinity());
      max[k].assign(n + kPad, std::numeric_limits<float>::infinity());
    }
    id.resize(n);
  }

  RadixSort sort_;
};

}  // namespace bench
}  // namespace hgrid
