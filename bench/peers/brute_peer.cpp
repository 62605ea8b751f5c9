// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/peers/factories.h"

namespace hgrid {
namespace bench {
namespace {

/// Same as hgrid::overlap, but without branches. A mispredicted branch costs more than the comparisons that it saves.
bool overlapping(const Aabb& a, const Aabb& b) {
  return (a.min.x() <= b.max.x()) & (b.min.x() <= a.max.x()) & (a.min.y() <= b.max.y()) & (b.min.y() <= a.max.y()) &
         (a.min.z() <= b.max.z()) & (b.min.z() <= a.max.z());
}

/// Compares each box with all later boxes. This is too simple to be wrong, so its pairs are the reference.
class BrutePeer final : public Peer {
 public:
  void load(const std::vector<Aabb>&) override {}
  bool remembers() const override { return false; }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    pairs.clear();
    const auto n = static_cast<ProxyId>(frame.boxes.size());
    for (ProxyId i = 0; i < n; ++i) {
      for (ProxyId j = i + 1; j < n; ++j) {
        if (overlapping(frame.boxes[i], frame.boxes[j])) pairs.push_back({i, j});
      }
    }
  }
};

}  // namespace

std::unique_ptr<Peer> makeBrute() { return std::make_unique<BrutePeer>(); }

}  // namespace bench
}  // namespace hgrid
