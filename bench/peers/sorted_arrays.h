// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <limits>
#include <vector>

#include "bench/peers/radix_sort.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// Boxes in the order of their min.x, as structure of arrays.
struct SortedArrays {
  static constexpr std::size_t kPad = 16;  ///< boxes beyond every other one at the end, for loads of eight

  std::vector<float> min_x, max_x, min_y, max_y, min_z, max_z;
  std::vector<ProxyId> id;

  void take(const std::vector<Aabb>& boxes) {
    const std::size_t n = boxes.size();
    if (id.size() != n) resize(n);
    std::vector<RadixSort::Item>& items = sort_.items();
    items.resize(n);
    for (std::size_t i = 0; i < n; ++i) items[i] = {sortable(boxes[i].min.x()), static_cast<std::uint32_t>(i)};
    const std::vector<RadixSort::Item>& order = sort_.sorted();
    for (std::size_t i = 0; i < n; ++i) {
      const Aabb& box = boxes[order[i].number];
      min_x[i] = box.min.x(), min_y[i] = box.min.y(), min_z[i] = box.min.z();
      max_x[i] = box.max.x(), max_y[i] = box.max.y(), max_z[i] = box.max.z();
      id[i] = order[i].number;
    }
  }

 private:
  void resize(std::size_t n) {
    for (std::vector<float>* array : {&min_x, &max_x, &min_y, &max_y, &min_z, &max_z})
      array->assign(n + kPad, std::numeric_limits<float>::infinity());
    id.resize(n);
  }

  RadixSort sort_;
};

}  // namespace bench
}  // namespace hgrid
