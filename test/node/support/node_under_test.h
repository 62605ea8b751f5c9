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
#include <string>
#include <vector>

#include "child_process.h"
#include "values.h"

namespace hgrid {

namespace msg = ::hgrid_proximity;

namespace test {

/// What a node is started with.
struct NodeSetup {
  /// Its private parameters. Unless said otherwise ~valid_for is 10 s, so that a machine that is busy elsewhere does
  /// not turn CLEAR into UNKNOWN.
  Value params = dict();
  std::map<std::string, Value> beside;             ///< parameters in its namespace: robot_description, ...
  std::map<std::string, std::string> environment;  ///< added to the test's own
  std::vector<std::string> command;                ///< empty: proximity_node
};

/// What it has said since it was started, the newest last.
struct Heard {
  std::vector<msg::Pairs::ConstPtr> pairs;
  std::vector<msg::Events::ConstPtr> events;
  std::vector<msg::Status::ConstPtr> status;
  std::vector<msg::Bodies::ConstPtr> bodies;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> diagnostics;  ///< newest by name: world, robots, ...
};

/// The node in a process and a namespace of its own, its messages, and its services through persistent connections.
/// All waiting is for messages. Its functions throw std::runtime_error, which fails a test, where a message or an
/// answer does not come.
class NodeUnderTest {
 public:
  /// Starts it and waits for its first ~status, or if `must_serve` is false for nothing.
  explicit NodeUnderTest(const NodeSetup& setup, bool must_serve = true);
  ~NodeUnderTest();

  const std::string& space() const { return space_; }
  /// Full name of one of its topics or services.
  std::string named(const std::string& what) const { return space_ + "/proximity/" + what; }
  void setBeside(const std::string& parameter, const Value& value);
  ChildProcess& process() { return *process_; }

  /// Waits until the predicate holds of all that was heard, now or after another message.
  void waitUntil(const std::string& what, const std::function<bool(const Heard&)>& holds, double patience = 20.0);
  /// The newest ~status, or the first later one, that is as wanted.
  msg::Status::ConstPtr waitForStatus(const std::string& what, const std::function<bool(const msg::Status&)>& wanted);
  msg::Pairs::ConstPtr waitForPairs(const std::string& what, const std::function<bool(const msg::Pairs&)>& wanted);
  msg::Bodies::ConstPtr waitForBodies(const std::string& what, const std::function<bool(const msg::Bodies&)>& wanted);
  /// Waits for `count` more ticks.
  void waitForTicks(std::size_t count);
  void waitForComplete();
  /// Waits until `count` transforms were taken in or refused, in all.
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

  /// What it wrote so far, to standard output and standard error.
  std::string output() const;
  /// How many lines of that contain the text.
  std::size_t lines(const std::string& text) const;
  /// [s] since it was started.
  double uptime() const;

 private:
  void listen();
  template <class Message>
  void hear(std::vector<boost::shared_ptr<const Message>> Heard::*where,
            const boost::shared_ptr<const Message>& message);
  template <class Message>
  boost::shared_ptr<const Message> waitFor(std::vector<boost::shared_ptr<const Message>> Heard::*where,
                                           const std::string& what, const std::function<bool(const Message&)>& wanted);
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
