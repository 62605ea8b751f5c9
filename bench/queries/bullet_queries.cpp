// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "bench/queries/exact.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {
namespace {

btVector3 toBullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

btDbvtVolume toBullet(const Aabb& box) {
  return btDbvtVolume::FromMM(toBullet(Eigen::Vector3d(box.min.cast<double>())),
                              toBullet(Eigen::Vector3d(box.max.cast<double>())));
}

/// Bullet's tree, built top-down. This peer exactly tests the boxes of the leaves that Bullet finds.
class BulletQueries final : public QueryPeer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    boxes_ = boxes;
    for (std::size_t i = 0; i < boxes.size(); ++i) tree_.insert(toBullet(boxes[i]), reinterpret_cast<void*>(i));
    tree_.optimizeTopDown();
  }

  bool answers(QueryKind kind) const override { return kind != QueryKind::nearest && kind != QueryKind::nearest8; }

  void sphere(const Sphere& sphere, std::vector<ProxyId>& found) override {
    const double squared = sphere.radius * sphere.radius;
    const auto hit = [&](ProxyId id) { return squaredGap(boxes_[id], sphere.center) <= squared; };
    collide(around(sphere), hit, found);
  }
  void box(const Aabb& box, std::vector<ProxyId>& found) override {
    collide(
        box, [](ProxyId) { return true; }, found);
  }
  void segment(const Segment& segment, std::vector<ProxyId>& found) override {
    const SlabTest test(segment);
    const auto hit = [&](ProxyId id) { return test.meets(boxes_[id]); };
    Leaves<decltype(hit)> leaves(hit, found);
    const Eigen::Vector3d step = segment.to - segment.from;
    const btVector3 inverse = toBullet(Eigen::Vector3d(step.normalized().cwiseInverse()));
    unsigned signs[3];
    for (int axis = 0; axis < 3; ++axis) signs[axis] = inverse[axis] < 0;
    tree_.rayTestInternal(tree_.m_root, toBullet(segment.from), toBullet(segment.to), inverse, signs,
                          static_cast<btScalar>(step.norm()), btVector3(0, 0, 0), btVector3(0, 0, 0), stack_, leaves);
  }

 private:
  template <class Test>
  struct Leaves : btDbvt::ICollide {
    Leaves(const Test& test, std::vector<ProxyId>& found) : test(&test), found(&found) { found.clear(); }
    void Process(const btDbvtNode* leaf) {
      const auto id = static_cast<ProxyId>(reinterpret_cast<std::uintptr_t>(leaf->data));
      if ((*test)(id)) found->push_back(id);
    }
    const Test* test;
    std::vector<ProxyId>* found;
  };

  template <class Test>
  void collide(const Aabb& box, const Test& test, std::vector<ProxyId>& found) {
    Leaves<Test> leaves(test, found);
    tree_.collideTVNoStackAlloc(tree_.m_root, toBullet(box), stack_, leaves);
  }

  std::vector<Aabb> boxes_;
  btDbvt tree_;
  btAlignedObjectArray<const btDbvtNode*> stack_;
};

}  // namespace

std::unique_ptr<QueryPeer> makeBulletQueries() { return std::make_unique<BulletQueries>(); }

}  // namespace bench
}  // namespace hgrid
