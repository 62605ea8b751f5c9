// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// All that the benchmark knows of HGrid's pairs.
#include "bench/peers/hgrid_peer.h"

#include <numeric>
#include <optional>

#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {
namespace bench {
namespace {

class HGridPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    grid_.emplace(GridScale::fitting(boxes));
    ids_.resize(boxes.size());
    std::iota(ids_.begin(), ids_.end(), 0);
    grid_->update(ids_, boxes);
  }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    grid_->update(ids_, frame.boxes);
    grid_->overlappingPairs(pairs);
  }

 private:
  std::optional<HGrid> grid_;
  std::vector<ProxyId> ids_;
};

}  // namespace

std::vector<std::string> hgridInstructions() { return {"sse2"}; }

std::unique_ptr<Peer> makeHGrid(int /*threads*/, const std::string& /*instructions*/) {
  return std::make_unique<HGridPeer>();
}

}  // namespace bench
}  // namespace hgrid
