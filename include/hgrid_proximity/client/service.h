// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/client/errors.h>
#include <hgrid_proximity/client/time_limit.h>
#include <ros/node_handle.h>
#include <ros/service.h>
#include <ros/service_client.h>

#include <chrono>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>

namespace hgrid_proximity {

/// Calls one service of a proximity node over a persistent connection, with a time limit. roscpp itself has none.
///
/// Several threads may share an object; their calls run one after the other.
///
/// @tparam Kind  the service type, for example QuerySphere
template <class Kind>
class Service {
 public:
  /// @param name     name of the service, resolved with `node`
  /// @param timeout  longest time for connecting, and for an answer
  Service(const ros::NodeHandle& node, const std::string& name, std::chrono::duration<double> timeout)
      : node_(node), name_(node.resolveName(name)), timeout_(timeout), limit_([this] { client_.shutdown(); }) {}

  /// @param extra  how much longer than usual the node may work on this request
  /// @throws NoAnswer  the connection is closed then, and the next call connects again
  typename Kind::Response call(const typename Kind::Request& request, std::chrono::duration<double> extra = {}) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!client_.isValid()) connect();
    Kind call;
    call.request = request;
    const auto limit = timeout_ + extra;
    limit_.begin(std::chrono::duration_cast<std::chrono::steady_clock::duration>(limit));
    const bool answered = client_.call(call);
    const bool expired = limit_.end();
    if (answered) return call.response;
    client_.shutdown();
    std::ostringstream why;
    why << name_;
    if (expired) why << " did not answer within " << limit.count() << " s";
    if (!expired) why << ": the connection was closed before the answer";
    throw NoAnswer(why.str() + advice());
  }

 private:
  void connect() {
    const auto deadline = std::chrono::steady_clock::now() + timeout_;
    while (true) {
      client_ = node_.serviceClient<Kind>(name_, true);
      if (client_.isValid()) return;
      if (std::chrono::steady_clock::now() >= deadline || !ros::ok()) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    throw NoAnswer(name_ + " does not exist" + advice());
  }
  static std::string advice() { return "; `rosnode list` shows whether the node runs"; }

  ros::NodeHandle node_;
  const std::string name_;
  const std::chrono::duration<double> timeout_;
  std::mutex mutex_;
  ros::ServiceClient client_;
  TimeLimit limit_;  // the last member, because its thread uses client_
};

}  // namespace hgrid_proximity
