// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <optional>

#include "bench/peers/embree_scene.h"
#include "bench/peers/factories.h"

namespace hgrid {
namespace bench {
namespace {

/// Embree's bounding volume hierarchy. In each frame, this peer rebuilds it at low quality and collides it with itself.
class EmbreePeer final : public Peer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    scene_.emplace(RTC_BUILD_QUALITY_LOW);
    scene_->attach(boxes.size());
  }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    scene_->build(frame.boxes);
    pairs.clear();
    Found found{&frame.boxes, &pairs};
    rtcCollide(scene_->scene(), scene_->scene(), take, &found);
  }

  std::size_t bytes() const override { return scene_->bytes(); }

 private:
  struct Found {
    const std::vector<Aabb>* boxes;
    std::vector<ProxyPair>* pairs;
  };

  /// Stores the candidate pairs that overlap. Embree reports each candidate in both orders; only one order is stored.
  static void take(void* to, RTCCollision* candidates, unsigned count) {
    const Found& found = *static_cast<Found*>(to);
    for (unsigned i = 0; i < count; ++i) {
      const ProxyId a = candidates[i].primID0, b = candidates[i].primID1;
      if (a < b && overlap((*found.boxes)[a], (*found.boxes)[b])) found.pairs->push_back({a, b});
    }
  }

  std::optional<EmbreeScene> scene_;
};

}  // namespace

std::unique_ptr<Peer> makeEmbree() { return std::make_unique<EmbreePeer>(); }

}  // namespace bench
}  // namespace hgrid
