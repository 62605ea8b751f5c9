// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Asks the running node from C++: sends two queries per second over persistent connections, and checks every message of
// ~pairs. Start it beside any launch file of this package: rosrun hgrid_proximity ask_node
// With _body:=robot/gripper it also asks which bodies are nearest to that body.
#include <hgrid_proximity/Answer.h>
#include <hgrid_proximity/Pairs.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QuerySphere.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/ros.h>

#include <string>

namespace {

using hgrid_proximity::Verdict;

/// A service with a connection that stays open. It connects again after a restart of the node.
template <class Service>
class Question {
 public:
  Question(ros::NodeHandle& node, const std::string& name) : node_(node), name_(name) {}

  /// Sends the query and prints the answer. Only CLEAR means that nothing is there.
  void ask(Service& service) {
    if (!client_.isValid()) client_ = node_.serviceClient<Service>(name_, true);  // true: persistent
    if (!client_.call(service)) {
      ROS_WARN("%s does not answer; that is not CLEAR", name_.c_str());
      return client_.shutdown();
    }
    const hgrid_proximity::Answer& answer = service.response.answer;
    if (!answer.success) {
      ROS_ERROR("refused with %s: %s", answer.code.name.c_str(), answer.code.text.c_str());
    } else if (answer.verdict == Verdict::UNKNOWN) {
      ROS_WARN("%s; treat it as occupied", answer.summary.c_str());
    } else {
      ROS_INFO("%s", answer.summary.c_str());
    }
    for (const hgrid_proximity::Hit& hit : answer.hits) ROS_INFO("  %s, %.3f m", hit.name.c_str(), hit.distance);
  }

 private:
  ros::NodeHandle node_;
  std::string name_;
  ros::ServiceClient client_;
};

/// Returns the question: which three bodies are nearest to this body?
hgrid_proximity::QueryNearest nearestTo(const std::string& body) {
  hgrid_proximity::QueryNearest nearest;
  nearest.request.body = body;
  nearest.request.limit = 3;
  nearest.request.exact = true;            // measures the shapes, not their boxes
  nearest.request.respect_allowed = true;  // leaves out what may touch the body, such as its neighbors at a joint
  return nearest;
}

/// Judges a message of ~pairs. "Nothing is near" requires a complete world and a message that is still valid.
void onPairs(const hgrid_proximity::Pairs& pairs) {
  const bool valid = ros::Time::now() <= pairs.world.valid_until;
  if (!valid || !pairs.world.complete) {
    ROS_WARN_THROTTLE(1.0, "stop: the pairs are %s", valid ? "not complete" : "too old");
  } else {
    ROS_INFO_THROTTLE(1.0, "%u near pairs, complete and valid", pairs.total);
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "ask_node");
  ros::NodeHandle node("proximity");  // the name of the proximity node
  ros::AsyncSpinner spinner(1);       // with several threads, messages do not wait for answers and become too old
  spinner.start();
  const ros::Subscriber subscriber = node.subscribe("pairs", 1, onPairs);
  Question<hgrid_proximity::QuerySphere> sphere(node, "query_sphere");
  Question<hgrid_proximity::QuerySegment> segment(node, "query_segment");
  Question<hgrid_proximity::QueryNearest> nearest(node, "query_nearest");
  const auto body = ros::param::param<std::string>("~body", "");
  ros::service::waitForService(node.resolveName("query_sphere"));
  for (ros::WallRate rate(2.0); ros::ok(); rate.sleep()) {
    hgrid_proximity::QuerySphere in_sphere;
    in_sphere.request.center.z = 0.9;
    in_sphere.request.radius = 0.4;
    sphere.ask(in_sphere);

    hgrid_proximity::QuerySegment on_beam;
    on_beam.request.start.x = on_beam.request.end.x = 0.4;
    on_beam.request.start.y = -2.0;
    on_beam.request.end.y = 2.0;
    on_beam.request.start.z = on_beam.request.end.z = 0.5;
    on_beam.request.exact = true;
    segment.ask(on_beam);

    if (body.empty()) continue;
    hgrid_proximity::QueryNearest near_body = nearestTo(body);
    nearest.ask(near_body);
  }
}
