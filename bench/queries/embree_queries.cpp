// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>
#include <optional>

#include "bench/peers/embree_scene.h"
#include "bench/queries/exact.h"
#include "bench/queries/nearest_list.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {
namespace {

/// Embree in its robust mode. Sphere and nearest queries use Embree's point queries. Segment queries use rays, which
/// collect every box on their way.
class EmbreeQueries final : public QueryPeer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    boxes_ = boxes;
    slack_ = doubtOf(boxes);
    scene_.emplace(RTC_BUILD_QUALITY_MEDIUM);
    rtcSetGeometryIntersectFunction(scene_->geometry(), takeMet);
    scene_->attach(boxes.size());
    scene_->build(boxes_);
  }

  bool answers(QueryKind kind) const override { return kind != QueryKind::box; }

  void sphere(const Sphere& sphere, std::vector<ProxyId>& found) override {
    found.clear();
    BallQuery query{this, &sphere, &found};
    ask(sphere.center, sphere.radius + slack_, takeTouched, &query);
  }

  void nearest(const Eigen::Vector3d& point, std::size_t k, std::vector<ProxyId>& found) override {
    NearestQuery query{this, &point, {}};
    query.list.start(k);
    ask(point, std::numeric_limits<double>::infinity(), takeNear, &query);
    query.list.write(found);
  }

  void segment(const Segment& segment, std::vector<ProxyId>& found) override {
    found.clear();
    const SlabTest test(segment);
    SegmentQuery query{{}, this, &test, &found};
    rtcInitIntersectContext(&query.context);
    const Eigen::Vector3f from = segment.from.cast<float>(), step = (segment.to - segment.from).cast<float>();
    RTCRayHit ray{};
    ray.ray.org_x = from.x(), ray.ray.org_y = from.y(), ray.ray.org_z = from.z();
    ray.ray.dir_x = step.x(), ray.ray.dir_y = step.y(), ray.ray.dir_z = step.z();
    ray.ray.tfar = 1.f;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_->scene(), &query.context, &ray);
  }

 private:
  struct BallQuery {
    const EmbreeQueries* peer;
    const Sphere* sphere;
    std::vector<ProxyId>* found;
  };
  struct NearestQuery {
    const EmbreeQueries* peer;
    const Eigen::Vector3d* point;
    NearestList list;
  };
  struct SegmentQuery {
    RTCIntersectContext context;  // first member, because Embree passes back a pointer to it
    const EmbreeQueries* peer;
    const SlabTest* test;
    std::vector<ProxyId>* found;
  };

  void ask(const Eigen::Vector3d& point, double radius, RTCPointQueryFunction function, void* query) {
    RTCPointQuery ball{};
    ball.x = static_cast<float>(point.x());
    ball.y = static_cast<float>(point.y());
    ball.z = static_cast<float>(point.z());
    ball.radius = static_cast<float>(radius);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_->scene(), &ball, &context, function, query);
  }

  static bool takeTouched(RTCPointQueryFunctionArguments* arguments) {
    const BallQuery& query = *static_cast<BallQuery*>(arguments->userPtr);
    const double squared = squaredGap(query.peer->boxes_[arguments->primID], query.sphere->center);
    if (squared <= query.sphere->radius * query.sphere->radius) query.found->push_back(arguments->primID);
    return false;
  }

  static bool takeNear(RTCPointQueryFunctionArguments* arguments) {
    NearestQuery& query = *static_cast<NearestQuery*>(arguments->userPtr);
    const double before = query.list.bound();
    query.list.offer(squaredGap(query.peer->boxes_[arguments->primID], *query.point), arguments->primID);
    if (query.list.bound() == before) return false;
    arguments->query->radius = static_cast<float>(std::sqrt(query.list.bound()) + query.peer->slack_);
    return true;  // tells Embree that the radius of the search has changed
  }

  /// Stores the box, but reports no hit to Embree. Thus the ray continues to its end.
  static void takeMet(const RTCIntersectFunctionNArguments* arguments) {
    const SegmentQuery& query = *reinterpret_cast<const SegmentQuery*>(arguments->context);
    if (query.test->meets(query.peer->boxes_[arguments->primID])) query.found->push_back(arguments->primID);
  }

  std::vector<Aabb> boxes_;
  double slack_ = 0.0;  // [m] added to all radii, so that Embree's float rounding loses no box
  std::optional<EmbreeScene> scene_;
};

}  // namespace

std::unique_ptr<QueryPeer> makeEmbreeQueries() { return std::make_unique<EmbreeQueries>(); }

}  // namespace bench
}  // namespace hgrid
