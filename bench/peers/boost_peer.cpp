// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/peers/boost_tree.h"
#include "bench/peers/factories.h"

namespace hgrid {
namespace bench {
namespace {

/// Boost's R-tree. In each frame, this peer builds a new packed tree and queries it once per box.
class BoostPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>&) override {}
  bool remembers() const override { return false; }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    tree_ = BoostTree(boostValues(frame.boxes));
    pairs.clear();
    for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
      const auto mine = static_cast<ProxyId>(i);
      auto take = [&](ProxyId other) {
        if (mine < other) pairs.push_back({mine, other});
      };
      tree_.query(boost::geometry::index::intersects(toBoost(frame.boxes[i])), BoostHits<decltype(take)>(take));
    }
  }

 private:
  BoostTree tree_;
};

}  // namespace

std::unique_ptr<Peer> makeBoostRtree() { return std::make_unique<BoostPeer>(); }

}  // namespace bench
}  // namespace hgrid
