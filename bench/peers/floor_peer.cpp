// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/peers/factories.h"
#include "bench/peers/sorted_arrays.h"

namespace hgrid {
namespace bench {
namespace {

/// The minimum work of a broad phase that rebuilds in each frame: reads the boxes, sorts them once by a 32-bit key,
/// copies them to sorted arrays, and writes n pairs. These pairs have no meaning.
class FloorPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>&) override {}
  bool remembers() const override { return false; }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    arrays_.take(frame.boxes, 0);
    pairs.resize(frame.boxes.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {arrays_.id[i], static_cast<ProxyId>(i)};
  }

 private:
  SortedArrays arrays_;
};

}  // namespace

std::unique_ptr<Peer> makeFloor() { return std::make_unique<FloorPeer>(); }

}  // namespace bench
}  // namespace hgrid
