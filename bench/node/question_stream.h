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

/// How long service calls to the node took, from the call to its return, over a persistent connection.
struct RoundTrips {
  std::vector<double> sphere, segment;  ///< [s] one per query of this kind
};

/// Sends queries to a node from its own thread until it is destroyed. Sphere and segment queries take turns, one at a
/// time, at random places of a room.
///
/// The pauses between queries are random, so that they cover every phase of the ticks. If an answer comes late, the
/// next query follows at once. Ten times per second, the thread also asks for the mark of MapStream. This query is not
/// timed; it shows that the map was replaced.
class QuestionStream {
 public:
  static constexpr double kRate = 200.0;  ///< [Hz] average rate of both kinds of queries together

  explicit QuestionStream(const std::string& node);
  ~QuestionStream();

  /// Adds the round trips of all queries from now on to `trips`. Null: stores nothing.
  void noteIn(RoundTrips* trips);
  /// Returns how many times the answer about the mark has changed, which means that a new map is in use.
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
  std::thread thread_;  // last member, since the thread uses the others
};

}  // namespace bench
}  // namespace hgrid
