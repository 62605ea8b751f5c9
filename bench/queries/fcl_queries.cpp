// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <cmath>
#include <deque>

#include "bench/peers/fcl_box.h"
#include "bench/queries/exact.h"
#include "bench/queries/nearest_list.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {
namespace {

using Object = fcl::CollisionObject<double>;

ProxyId idOf(Object* object) { return static_cast<FclBox*>(object)->id(); }

/// FCL's tree. It finds the boxes that overlap the box around the query. The callback then tests them exactly.
class FclQueries final : public QueryPeer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    boxes_ = boxes;
    std::vector<Object*> objects;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      objects_.emplace_back(static_cast<ProxyId>(i), boxes[i]);
      objects.push_back(&objects_.back());
    }
    tree_.registerObjects(objects);
    tree_.setup();
  }

  bool answers(QueryKind) const override { return true; }

  void sphere(const Sphere& sphere, std::vector<ProxyId>& found) override {
    const double squared = sphere.radius * sphere.radius;
    const auto hit = [&](ProxyId id) { return squaredGap(boxes_[id], sphere.center) <= squared; };
    collide(around(sphere), hit, found);
  }
  void segment(const Segment& segment, std::vector<ProxyId>& found) override {
    const SlabTest test(segment);
    collide(
        around(segment), [&](ProxyId id) { return test.meets(boxes_[id]); }, found);
  }
  void box(const Aabb& box, std::vector<ProxyId>& found) override {
    collide(
        box, [](ProxyId) { return true; }, found);
  }

  void nearest(const Eigen::Vector3d& point, std::size_t k, std::vector<ProxyId>& found) override {
    const Eigen::Vector3f at = point.cast<float>();
    FclBox query(0, {at, at});
    Search search{this, point, {}};
    search.list.start(k);
    tree_.distance(&query, &search, [](Object* object, Object*, void* to, double& bound) {
      Search& search = *static_cast<Search*>(to);
      search.list.offer(squaredGap(search.peer->boxes_[idOf(object)], search.point), idOf(object));
      bound = std::sqrt(search.list.bound());
      return false;
    });
    search.list.write(found);
  }

 private:
  struct Search {
    const FclQueries* peer;
    Eigen::Vector3d point;
    NearestList list;
  };

  template <class Test>
  void collide(const Aabb& box, const Test& test, std::vector<ProxyId>& found) {
    struct Call {
      const Test* test;
      std::vector<ProxyId>* found;
    } call{&test, &found};
    FclBox query(0, box);
    found.clear();
    tree_.collide(&query, &call, [](Object* object, Object*, void* to) {
      const Call& call = *static_cast<Call*>(to);
      if ((*call.test)(idOf(object))) call.found->push_back(idOf(object));
      return false;
    });
  }

  std::vector<Aabb> boxes_;
  std::deque<FclBox> objects_;
  fcl::DynamicAABBTreeCollisionManager<double> tree_;
};

}  // namespace

std::unique_ptr<QueryPeer> makeFclQueries() { return std::make_unique<FclQueries>(); }

}  // namespace bench
}  // namespace hgrid
