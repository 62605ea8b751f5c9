// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Controls for the node benchmark: nodes that do nothing but use ROS. The argument says what the node does:
//   relay    publishes each message of /tf again, on ~tf
//   ignore   receives /tf and does nothing with it
//   service  answers ~query_sphere with an empty answer
#include <hgrid_proximity/QuerySphere.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <string>

namespace {

using Question = hgrid_proximity::QuerySphere;

bool answer(Question::Request&, Question::Response& response) {
  response.answer.success = true;
  return true;
}

void ignore(const tf2_msgs::TFMessage::ConstPtr&) {}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "control");
  const std::string mode = argc > 1 ? argv[1] : "";
  ros::NodeHandle node, own("~");
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  ros::Publisher publisher;
  ros::Subscriber subscriber;
  ros::ServiceServer service;
  if (mode == "relay") {
    publisher = own.advertise<tf2_msgs::TFMessage>("tf", 1000);
    const boost::function<void(const tf2_msgs::TFMessage::ConstPtr&)> relay =
        [&](const tf2_msgs::TFMessage::ConstPtr& message) { publisher.publish(message); };
    subscriber = node.subscribe<tf2_msgs::TFMessage>("/tf", 1000, relay, ros::VoidConstPtr(), hints);
  } else if (mode == "ignore") {
    subscriber = node.subscribe<tf2_msgs::TFMessage>("/tf", 1000, ignore, hints);
  } else if (mode == "service") {
    service = own.advertiseService("query_sphere", answer);
  } else if (mode == "service_and_tf") {
    subscriber = node.subscribe<tf2_msgs::TFMessage>("/tf", 1000, ignore, hints);
    service = own.advertiseService("query_sphere", answer);
  } else {
    ROS_FATAL("usage: node_testcontrol relay|ignore|service|service_and_tf");
    return 1;
  }
  ros::spin();
  return 0;
}
