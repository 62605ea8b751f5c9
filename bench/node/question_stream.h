// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QuerySphere.h>
#include <ros/node_handle.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bench/workload/random.h"

namespace hgrid {
namespace bench {

/// Durations of service calls to the node over a persistent connection, from the call to its return.
struct RoundTrips {
  std::vector<double> sphere, segment;  ///< [s] duration of each query of this kind
};

/// Sends queries to a node from its own thread until this object is destroyed. Sends a sphere query and a segment query
/// in turn, at random places of a room. It waits for the answer of a query before it sends the next one.
///
/// The pauses between queries are random. Thus queries arrive in every phase of a tick. If an answer comes late, the
/// next query follows at once. Ten times per second, the thread also asks for the mark of MapStream, which shows
/// whether the map was replaced. This query is not timed.
class QuestionStream {
 public:
  static constexpr double kRate = 200.0;  ///< [Hz] average rate of both kinds of queries together

  explicit QuestionStream(const std::string& node);
  ~QuestionStream();

  /// Adds the durations of all queries from now on to `trips`. Null means that nothing is stored.
  void noteIn(RoundTrips* trips);
  /// Returns how many times the answer about the mark has changed. Each change means that the node uses a new map.
  std::size_t replacements() const { return replacements_; }
  /// Returns the number of queries that were not answered.
  std::size_t failures() const { return failures_; }

 private:
  void run();
  void askSphere();
  void askSegment();
  void askForMark();
  template <class Question>
  void time(ros::ServiceClient& client, Question& question, std::vector<double> RoundTrips::*kind);

  ros::NodeHandle node_;
  ros::ServiceClient sphere_, segment_;
  Random random_{1};
  bool marked_ = false, looked_ = false;
  std::mutex mutex_;
  RoundTrips* trips_ = nullptr;
  std::atomic<std::size_t> replacements_{0}, failures_{0};
  std::atomic<bool> stopping_{false};
  std::thread thread_;  // last member, because the thread uses the other members
};

}  // namespace bench
}  // namespace hgrid
