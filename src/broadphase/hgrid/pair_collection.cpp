// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Collects the pairs of a world that has more pairs than the bound.
#include <algorithm>

#include "broadphase/hgrid/engine.h"
#include "broadphase/hgrid/found_boxes.h"

namespace hgrid {
namespace {

/// Collects pairs in the order that PairBound specifies, until the next pair would exceed the bound.
class Collection {
 public:
  Collection(const PairBound& bound, const OverlapFilter& filter, std::vector<ProxyPair>& pairs)
      : bound_(bound), filter_(filter), pairs_(pairs) {}

  /// Returns whether pairs were left out.
  bool isCut() const { return cut_; }

  /// Applies the filter and the bound to the pairs of one box. The caller has appended these pairs from index `begin`
  /// on, in any order. If they exceed the bound, this function keeps the pairs that are first in the order of pairs.
  void take(std::size_t begin) {
    cutAt(begin + std::min(bound_.overlaps - overlaps_, pairs_.size() - begin), begin);
    overlaps_ += pairs_.size() - begin;
    ProxyPair* const first = pairs_.data();
    pairs_.resize(static_cast<std::size_t>(filter_(first + begin, first + pairs_.size()) - first));
    cutAt(bound_.pairs, begin);
  }

 private:
  /// If there are more than `most` pairs, keeps `most` of them: all pairs before index `begin`, and the smallest of the
  /// other pairs.
  void cutAt(std::size_t most, std::size_t begin) {
    if (pairs_.size() <= most) return;
    const auto from = pairs_.begin();
    std::nth_element(from + static_cast<std::ptrdiff_t>(begin), from + static_cast<std::ptrdiff_t>(most), pairs_.end());
    pairs_.resize(most);
    cut_ = true;
  }

  const PairBound& bound_;
  const OverlapFilter& filter_;
  std::vector<ProxyPair>& pairs_;
  std::size_t overlaps_ = 0;
  bool cut_ = false;
};

}  // namespace

// A pair of two boxes that are not fixed is found twice and taken once. So this function looks at no more overlaps than
// twice the bound plus the overlaps of one box.
bool HGrid::Engine::collectPairs(std::vector<ProxyPair>& pairs) const {
  pairs.clear();
  Collection collection(bound, filter, pairs);
  for (ProxyId id = 0; id < layer_of.size() && !collection.isCut(); ++id) {
    if (!isStored(id) || isFixed(id)) continue;
    const std::size_t begin = pairs.size();
    visitFound(*this, boxOf(boxes[id]), [&](const auto& found, const PositionWriter& places) {
      std::size_t count = pairs.size();
      pairs.resize(count + places.size());
      for (const std::uint32_t place : places) {
        const ProxyId other = found.idAt(place);
        pairs[count] = {std::min(id, other), std::max(id, other)};
        count += other > id || isFixed(other) ? 1 : 0;  // Store unconditionally: a branch would be mispredicted.
      }
      pairs.resize(count);
    });
    collection.take(begin);
  }
  return !collection.isCut();
}

}  // namespace hgrid
