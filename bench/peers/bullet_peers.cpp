// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include "bench/peers/factories.h"

namespace hgrid {
namespace bench {
namespace {

btVector3 toBullet(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

ProxyId idOf(const btBroadphaseProxy* proxy) {
  return static_cast<ProxyId>(reinterpret_cast<std::uintptr_t>(proxy->m_clientObject));
}

/// Bullet's broad phases enlarge the boxes and keep the list of pairs from frame to frame. When this class reads the
/// list, it drops pairs whose exact boxes do not overlap.
class BulletPeer : public Peer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    broad_phase_ = makeBroadPhase(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      void* const id = reinterpret_cast<void*>(static_cast<std::uintptr_t>(i));
      const btVector3 low = toBullet(boxes[i].min), high = toBullet(boxes[i].max);
      proxies_.push_back(broad_phase_->createProxy(low, high, 0, id, 1, 1, nullptr));
    }
  }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    for (std::size_t i = 0; i < frame.moved.size(); ++i) {
      const Aabb& box = frame.moved_boxes[i];
      broad_phase_->setAabb(proxies_[frame.moved[i]], toBullet(box.min), toBullet(box.max), nullptr);
    }
    broad_phase_->calculateOverlappingPairs(nullptr);
    pairs.clear();
    const btBroadphasePairArray& kept = broad_phase_->getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < kept.size(); ++i) {
      const ProxyId a = idOf(kept[i].m_pProxy0), b = idOf(kept[i].m_pProxy1);
      if (overlap(frame.boxes[a], frame.boxes[b])) pairs.push_back(ordered(a, b));
    }
  }

 protected:
  virtual std::unique_ptr<btBroadphaseInterface> makeBroadPhase(const std::vector<Aabb>& boxes) const = 0;

 private:
  std::unique_ptr<btBroadphaseInterface> broad_phase_;
  std::vector<btBroadphaseProxy*> proxies_;
};

class DbvtPeer final : public BulletPeer {
  std::unique_ptr<btBroadphaseInterface> makeBroadPhase(const std::vector<Aabb>&) const override {
    auto dbvt = std::make_unique<btDbvtBroadphase>();
    dbvt->m_deferedcollide = true;  // tests all boxes once per frame, which is faster than testing in each setAabb()
    return dbvt;
  }
};

class AxisSweepPeer final : public BulletPeer {
  std::unique_ptr<btBroadphaseInterface> makeBroadPhase(const std::vector<Aabb>& boxes) const override {
    Eigen::Vector3f low = boxes.front().min, high = boxes.front().max;
    for (const Aabb& box : boxes) {
      low = low.cwiseMin(box.min);
      high = high.cwiseMax(box.max);
    }
    const Eigen::Vector3f room = Eigen::Vector3f::Ones();
    return std::make_unique<btAxisSweep3>(toBullet(low - room), toBullet(high + room),
                                          static_cast<unsigned short>(boxes.size() + 1), nullptr, true);
  }
};

}  // namespace

std::unique_ptr<Peer> makeBulletDbvt() { return std::make_unique<DbvtPeer>(); }
std::unique_ptr<Peer> makeBulletAxisSweep() { return std::make_unique<AxisSweepPeer>(); }

}  // namespace bench
}  // namespace hgrid
