// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <hgrid_proximity/Bodies.h>
#include <hgrid_proximity/Events.h>
#include <hgrid_proximity/ExplainPair.h>
#include <hgrid_proximity/GetAllowed.h>
#include <hgrid_proximity/Pairs.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QuerySphere.h>
#include <hgrid_proximity/ReloadRobot.h>
#include <hgrid_proximity/SetAllowed.h>
#include <hgrid_proximity/Status.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "child_process.h"
#include "values.h"

namespace hgrid {

namespace msg = ::hgrid_proximity;

namespace test {

/// The parameters, environment and program with which a node is started.
struct NodeSetup {
  /// Private parameters of the node. Here the default of ~valid_for is 10 s. With a shorter time, a busy machine could
  /// turn CLEAR into UNKNOWN.
  Value params = dict();
  std::map<std::string, Value> beside;             ///< parameters of the namespace of the node: robot_description, ...
  std::map<std::string, std::string> environment;  ///< variables that are added to the environment of the test
  std::vector<std::string> command;                ///< program and arguments; empty means proximity_node
};

/// The messages of one topic, the newest last.
template <class Message>
struct Messages : std::vector<boost::shared_ptr<const Message>> {
  /// Returns the newest message. @throws std::runtime_error if none has come yet; the test then fails
  const boost::shared_ptr<const Message>& back() const {
    if (this->empty()) throw std::runtime_error("a test reads the newest message of a topic, but none has come yet");
    return std::vector<boost::shared_ptr<const Message>>::back();
  }
};

/// All messages of a node since it was started.
struct Heard {
  Messages<msg::Pairs> pairs;
  Messages<msg::Events> events;
  Messages<msg::Status> status;
  Messages<msg::Bodies> bodies;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> diagnostics;  ///< newest status by name: world, robots, ...
};

/// Runs the node in its own process and namespace, stores its messages, and calls its services through persistent
/// connections.
///
/// Functions that wait return when a message arrives; they do not sleep for a fixed time. Functions throw
/// std::runtime_error if a message or an answer does not come; the test then fails.
class NodeUnderTest {
 public:
  /// Starts the node. Waits for its first ~status and ~pairs if `must_serve` is true.
  explicit NodeUnderTest(const NodeSetup& setup, bool must_serve = true);
  ~NodeUnderTest();

  const std::string& space() const { return space_; }
  /// Returns the full name of the topic or service `what` of the node.
  std::string named(const std::string& what) const { return space_ + "/proximity/" + what; }
  /// Sets a parameter in the namespace of the node. It is not a private parameter of the node.
  void setBeside(const std::string& parameter, const Value& value);
  ChildProcess& process() { return *process_; }

  /// Waits until `holds` is true for all messages received so far. Checks it at once and after each message.
  /// @param what      what the test waits for, as text for the error message
  /// @param patience  [s] longest time to wait
  void waitUntil(const std::string& what, const std::function<bool(const Heard&)>& holds, double patience = 20.0);
  /// Returns the newest ~status for which `wanted` is true. Waits for one if necessary.
  msg::Status::ConstPtr waitForStatus(const std::string& what, const std::function<bool(const msg::Status&)>& wanted);
  /// Returns the newest ~pairs or ~bodies for which `wanted` is true. Waits for one if necessary.
  msg::Pairs::ConstPtr waitForPairs(const std::string& what, const std::function<bool(const msg::Pairs&)>& wanted);
  msg::Bodies::ConstPtr waitForBodies(const std::string& what, const std::function<bool(const msg::Bodies&)>& wanted);
  /// Waits for `count` more ticks.
  void waitForTicks(std::size_t count);
  void waitForComplete();
  /// Waits until the node has accepted or refused `count` transforms in total.
  msg::Status::ConstPtr waitForTransforms(std::uint64_t count);
  Heard heard() const;

  msg::QuerySphere::Response ask(const msg::QuerySphere::Request& request);
  msg::QuerySegment::Response ask(const msg::QuerySegment::Request& request);
  msg::QuerySphere::Response sphere(double x, double y, double z, double radius, const std::string& frame = "");
  msg::QuerySegment::Response segment(const Value& from, const Value& to, double radius, const std::string& frame = "");
  msg::ReloadRobot::Response reload(const std::string& robot);
  std_srvs::Trigger::Response reset();
  msg::SetAllowed::Response setAllowed(const msg::SetAllowed::Request& request);
  msg::GetAllowed::Response getAllowed(const msg::GetAllowed::Request& request = {});
  msg::ExplainPair::Response explain(const std::string& first, const std::string& second, std::uint32_t contacts = 0,
                                     ros::Time stamp = ros::Time());

  /// Returns the text that the node has written to standard output and standard error so far.
  std::string output() const;
  /// Returns the number of lines of output() that contain the text.
  std::size_t lines(const std::string& text) const;
  /// Returns the time since the node was started [s].
  double uptime() const;

 private:
  void listen();
  template <class Message>
  void hear(Messages<Message> Heard::*where, const boost::shared_ptr<const Message>& message);
  template <class Message>
  boost::shared_ptr<const Message> waitFor(Messages<Message> Heard::*where, const std::string& what,
                                           const std::function<bool(const Message&)>& wanted);
  template <class Service>
  typename Service::Response call(ros::ServiceClient& client, const std::string& name,
                                  const typename Service::Request& request);

  std::string space_, output_file_;
  std::chrono::steady_clock::time_point started_;
  mutable std::mutex mutex_;
  std::condition_variable news_;
  Heard heard_;
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::ServiceClient sphere_, segment_, reload_, reset_, set_allowed_, get_allowed_, explain_;
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace test
}  // namespace hgrid
