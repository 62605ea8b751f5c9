// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Answer.h>
#include <hgrid_proximity/ApplyObstacles.h>
#include <hgrid_proximity/ApplyRobots.h>
#include <hgrid_proximity/ExplainPair.h>
#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QueryShape.h>
#include <hgrid_proximity/QuerySphere.h>
#include <hgrid_proximity/Verdict.h>
#include <hgrid_proximity/WorldState.h>
#include <hgrid_proximity/client/errors.h>
#include <hgrid_proximity/client/service.h>
#include <ros/time.h>

#include <algorithm>
#include <chrono>
#include <string>

namespace hgrid_proximity {

/// Returns whether the verdict is CLEAR: nothing is there; for query_nearest: nothing is within max_distance. If
/// isClear() and isHit() are both false, something may be there unseen: treat the place as occupied.
inline bool isClear(const Answer& answer) { return answer.success && answer.verdict == Verdict::CLEAR; }
/// Returns whether the verdict is HIT; `hits` lists the bodies.
inline bool isHit(const Answer& answer) { return answer.success && answer.verdict == Verdict::HIT; }
/// Returns whether a message with this WorldState is complete and still valid. True: every pair that ~pairs does not
/// list is farther apart than its margin. False: it may be near.
inline bool isUsable(const WorldState& world) {
  const ros::Time now = ros::Time::now();
  return world.complete && !now.isZero() && now <= world.valid_until;
}

/// Asks a running proximity node. Header-only; needs roscpp and the messages of this package, but not its libraries.
///
/// ```
/// hgrid_proximity::Client proximity;
/// hgrid_proximity::QuerySphereRequest sphere;
/// sphere.center.z = 0.9;  // [m]
/// sphere.radius = 0.4;    // [m]
/// if (isClear(proximity.ask(sphere).answer)) ...
/// ```
///
/// Call ros::init() first. Answers need no spinner. Each kind of query has its own connection, which stays open, and
/// its own thread. Several threads may share an object; their requests of the same kind are answered one after the
/// other. `rossrv show -r hgrid_proximity/QuerySphere` explains the fields of a request. A `header.stamp` other than 0
/// asks about a time of the last ~history seconds.
class Client {
 public:
  /// @param node     name of the proximity node, resolved as usual
  /// @param timeout  how long to wait for an answer, or for a node that does not run yet; max_time of a query is added
  /// @throws std::invalid_argument unless the timeout is greater than 0 and at most 10^6 s
  explicit Client(const std::string& node = "proximity",
                  std::chrono::duration<double> timeout = std::chrono::seconds(5))
      : sphere_(node + "/query_sphere", timeout),
        segment_(node + "/query_segment", timeout),
        box_(node + "/query_box", timeout),
        shape_(node + "/query_shape", timeout),
        nearest_(node + "/query_nearest", timeout),
        explain_(node + "/explain_pair", timeout),
        obstacles_(node + "/apply_obstacles", timeout, false),
        robots_(node + "/apply_robots", timeout, false) {}

  ///@{
  /// Sends the request and waits for the response, which has `success = true`.
  /// @throws Refused if the node refuses the request or fails to answer it; NoAnswer if no answer comes in time
  QuerySphereResponse ask(const QuerySphereRequest& request) { return answered(sphere_, request); }
  QuerySegmentResponse ask(const QuerySegmentRequest& request) { return answered(segment_, request); }
  QueryBoxResponse ask(const QueryBoxRequest& request) { return answered(box_, request); }
  QueryShapeResponse ask(const QueryShapeRequest& request) { return answered(shape_, request); }
  QueryNearestResponse ask(const QueryNearestRequest& request) { return answered(nearest_, request); }
  ExplainPairResponse ask(const ExplainPairRequest& request) {
    ExplainPairResponse response = explain_.call(request);
    if (!response.success) throw Refused(response.code);
    return response;
  }
  ///@}

  /// Makes all changes of obstacles, in their order, or none of them. The response has the state of the world in the
  /// first tick with the changes.
  /// @param extra  how much longer than usual to wait, for example for many large meshes; at most 10^6 s
  /// @throws Refused if nothing was changed, or if the code is BUSY and the text says that the change was made
  /// @throws NoAnswer; then the changes may or may not have been made. MOVE and ATTACH can be repeated. REMOVE and
  /// DETACH are refused if they were made already, and ADD if the obstacle was moved or attached since.
  ApplyObstaclesResponse apply(const ApplyObstaclesRequest& request, std::chrono::duration<double> extra = {}) {
    ApplyObstaclesResponse response = obstacles_.call(request, extra);
    if (!response.success) throw Refused(response.code, response.failed_index);
    return response;
  }
  /// Makes all changes of robots, in their order, or none of them. The rest is as above, except that after NoAnswer all
  /// changes but REMOVE can be repeated.
  ApplyRobotsResponse apply(const ApplyRobotsRequest& request, std::chrono::duration<double> extra = {}) {
    ApplyRobotsResponse response = robots_.call(request, extra);
    if (!response.success) throw Refused(response.code, response.failed_index);
    return response;
  }

 private:
  template <class Kind>
  static typename Kind::Response answered(Service<Kind>& service, const typename Kind::Request& request) {
    const double extra = request.max_time > 0.0 ? std::min(request.max_time, 1e6) : 0.0;  // [s] it may be infinite
    typename Kind::Response response = service.call(request, std::chrono::duration<double>(extra));
    if (!response.answer.success) throw Refused(response.answer.code);
    return response;
  }

  Service<QuerySphere> sphere_;
  Service<QuerySegment> segment_;
  Service<QueryBox> box_;
  Service<QueryShape> shape_;
  Service<QueryNearest> nearest_;
  Service<ExplainPair> explain_;
  Service<ApplyObstacles> obstacles_;
  Service<ApplyRobots> robots_;
};

}  // namespace hgrid_proximity
