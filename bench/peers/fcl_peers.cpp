// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_spatialhash.h>

#include <deque>

#include "bench/peers/factories.h"
#include "bench/peers/fcl_box.h"

namespace hgrid {
namespace bench {
namespace {

using Object = fcl::CollisionObject<double>;
using Manager = fcl::BroadPhaseCollisionManager<double>;

std::unique_ptr<fcl::SpatialHashingCollisionManager<double>> spatialHash(std::vector<Object*>& objects) {
  Eigen::Vector3d low, high;
  fcl::SpatialHashingCollisionManager<double>::computeBound(objects, low, high);
  double edges = 0.0;
  for (const Object* object : objects) edges += (object->getAABB().max_ - object->getAABB().min_).maxCoeff();
  const double cell = 2.0 * edges / static_cast<double>(objects.size());
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(cell);
  return std::make_unique<fcl::SpatialHashingCollisionManager<double>>(cell, low - margin, high + margin,
                                                                       static_cast<unsigned>(objects.size()));
}

/// FCL's managers, used as most users of FCL do. All objects are registered at once. Each frame calls update(), either
/// for all objects or for those that moved. Then it calls collide(), which tests the objects with each other.
class FclPeer : public Peer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes_.emplace_back(static_cast<ProxyId>(i), boxes[i]);
    std::vector<Object*> objects;
    for (FclBox& box : boxes_) objects.push_back(&box);
    manager_ = makeManager(objects);
    manager_->registerObjects(objects);
    manager_->setup();
  }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    moved_.clear();
    for (std::size_t i = 0; i < frame.moved.size(); ++i) {
      FclBox& box = boxes_[frame.moved[i]];
      box.setBox(frame.moved_boxes[i]);
      moved_.push_back(&box);
    }
    if (moved_.size() == boxes_.size()) {
      manager_->update();
    } else {
      manager_->update(moved_);
    }
    pairs.clear();
    manager_->collide(&pairs, [](Object* a, Object* b, void* found) {
      if (a->getAABB().overlap(b->getAABB())) {
        static_cast<std::vector<ProxyPair>*>(found)->push_back(
            ordered(static_cast<FclBox*>(a)->id(), static_cast<FclBox*>(b)->id()));
      }
      return false;
    });
  }

 protected:
  virtual std::unique_ptr<Manager> makeManager(std::vector<Object*>& objects) const = 0;

 private:
  std::deque<FclBox> boxes_;
  std::unique_ptr<Manager> manager_;
  std::vector<Object*> moved_;
};

template <class Kind>
class FclPeerOf final : public FclPeer {
  std::unique_ptr<Manager> makeManager(std::vector<Object*>&) const override { return std::make_unique<Kind>(); }
};

class FclSpatialHashPeer final : public FclPeer {
  std::unique_ptr<Manager> makeManager(std::vector<Object*>& objects) const override { return spatialHash(objects); }
};

template <class Kind>
std::unique_ptr<Peer> make() {
  return std::make_unique<FclPeerOf<Kind>>();
}

}  // namespace

std::unique_ptr<Peer> makeFclTree() { return make<fcl::DynamicAABBTreeCollisionManager<double>>(); }
std::unique_ptr<Peer> makeFclTreeArray() { return make<fcl::DynamicAABBTreeCollisionManager_Array<double>>(); }
std::unique_ptr<Peer> makeFclSaP() { return make<fcl::SaPCollisionManager<double>>(); }
std::unique_ptr<Peer> makeFclSSaP() { return make<fcl::SSaPCollisionManager<double>>(); }
std::unique_ptr<Peer> makeFclSpatialHash() { return std::make_unique<FclSpatialHashPeer>(); }

}  // namespace bench
}  // namespace hgrid
