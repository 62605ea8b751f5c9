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

/// How long questions took: from the call to its return, over a persistent connection.
struct RoundTrips {
  std::vector<double> sphere, segment;  ///< [s]
};

/// Asks a node while it lives: ball and segment in turn, at random places of a room, one at a time. The moments are
/// random, so that they meet every phase of the ticks; what is late, since the answer before came late, is asked at
/// once. Ten times a second it also asks for the mark of MapStream, which is not timed, and so sees maps being
/// replaced.
class QuestionStream {
 public:
  static constexpr double kRate = 200.0;  ///< [Hz] on average, both kinds together

  explicit QuestionStream(const std::string& node);
  ~QuestionStream();

  /// From now on round trips are added there; null: nowhere.
  void noteIn(RoundTrips* trips);
  /// How many times another map was seen to be in force.
  std::size_t replacements() const { return replacements_; }
  /// Questions that were not answered.
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
  std::thread thread_;  // last: it uses the others
};

}  // namespace bench
}  // namespace hgrid
