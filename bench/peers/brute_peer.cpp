// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/peers/factories.h"

namespace hgrid {
namespace bench {
namespace {

/// Every box against every later one: nothing to go wrong, so it judges the others.
class BrutePeer final : public Peer {
 public:
  void load(const std::vector<Aabb>&) override {}
  bool remembers() const override { return false; }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    pairs.clear();
    const auto n = static_cast<ProxyId>(frame.boxes.size());
    for (ProxyId i = 0; i < n; ++i) {
      for (ProxyId j = i + 1; j < n; ++j) {
        if (overlap(frame.boxes[i], frame.boxes[j])) pairs.push_back({i, j});
      }
    }
  }
};

}  // namespace

std::unique_ptr<Peer> makeBrute() { return std::make_unique<BrutePeer>(); }

}  // namespace bench
}  // namespace hgrid
