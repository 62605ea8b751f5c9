// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Answer.h>
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
#include <ros/node_handle.h>
#include <ros/time.h>

#include <algorithm>
#include <chrono>
#include <string>

namespace hgrid_proximity {

/// Whether nothing is there. If neither isClear() nor isHit(), something may be there unseen: treat it as occupied.
inline bool isClear(const Answer& answer) { return answer.success && answer.verdict == Verdict::CLEAR; }
/// Whether a body was hit; `hits` lists the bodies.
inline bool isHit(const Answer& answer) { return answer.success && answer.verdict == Verdict::HIT; }
/// Whether a message with this WorldState is complete and still valid. Only then is a pair that ~pairs does not list
/// not near.
inline bool isUsable(const WorldState& world) { return world.complete && ros::Time::now() <= world.valid_until; }

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
/// Each kind of question has its own connection, which stays open. Several threads may share an object; their questions
/// of the same kind run one after the other. The services describe the fields of the requests: `rossrv show -r`.
class Client {
 public:
  /// @param node     name of the proximity node, resolved as usual
  /// @param timeout  longest time for connecting, and for an answer; max_time of a query is added to it
  explicit Client(const std::string& node = "proximity",
                  std::chrono::duration<double> timeout = std::chrono::seconds(5))
      : sphere_(ros::NodeHandle(), node + "/query_sphere", timeout),
        segment_(ros::NodeHandle(), node + "/query_segment", timeout),
        box_(ros::NodeHandle(), node + "/query_box", timeout),
        shape_(ros::NodeHandle(), node + "/query_shape", timeout),
        nearest_(ros::NodeHandle(), node + "/query_nearest", timeout),
        explain_(ros::NodeHandle(), node + "/explain_pair", timeout) {}

  /// Asks. A response that is returned has `success = true`.
  /// @throws Refused if the node refuses the question or fails to answer it; NoAnswer if no answer comes
  QuerySphereResponse ask(const QuerySphereRequest& question) { return answered(sphere_, question); }
  QuerySegmentResponse ask(const QuerySegmentRequest& question) { return answered(segment_, question); }
  QueryBoxResponse ask(const QueryBoxRequest& question) { return answered(box_, question); }
  QueryShapeResponse ask(const QueryShapeRequest& question) { return answered(shape_, question); }
  QueryNearestResponse ask(const QueryNearestRequest& question) { return answered(nearest_, question); }
  ExplainPairResponse ask(const ExplainPairRequest& question) {
    ExplainPairResponse response = explain_.call(question);
    if (!response.success) throw Refused(response.code);
    return response;
  }

 private:
  template <class Kind>
  static typename Kind::Response answered(Service<Kind>& service, const typename Kind::Request& question) {
    const double extra = question.max_time > 0.0 ? std::min(question.max_time, 1e6) : 0.0;  // [s] it may be infinite
    typename Kind::Response response = service.call(question, std::chrono::duration<double>(extra));
    if (!response.answer.success) throw Refused(response.answer.code);
    return response;
  }

  Service<QuerySphere> sphere_;
  Service<QuerySegment> segment_;
  Service<QueryBox> box_;
  Service<QueryShape> shape_;
  Service<QueryNearest> nearest_;
  Service<ExplainPair> explain_;
};

}  // namespace hgrid_proximity
