// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/peers/boost_tree.h"
#include "bench/queries/exact.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {
namespace {

namespace bgi = boost::geometry::index;

/// Boost's packed R-tree. For a sphere, this peer finds the boxes in the box around the sphere and tests them exactly.
class BoostQueries final : public QueryPeer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    boxes_ = boxes;
    tree_ = BoostTree(boostValues(boxes));
  }

  bool answers(QueryKind) const override { return true; }

  void sphere(const Sphere& sphere, std::vector<ProxyId>& found) override {
    const double squared = sphere.radius * sphere.radius;
    query(bgi::intersects(toBoost(around(sphere))), found,
          [&](ProxyId id) { return squaredGap(boxes_[id], sphere.center) <= squared; });
  }
  void segment(const Segment& segment, std::vector<ProxyId>& found) override {
    using BoostSegment = boost::geometry::model::segment<BoostPoint>;
    const Eigen::Vector3f from = segment.from.cast<float>(), to = segment.to.cast<float>();
    query(bgi::intersects(BoostSegment(toBoost(from), toBoost(to))), found, [](ProxyId) { return true; });
  }
  void box(const Aabb& box, std::vector<ProxyId>& found) override {
    query(bgi::intersects(toBoost(box)), found, [](ProxyId) { return true; });
  }
  void nearest(const Eigen::Vector3d& point, std::size_t k, std::vector<ProxyId>& found) override {
    const Eigen::Vector3f at = point.cast<float>();
    query(bgi::nearest(toBoost(at), static_cast<unsigned>(k)), found, [](ProxyId) { return true; });
  }

 private:
  template <class Predicate, class Test>
  void query(const Predicate& predicate, std::vector<ProxyId>& found, const Test& test) {
    found.clear();
    auto take = [&](ProxyId id) {
      if (test(id)) found.push_back(id);
    };
    tree_.query(predicate, BoostHits<decltype(take)>(take));
  }

  std::vector<Aabb> boxes_;
  BoostTree tree_;
};

}  // namespace

std::unique_ptr<QueryPeer> makeBoostQueries() { return std::make_unique<BoostQueries>(); }

}  // namespace bench
}  // namespace hgrid
