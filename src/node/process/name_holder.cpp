// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/process/name_holder.h"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/time.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcSocket.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>

#include "hgrid_proximity/refusal.h"
#include "node/process/shutdown.h"

namespace hgrid {
namespace {

using SteadyClock = std::chrono::steady_clock;
using XmlRpc::XmlRpcValue;

constexpr double kPatience = 1.0;  // [s] time for the answer of a process that is asked for the first time
/// [s] The same while this node waits for the end of a node that has answered before. Longer, because a busy computer
/// may delay one of many answers, and then a node that works would end.
constexpr double kLongPatience = 10.0;
constexpr double kEnding = 2.0;  // [s] a node that is ending is gone after this time, see shutDownOnSignals()

double secondsSince(SteadyClock::time_point begin) {
  return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

/// A request to the XML-RPC server of a node. Unlike XmlRpcClient::execute(), it has a deadline.
class Request : public XmlRpc::XmlRpcClient {
 public:
  Request(const std::string& host, std::uint32_t port) : XmlRpcClient(host.c_str(), static_cast<int>(port), "/") {}

  /// Returns the payload of the answer. Invalid if no answer comes within `patience` [s], or if it reports an error.
  XmlRpcValue payload(const char* method, double patience) {
    XmlRpcValue params, answer;
    params[0] = ros::this_node::getName();
    ended_ = false;
    if (!executeNonBlock(method, params)) return {};
    const auto begin = SteadyClock::now();
    for (double left = patience; !ended_ && left > 0.0; left = patience - secondsSince(begin)) {
      _disp.work(left);  // returns earlier if a signal arrives
    }
    const bool valid = executeCheckDone(answer) && !isFault() && answer.getType() == XmlRpcValue::TypeArray &&
                       answer.size() == 3 && answer[0].getType() == XmlRpcValue::TypeInt &&
                       static_cast<int&>(answer[0]) == 1;
    return valid ? answer[2] : XmlRpcValue();
  }

 private:
  unsigned handleEvent(unsigned event) override {
    const unsigned next_events = XmlRpcClient::handleEvent(event);
    ended_ = next_events == 0;
    return next_events;
  }

  bool ended_ = false;  // there is an answer, or the connection has failed
};

/// Asks the master. Waits for it if there is none. Invalid: the master answers with an error.
XmlRpcValue masterSays(const char* method, const std::string& name) {
  XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!name.empty()) request[1] = name;
  return ros::master::execute(method, request, response, payload, true) ? payload : XmlRpcValue();
}

/// Returns the topics that this node publishes as the master knows it. It may be another process of the same name.
std::set<std::string> topicsAtMaster(const std::string& node) {
  XmlRpcValue state = masterSays("getSystemState", "");
  std::set<std::string> topics;
  if (state.getType() != XmlRpcValue::TypeArray) return topics;
  for (int i = 0; i < state[0].size(); ++i) {
    XmlRpcValue& publishers = state[0][i][1];
    for (int k = 0; k < publishers.size(); ++k) {
      if (static_cast<std::string&>(publishers[k]) == node) topics.insert(static_cast<std::string&>(state[0][i][0]));
    }
  }
  return topics;
}

/// What is known about the process that has the name of this node.
struct NameHolder {
  std::string uri;       ///< its address at the master; empty if nobody has the name
  int process = 0;       ///< process id
  bool running = false;  ///< whether a node of this name answers at the address
};

/// Asks the master who has the name of this node, and asks this process whether it runs.
/// @param before  what the last call has returned. A process is asked for its topics only once.
/// @param patience  [s] time for the answer of the process
NameHolder askHolder(const NameHolder& before, double patience) {
  const std::string& name = ros::this_node::getName();
  NameHolder holder;
  XmlRpcValue uri = masterSays("lookupNode", name);
  if (uri.getType() != XmlRpcValue::TypeString) return holder;
  holder.uri = static_cast<std::string&>(uri);
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(holder.uri, host, port)) return holder;
  try {
    Request request(host, port);
    XmlRpcValue process = request.payload("getPid", patience);
    if (process.getType() != XmlRpcValue::TypeInt) return holder;
    holder.process = process;
    if (before.running && before.uri == holder.uri && before.process == holder.process) return before;
    // After a node was killed, another node may get its port. Then some of these topics are missing in its answer.
    std::set<std::string> missing = topicsAtMaster(name);
    XmlRpcValue published = request.payload("getPublications", patience);
    for (int i = 0; i < published.size(); ++i) missing.erase(static_cast<std::string&>(published[i][0]));
    holder.running = missing.empty();
  } catch (const XmlRpc::XmlRpcException&) {  // there is no second answer, or it is malformed
  }
  return holder;
}

/// Says that the name is held, as the begin of a sentence.
std::string nameIsHeld(const NameHolder& holder) {
  return "The name '" + ros::this_node::getName() + "' belongs to a running node (process " +
         std::to_string(holder.process) + " at " + printable(holder.uri) + ")";
}

}  // namespace

std::optional<int> exitCodeOfNameConflict(NameConflict conflict) {
  if (conflict == NameConflict::replace) return std::nullopt;
  // ros::NodeHandle does the same, but the requests below come before it.
  const char* ipv6 = std::getenv("ROS_IPV6");
  XmlRpc::XmlRpcSocket::s_use_ipv6_ = ipv6 != nullptr && std::string(ipv6) == "on";

  const bool waits = conflict == NameConflict::wait;
  const auto begin = SteadyClock::now();
  NameHolder holder;
  for (bool first = true;; first = false) {
    holder = askHolder(holder, waits && !first ? kLongPatience : kPatience);
    if (endRequested()) return 0;  // the signal may have interrupted the request, so the answer means nothing
    if (holder.uri.empty()) return std::nullopt;
    if (!holder.running) {
      ROS_WARN(
          "The ROS master lists the name '%s' at %s, but no node of this name answers there. It was probably killed, "
          "or it hangs. This node takes the name.",
          ros::this_node::getName().c_str(), printable(holder.uri).c_str());
      return std::nullopt;
    }
    if (waits && first) ROS_WARN("%s. This node waits until that node has ended.", nameIsHeld(holder).c_str());
    if (!waits && secondsSince(begin) > kEnding) {
      ROS_FATAL(
          "%s, so this node does not start: end that node, start this one with another __name, or take the name with "
          "--replace.",
          nameIsHeld(holder).c_str());
      return kNameHeldExitCode;
    }
    ros::WallDuration(waits ? 1.0 : 0.1).sleep();
  }
}

}  // namespace hgrid
