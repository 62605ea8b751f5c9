// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node_under_test.h"

#include <ros/param.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "test/node/support/built.h"

namespace hgrid {
namespace test {
namespace {

/// Returns a namespace that no other node of this master uses. Then the test receives no message of an earlier node.
std::string nextSpace() {
  static std::atomic<int> count{0};
  return "/cell_" + std::to_string(getpid()) + "_" + std::to_string(++count);
}

std::string scratchFile(const std::string& space) {
  const char* folder = std::getenv("TMPDIR");
  return std::string(folder == nullptr ? "/tmp" : folder) + space + ".log";
}

std::vector<std::string> commandOf(const NodeSetup& setup, const std::string& space) {
  std::vector<std::string> command = setup.command;
  if (command.empty()) command = {built(HGRID_NODE)};
  command.push_back("__ns:=" + space);
  command.push_back("__name:=proximity");
  return command;
}

std::string gist(const msg::Status& status) {
  std::ostringstream text;
  text << "sequence " << status.world.sequence << ", " << (status.world.complete ? "complete" : "not complete");
  for (const std::string& reason : status.world.reasons) text << "; " << reason;
  for (const msg::BodyStatus& body : status.bodies) {
    text << "; " << body.name << " in state " << int(body.state) << " (" << body.code.text << ")";
  }
  for (const msg::Counter& counter : status.counters) text << "; " << counter.name << " " << counter.value;
  return text.str();
}

}  // namespace

NodeUnderTest::NodeUnderTest(const NodeSetup& setup, bool must_serve)
    : space_(nextSpace()), output_file_(scratchFile(space_)), started_(std::chrono::steady_clock::now()) {
  Value params = setup.params;
  if (!params.hasMember("valid_for")) params["valid_for"] = 10.0;
  ros::param::set(space_ + "/proximity", params);
  for (const auto& parameter : setup.beside) setBeside(parameter.first, parameter.second);
  listen();
  process_ = std::make_unique<ChildProcess>(commandOf(setup, space_), output_file_, setup.environment);
  if (!must_serve) return;
  waitForStatus("the first ~status of the node", [](const msg::Status&) { return true; });
  waitForPairs("the first ~pairs of the node", [](const msg::Pairs&) { return true; });
}

NodeUnderTest::~NodeUnderTest() {
  subscribers_.clear();
  process_.reset();
  ros::param::del(space_);
  std::remove(output_file_.c_str());
}

void NodeUnderTest::setBeside(const std::string& parameter, const Value& value) {
  ros::param::set(space_ + "/" + parameter, value);
}

template <class Message>
void NodeUnderTest::hear(Messages<Message> Heard::*where, const boost::shared_ptr<const Message>& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  (heard_.*where).push_back(message);
  news_.notify_all();
}

void NodeUnderTest::listen() {
  subscribers_.push_back(node_.subscribe<msg::Pairs>(
      named("pairs"), 1000, [this](const msg::Pairs::ConstPtr& message) { hear(&Heard::pairs, message); }));
  subscribers_.push_back(node_.subscribe<msg::Events>(
      named("events"), 1000, [this](const msg::Events::ConstPtr& message) { hear(&Heard::events, message); }));
  subscribers_.push_back(node_.subscribe<msg::Status>(
      named("status"), 1000, [this](const msg::Status::ConstPtr& message) { hear(&Heard::status, message); }));
  subscribers_.push_back(node_.subscribe<msg::Bodies>(
      named("bodies"), 1000, [this](const msg::Bodies::ConstPtr& message) { hear(&Heard::bodies, message); }));
  using diagnostic_msgs::DiagnosticArray;
  subscribers_.push_back(
      node_.subscribe<DiagnosticArray>("/diagnostics", 1000, [this](const DiagnosticArray::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        const std::string begin = space_.substr(1) + "/proximity: ";
        for (const diagnostic_msgs::DiagnosticStatus& status : message->status) {
          if (status.name.rfind(begin, 0) == 0) heard_.diagnostics[status.name.substr(begin.size())] = status;
        }
        news_.notify_all();
      }));
}

void NodeUnderTest::waitUntil(const std::string& what, const std::function<bool(const Heard&)>& holds,
                              double patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (news_.wait_for(lock, std::chrono::duration<double>(patience), [&] { return holds(heard_); })) return;
  std::string newest = heard_.status.empty() ? "none was received" : gist(*heard_.status.back());
  lock.unlock();
  throw std::runtime_error("waited " + std::to_string(patience) + " s for: " + what + "\nnewest ~status: " + newest +
                           "\noutput:\n" + output());
}

template <class Message>
boost::shared_ptr<const Message> NodeUnderTest::waitFor(Messages<Message> Heard::*where, const std::string& what,
                                                        const std::function<bool(const Message&)>& wanted) {
  boost::shared_ptr<const Message> found;
  std::size_t next = (heard().*where).size();
  if (next > 0) --next;
  waitUntil(what, [&](const Heard& all) {
    for (; next < (all.*where).size() && !found; ++next) {
      if (wanted(*(all.*where)[next])) found = (all.*where)[next];
    }
    return found != nullptr;
  });
  return found;
}

msg::Status::ConstPtr NodeUnderTest::waitForStatus(const std::string& what,
                                                   const std::function<bool(const msg::Status&)>& wanted) {
  return waitFor(&Heard::status, what, wanted);
}

msg::Pairs::ConstPtr NodeUnderTest::waitForPairs(const std::string& what,
                                                 const std::function<bool(const msg::Pairs&)>& wanted) {
  return waitFor(&Heard::pairs, what, wanted);
}

msg::Bodies::ConstPtr NodeUnderTest::waitForBodies(const std::string& what,
                                                   const std::function<bool(const msg::Bodies&)>& wanted) {
  return waitFor(&Heard::bodies, what, wanted);
}

void NodeUnderTest::waitForTicks(std::size_t count) {
  const Heard now = heard();
  waitUntil(std::to_string(count) + " more ticks", [&](const Heard& all) {
    return all.status.size() >= now.status.size() + count && all.pairs.size() >= now.pairs.size() + count;
  });
}

void NodeUnderTest::waitForComplete() {
  waitForStatus("a complete world", [](const msg::Status& status) { return status.world.complete; });
  waitForPairs("a complete world", [](const msg::Pairs& pairs) { return pairs.world.complete; });
}

msg::Status::ConstPtr NodeUnderTest::waitForTransforms(std::uint64_t count) {
  return waitForStatus(std::to_string(count) + " transforms", [&](const msg::Status& status) {
    std::uint64_t processed = 0;
    for (const msg::Counter& counter : status.counters) {
      const bool verdict = counter.name == "tf.accepted" || counter.name == "tf.too_old" ||
                           counter.name == "tf.rival" || counter.name.rfind("tf.refused.", 0) == 0 ||
                           counter.name.rfind("tf.ignored.", 0) == 0;
      if (verdict) processed += counter.value;
    }
    return processed >= count;
  });
}

Heard NodeUnderTest::heard() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return heard_;
}

template <class Service>
typename Service::Response NodeUnderTest::call(ros::ServiceClient& client, const std::string& name,
                                               const typename Service::Request& request) {
  if (!client.isValid()) client = node_.serviceClient<Service>(named(name), true);
  typename Service::Response response;
  if (!client.call(request, response)) throw std::runtime_error(named(name) + " gave no answer\n" + output());
  return response;
}

msg::QuerySphere::Response NodeUnderTest::ask(const msg::QuerySphere::Request& request) {
  return call<msg::QuerySphere>(sphere_, "query_sphere", request);
}

msg::QuerySegment::Response NodeUnderTest::ask(const msg::QuerySegment::Request& request) {
  return call<msg::QuerySegment>(segment_, "query_segment", request);
}

msg::QuerySphere::Response NodeUnderTest::sphere(double x, double y, double z, double radius,
                                                 const std::string& frame) {
  msg::QuerySphere::Request request;
  request.header.frame_id = frame;
  request.center.x = x;
  request.center.y = y;
  request.center.z = z;
  request.radius = radius;
  return ask(request);
}

msg::QuerySegment::Response NodeUnderTest::segment(const Value& from, const Value& to, double radius,
                                                   const std::string& frame) {
  const auto point = [](Value value) {
    geometry_msgs::Point result;
    result.x = value[0];
    result.y = value[1];
    result.z = value[2];
    return result;
  };
  msg::QuerySegment::Request request;
  request.header.frame_id = frame;
  request.start = point(from);
  request.end = point(to);
  request.radius = radius;
  return ask(request);
}

msg::ReloadRobot::Response NodeUnderTest::reload(const std::string& robot) {
  msg::ReloadRobot::Request request;
  request.robot = robot;
  return call<msg::ReloadRobot>(reload_, "reload_robot", request);
}

std_srvs::Trigger::Response NodeUnderTest::reset() { return call<std_srvs::Trigger>(reset_, "reset", {}); }

msg::SetAllowed::Response NodeUnderTest::setAllowed(const msg::SetAllowed::Request& request) {
  return call<msg::SetAllowed>(set_allowed_, "set_allowed", request);
}

msg::GetAllowed::Response NodeUnderTest::getAllowed(const msg::GetAllowed::Request& request) {
  return call<msg::GetAllowed>(get_allowed_, "get_allowed", request);
}

msg::ExplainPair::Response NodeUnderTest::explain(const std::string& first, const std::string& second,
                                                  std::uint32_t contacts, ros::Time stamp) {
  msg::ExplainPair::Request request;
  request.contacts = contacts;
  request.header.stamp = stamp;
  request.first = first;
  request.second = second;
  return call<msg::ExplainPair>(explain_, "explain_pair", request);
}

std::string NodeUnderTest::output() const {
  std::ifstream file(output_file_);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::size_t NodeUnderTest::lines(const std::string& text) const {
  std::istringstream all(output());
  std::size_t count = 0;
  for (std::string line; std::getline(all, line);) count += line.find(text) != std::string::npos ? 1 : 0;
  return count;
}

double NodeUnderTest::uptime() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

}  // namespace test
}  // namespace hgrid
