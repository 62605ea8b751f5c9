// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/client/errors.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

namespace hgrid_proximity {

/// Calls one service with a time limit. With `repeat`, the connection stays open between calls. Otherwise each call
/// opens its own.
///
/// roscpp cannot limit the time of a call. Therefore a thread of its own makes the calls; the first call starts it.
/// Several threads may share an object. Their calls run one after the other, and the time limit of a call begins when
/// the call before it has ended.
///
/// @tparam Kind  the service type, for example QuerySphere
template <class Kind>
class Service {
 public:
  /// @param name     name of the service, resolved as usual
  /// @param timeout  longest time from a call to its answer, connecting included
  /// @param repeat   true: a call that fails on an open connection is made again; only for services that change nothing
  /// @throws std::invalid_argument unless the timeout is greater than 0 and at most 10^6 s
  Service(const std::string& name, std::chrono::duration<double> timeout, bool repeat = true)
      : name_(node_.resolveName(name)), timeout_(timeout), repeat_(repeat) {
    if (timeout.count() > 0.0 && timeout.count() <= 1e6) return;
    throw std::invalid_argument("the timeout is " + std::to_string(timeout.count()) +
                                " s; it must be greater than 0 and at most 1000000");
  }
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;
  ~Service() { drop(); }

  /// @param extra  how much longer than usual the node may work on this request; at most 10^6 s
  /// @throws NoAnswer  the next call connects again
  typename Kind::Response call(const typename Kind::Request& request, std::chrono::duration<double> extra = {}) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto limit = std::chrono::duration_cast<std::chrono::steady_clock::duration>(timeout_ + extra);
    const auto deadline = std::chrono::steady_clock::now() + limit;
    const bool used = line_ != nullptr;
    const char* error = ask(request, deadline);
    if (error != nullptr && used && std::chrono::steady_clock::now() < deadline) {
      error = ask(request, deadline);  // the node may have been restarted since the last call
    }
    if (error == nullptr) {
      typename Kind::Response response = line_->call.response;
      if (!repeat_) drop();
      return response;
    }
    throw NoAnswer(name_ + error + ". Check the node: `rosnode ping " + name_.substr(0, name_.rfind('/')) + "`");
  }

 private:
  /// What this object shares with its thread. After a timeout this object drops it, and the thread ends with its call.
  struct Line {
    std::mutex mutex;
    std::condition_variable changed;
    Kind call;              // the thread uses it while `busy`
    bool busy = false;      // whether the thread must make a call, or makes one
    bool found = false;     // whether the service was found
    bool answered = false;  // whether the last call succeeded
    bool dropped = false;   // whether nobody waits for the thread any more
  };

  /// Makes a call. If it fails, drops the connection. @returns what went wrong; null: there is a response in the line
  const char* ask(const typename Kind::Request& request, std::chrono::steady_clock::time_point deadline) {
    if (!line_) {
      const auto line = std::make_shared<Line>();
      std::thread([line, name = name_] { work(*line, name); }).detach();
      line_ = line;
    }
    std::unique_lock<std::mutex> lock(line_->mutex);
    line_->call.request = request;
    line_->busy = true;
    line_->changed.notify_all();
    const bool ended = line_->changed.wait_until(lock, deadline, [this] { return !line_->busy; });
    if (ended && line_->answered) return nullptr;
    const bool found = line_->found;
    lock.unlock();
    drop();
    if (!ended) return found ? " did not answer in time" : " does not exist";
    return " failed: the connection was closed, or the node reported an error";
  }

  void drop() {
    if (!line_) return;
    {
      const std::lock_guard<std::mutex> lock(line_->mutex);
      line_->dropped = true;
    }
    line_->changed.notify_all();
    line_.reset();
  }

  static void work(Line& line, const std::string& name) {
    ros::NodeHandle node;
    ros::ServiceClient client;
    std::unique_lock<std::mutex> lock(line.mutex);
    while (true) {
      line.changed.wait(lock, [&] { return line.busy || line.dropped; });
      if (line.dropped) return;
      lock.unlock();
      while (!client.isValid()) {
        client = node.serviceClient<Kind>(name, true);  // true: persistent
        if (client.isValid()) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        const std::lock_guard<std::mutex> looking(line.mutex);
        if (line.dropped || !ros::ok()) break;
      }
      lock.lock();
      line.found = client.isValid();
      lock.unlock();
      const bool answered = client.isValid() && client.call(line.call);
      lock.lock();
      line.answered = answered;
      line.busy = false;
      line.changed.notify_all();
    }
  }

  ros::NodeHandle node_;  // destroying the last node handle of a program ends roscpp
  const std::string name_;
  const std::chrono::duration<double> timeout_;
  const bool repeat_;
  std::mutex mutex_;
  std::shared_ptr<Line> line_;
};

}  // namespace hgrid_proximity
