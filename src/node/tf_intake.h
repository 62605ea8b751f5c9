// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "clock_watch.h"
#include "frame_pose.h"
#include "ledger.h"

namespace hgrid {

/// The node's own reading of /tf and /tf_static: checks every transform, remembers when it came and from whom,
/// and feeds a tf2 buffer with what is good. One writer; buffer() may be asked from any thread.
///
/// Frames have numbers that stay, in the order in which they were first heard of.
class TfIntake {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// What came at one time.
  struct Sample {
    Time stamp{0};  // 0: nothing came
    std::uint32_t parent = kNone;
    FramePose parent_from_frame;
  };

  /// What is known of a frame and of the transform that places it in its parent.
  struct Frame {
    std::string name;
    std::uint32_t parent = kNone;  // of the transform that came last; none: only known as a parent of others
    Sample newest, before;         // before: the one that was newest until then
    std::chrono::steady_clock::time_point received;
    double latency = 0.0;  // [s] age when it was received
    double period = 0.0;   // [s] between stamps, smoothed
    bool placed = false;   // something placed it in a parent
    bool is_parent = false;
    bool from_tf = false, from_static = false;
    std::optional<Refusal> refused;
    geometry_msgs::Transform last;  // newest as it came
    std::uint32_t next = kNone;     // frame that came after it in a message
  };

  TfIntake(double max_future, double cache, std::size_t max_frames, bool simulated, Ledger& ledger);

  /// Takes in the transforms of one message; what is refused is counted and logged, the rest is kept.
  void take(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher, const Moment& now);
  /// Forgets what came on /tf: after a clock jump. Static transforms stay.
  void forgetMoving();
  /// Forgets when what came on /tf was stamped, not when it was received: the wall clock was set.
  void restamp();

  const tf2::BufferCore& buffer() const { return buffer_; }
  /// Number of a frame that was heard of, or kNone.
  std::uint32_t find(const std::string& frame) const;
  /// Frames that were heard of; their numbers are smaller.
  std::size_t known() const { return frames_.size(); }
  const Frame& frame(std::uint32_t number) const { return frames_[number]; }
  /// [s] age of the newest transform of a frame that comes on /tf.
  double ageOf(const Frame& frame, const Moment& now) const;
  /// One more whenever a frame is new or has another parent.
  std::uint64_t revision() const { return revision_; }
  /// One more whenever a transform on /tf_static was another than before.
  std::uint64_t staticRevision() const { return static_revision_; }
  /// Frames that were placed in a parent.
  std::size_t frames() const { return placed_count_; }
  /// Names of the frames that come on /tf and on /tf_static, sorted.
  const std::vector<std::string>& conflicts() const { return conflicts_; }

 private:
  void takeOne(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher,
               const Moment& now);
  void check(const geometry_msgs::TransformStamped& transform, bool is_static, const Moment& now) const;
  std::uint32_t admit(const geometry_msgs::TransformStamped& transform);
  void checkRoom(std::uint32_t parent, std::uint32_t number, const std::string& child) const;
  std::uint32_t guess(const std::string& child) const;
  std::uint32_t add(const std::string& frame);
  void noteSource(Frame& frame, bool is_static);
  void hangOn(std::uint32_t number, const std::string& parent);
  bool feed(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher);
  void forgetStamps();

  double max_future_;
  std::size_t max_frames_;
  bool simulated_;
  Ledger& ledger_;
  tf2::BufferCore buffer_;
  std::vector<Frame> frames_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::size_t placed_count_ = 0, parent_count_ = 0;
  std::uint64_t revision_ = 0, static_revision_ = 0;
  std::vector<std::string> conflicts_;
  std::uint32_t last_ = kNone;  // frame of the transform that came before this one
  std::uint64_t accepted_ = 0;  // of this message
};

}  // namespace hgrid
