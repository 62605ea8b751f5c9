// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The tree of Box3D, for all pairs and for single changes.
#include <box3d/collision.h>
#include <box3d/types.h>

#include <algorithm>

#include "bench/peers/factories.h"
#include "bench/singles/single_peer.h"

namespace hgrid {
namespace bench {
namespace {

/// By how much Box3D enlarges a box [m].
float marginOf(const Aabb& box) { return std::min(0.05f, 0.125f * (box.max - box.min).maxCoeff()); }

b3AABB toBox3d(const Aabb& box, float margin = 0.0f) {
  return {{box.min.x() - margin, box.min.y() - margin, box.min.z() - margin},
          {box.max.x() + margin, box.max.y() + margin, box.max.z() + margin}};
}

bool contains(const b3AABB& outer, const Aabb& box) {
  return outer.lowerBound.x <= box.min.x() && outer.lowerBound.y <= box.min.y() && outer.lowerBound.z <= box.min.z() &&
         box.max.x() <= outer.upperBound.x && box.max.y() <= outer.upperBound.y && box.max.z() <= outer.upperBound.z;
}

/// A tree that holds a proxy per box.
class Tree {
 public:
  Tree() = default;
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
  ~Tree() { clear(); }

  /// @param enlarged  whether the tree gets larger boxes
  void load(const std::vector<Aabb>& boxes, bool enlarged) {
    clear();
    tree_ = b3DynamicTree_Create(static_cast<int>(boxes.size()));
    for (std::size_t i = 0; i < boxes.size(); ++i)
      proxies_.push_back(
          b3DynamicTree_CreateProxy(&tree_, toBox3d(boxes[i], enlarged ? marginOf(boxes[i]) : 0.0f), 1, i));
    b3DynamicTree_Rebuild(&tree_, true);
  }
  void move(ProxyId id, const Aabb& box) { b3DynamicTree_MoveProxy(&tree_, proxies_[id], toBox3d(box)); }
  void replace(ProxyId id, const Aabb& box) {
    b3DynamicTree_DestroyProxy(&tree_, proxies_[id]);
    proxies_[id] = b3DynamicTree_CreateProxy(&tree_, toBox3d(box), 1, id);
  }
  /// Enlarges the box of a proxy if the new box left it, as Box3D does in each step.
  void follow(ProxyId id, const Aabb& box) {
    if (!contains(b3DynamicTree_GetAABB(&tree_, proxies_[id]), box))
      b3DynamicTree_EnlargeProxy(&tree_, proxies_[id], toBox3d(box, marginOf(box)));
  }
  void rebuild() { b3DynamicTree_Rebuild(&tree_, false); }
  template <class Visit>
  void query(const Aabb& box, Visit&& visit) const {
    b3DynamicTree_Query(
        &tree_, toBox3d(box), 1, false,
        [](int, std::uint64_t id, void* context) {
          (*static_cast<Visit*>(context))(static_cast<ProxyId>(id));
          return true;
        },
        &visit);
  }
  std::size_t bytes() const { return static_cast<std::size_t>(b3DynamicTree_GetByteCount(&tree_)); }

 private:
  void clear() {
    if (!proxies_.empty()) b3DynamicTree_Destroy(&tree_);
    proxies_.clear();
  }

  b3DynamicTree tree_{};
  std::vector<int> proxies_;
};

/// Works like a step of Box3D: proxies are larger than their boxes, the tree is rebuilt where boxes left them, and each
/// box queries the tree.
class Box3dPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>& boxes) override { tree_.load(boxes, true); }
  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    for (std::size_t i = 0; i < frame.moved.size(); ++i) tree_.follow(frame.moved[i], frame.moved_boxes[i]);
    tree_.rebuild();
    pairs.clear();
    for (ProxyId id = 0; id < frame.boxes.size(); ++id) {
      tree_.query(frame.boxes[id], [&](ProxyId other) {
        if (id < other && overlap(frame.boxes[id], frame.boxes[other])) pairs.push_back({id, other});
      });
    }
  }
  std::size_t bytes() const override { return tree_.bytes(); }

 private:
  Tree tree_;
};

class Box3dSingles final : public SinglePeer {
 public:
  void load(const std::vector<Aabb>& boxes) override { tree_.load(boxes, false); }
  void update(ProxyId id, const Aabb& box) override { tree_.move(id, box); }
  void replace(ProxyId id, const Aabb& box) override { tree_.replace(id, box); }
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) override {
    found.clear();
    tree_.query(box, [&](ProxyId id) { found.push_back(id); });
  }

 private:
  Tree tree_;
};

}  // namespace

std::unique_ptr<Peer> makeBox3d() { return std::make_unique<Box3dPeer>(); }
std::unique_ptr<SinglePeer> makeBox3dSingles() { return std::make_unique<Box3dSingles>(); }

}  // namespace bench
}  // namespace hgrid
