// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "clock_watch.h"
#include "ledger.h"

namespace hgrid {

/// What is known of the way of transforms between two frames.
struct ChainState {
  bool connected = false;          ///< there is a way
  std::string unknown_frame;       ///< not connected: a frame that was never heard of, empty if all were
  bool moves = false;              ///< a transform on the way comes from /tf
  Time newest{0};                  ///< moves: newest time at which all of the way is known
  double age = 0.0;                ///< [s] moves: of the oldest of the newest transforms, now
  double period = 0.0;             ///< [s] moves: longest of the measured periods on the way
  bool conflict = false;           ///< a frame on the way comes on /tf and on /tf_static
  std::optional<Refusal> refused;  ///< the newest transform of a frame on the way was refused
};

/// The node's own reading of /tf and /tf_static: checks every transform, remembers when it came and from whom,
/// and feeds a tf2 buffer with what is good. One writer; buffer() may be asked from any thread.
class TfIntake {
 public:
  TfIntake(double max_future, double cache, std::size_t max_frames, bool simulated, Ledger& ledger);

  /// Takes in the transforms of one message; what is refused is counted and logged, the rest is kept.
  void take(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher, const Moment& now);
  /// Forgets what came on /tf: after a clock jump. Static transforms stay.
  void forgetMoving();
  /// Forgets when what came on /tf was stamped, not when it was received: the wall clock was set.
  void restamp();

  const tf2::BufferCore& buffer() const { return buffer_; }
  ChainState chain(const std::string& target, const std::string& source, const Moment& now) const;
  std::vector<std::string> conflicts() const;
  std::size_t frames() const { return records_.size(); }

 private:
  /// What is known of the transform that places one frame in its parent.
  struct Record {
    std::string parent;
    geometry_msgs::Transform last;
    Time stamp{0};
    std::chrono::steady_clock::time_point received;
    double latency = 0.0;  // [s] age when it was received
    double period = 0.0;   // [s] between stamps, smoothed
    bool from_tf = false, from_static = false;
    std::optional<Refusal> refused;
  };

  void takeOne(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher,
               const Moment& now);
  void check(const geometry_msgs::TransformStamped& transform, const std::string& parent, const std::string& child,
             bool is_static, const Moment& now) const;
  double ageOf(const Record& record, const Moment& now) const;

  double max_future_;
  std::size_t max_frames_;
  bool simulated_;
  Ledger& ledger_;
  tf2::BufferCore buffer_;
  std::map<std::string, Record> records_;  // by child frame
  std::set<std::string> parents_;          // frames that something hangs on
};

}  // namespace hgrid
