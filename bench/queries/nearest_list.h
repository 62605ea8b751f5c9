// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// The k nearest boxes found so far. Peers use it when they search a tree with a bound that shrinks.
class NearestList {
 public:
  void start(std::size_t k) {
    k_ = k;
    heap_.clear();
  }
  void offer(double squared_distance, ProxyId id) {
    if (squared_distance >= bound()) return;
    if (heap_.size() == k_) {
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
    }
    heap_.emplace_back(squared_distance, id);
    std::push_heap(heap_.begin(), heap_.end());
  }
  /// Returns the squared distance below which a box is added to the list.
  double bound() const { return heap_.size() < k_ ? std::numeric_limits<double>::infinity() : heap_.front().first; }
  void write(std::vector<ProxyId>& found) const {
    found.clear();
    for (const auto& [distance, id] : heap_) found.push_back(id);
  }

 private:
  std::size_t k_ = 1;
  std::vector<std::pair<double, ProxyId>> heap_;
};

}  // namespace bench
}  // namespace hgrid
