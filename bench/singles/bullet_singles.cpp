// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "bench/singles/single_peer.h"

namespace hgrid {
namespace bench {
namespace {

btDbvtVolume toBullet(const Aabb& box) {
  return btDbvtVolume::FromMM({box.min.x(), box.min.y(), box.min.z()}, {box.max.x(), box.max.y(), box.max.z()});
}

/// Bullet's tree with exact boxes, without the margin of its broad phase: a leaf whose box changed is put in anew.
class BulletSingles final : public SinglePeer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    tree_.clear();
    leaves_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) leaves_.push_back(tree_.insert(toBullet(boxes[i]), dataOf(i)));
    tree_.optimizeTopDown();
  }
  void update(ProxyId id, const Aabb& box) override {
    btDbvtVolume volume = toBullet(box);
    tree_.update(leaves_[id], volume);
  }
  void replace(ProxyId id, const Aabb& box) override {
    tree_.remove(leaves_[id]);
    leaves_[id] = tree_.insert(toBullet(box), dataOf(id));
  }
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) override {
    Found found_leaves(found);
    tree_.collideTVNoStackAlloc(tree_.m_root, toBullet(box), stack_, found_leaves);
  }

 private:
  static void* dataOf(std::size_t id) { return reinterpret_cast<void*>(id); }

  struct Found : btDbvt::ICollide {
    explicit Found(std::vector<ProxyId>& found) : found(&found) { found.clear(); }
    void Process(const btDbvtNode* leaf) {
      found->push_back(static_cast<ProxyId>(reinterpret_cast<std::uintptr_t>(leaf->data)));
    }
    std::vector<ProxyId>* found;
  };

  btDbvt tree_;
  std::vector<btDbvtNode*> leaves_;
  btAlignedObjectArray<const btDbvtNode*> stack_;
};

}  // namespace

std::unique_ptr<SinglePeer> makeBulletSingles() { return std::make_unique<BulletSingles>(); }

}  // namespace bench
}  // namespace hgrid
