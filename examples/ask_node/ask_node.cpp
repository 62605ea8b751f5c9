// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Asks the running node from C++: sends two queries per second over persistent connections, and checks every message of
// ~pairs. Start it beside any launch file of this package: rosrun hgrid_proximity ask_node
// With _body:=robot/gripper it also asks which bodies are nearest to that body.
#include <hgrid_proximity/Pairs.h>
#include <hgrid_proximity/client/client.h>
#include <ros/ros.h>

#include <cstdio>
#include <string>

namespace {

using hgrid_proximity::Client;

constexpr char kUsage[] =
    "usage: rosrun hgrid_proximity ask_node [_body:=NAME] [REMAPPING...]\n\n"
    "Asks the running node: sends two queries per second, and judges every message of proximity/pairs.\n\n"
    "  _body:=NAME   also asks which bodies are nearest to this body, such as robot/gripper\n"
    "  REMAPPING     ROS remappings, such as __name:=NAME or __ns:=NAMESPACE\n"
    "  -h, --help    print this text and end\n";

/// Sends the request and prints the answer. Only CLEAR means that nothing is there.
template <class Request>
void ask(Client& proximity, const Request& request) {
  try {
    const hgrid_proximity::Answer answer = proximity.ask(request).answer;
    const bool known = isClear(answer) || isHit(answer);
    ROS_INFO("%s%s", answer.summary.c_str(), known ? "" : "; treat it as occupied");
    for (const hgrid_proximity::Hit& hit : answer.hits) ROS_INFO("  %s, %.3f m", hit.name.c_str(), hit.distance);
  } catch (const hgrid_proximity::ProximityError& error) {
    ROS_WARN("no answer; that is not CLEAR: %s", error.what());
  }
}

/// Returns the request: which three bodies are nearest to this body?
hgrid_proximity::QueryNearestRequest nearestTo(const std::string& body) {
  hgrid_proximity::QueryNearestRequest nearest;
  nearest.body = body;
  nearest.limit = 3;
  nearest.exact = true;            // measures the shapes, not their boxes
  nearest.respect_allowed = true;  // leaves out what may touch the body, such as its neighbors at a joint
  return nearest;
}

/// Judges a message of ~pairs. "Nothing is near" requires a complete world and a message that is still valid.
void onPairs(const hgrid_proximity::Pairs& pairs) {
  if (isUsable(pairs.world)) {
    ROS_INFO_THROTTLE(1.0, "%u near pairs, complete and valid", pairs.total);
  } else {
    ROS_WARN_THROTTLE(1.0, "stop: the pairs are %s", pairs.world.complete ? "too old" : "not complete");
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::V_string words;
  ros::removeROSArgs(argc, argv, words);
  if (words.size() > 1) {  // before ros::init(): asking for help must not start a node
    if (words[1] == "--help" || words[1] == "-h") return std::fputs(kUsage, stdout), 0;
    return std::fprintf(stderr, "ask_node: the argument '%s' is unknown; see --help\n", words[1].c_str()), 2;
  }
  ros::init(argc, argv, "ask_node");
  ros::NodeHandle node;
  ros::AsyncSpinner spinner(1);  // with several threads, messages do not wait for answers and become too old
  spinner.start();
  const ros::Subscriber subscriber = node.subscribe("proximity/pairs", 1, onPairs);
  Client proximity("proximity");  // the name of the proximity node
  const auto body = ros::param::param<std::string>("~body", "");
  for (ros::WallRate rate(2.0); ros::ok(); rate.sleep()) {
    hgrid_proximity::QuerySphereRequest in_sphere;
    in_sphere.center.z = 0.9;
    in_sphere.radius = 0.4;
    ask(proximity, in_sphere);

    hgrid_proximity::QuerySegmentRequest on_beam;
    on_beam.start.x = on_beam.end.x = 0.4;
    on_beam.start.y = -2.0;
    on_beam.end.y = 2.0;
    on_beam.start.z = on_beam.end.z = 0.5;
    on_beam.exact = true;
    ask(proximity, on_beam);

    if (!body.empty()) ask(proximity, nearestTo(body));
  }
}
