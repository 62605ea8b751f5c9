// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "node/diagnostics/ledger.h"
#include "node/tf/age_clock.h"
#include "node/tf/frame_claims.h"
#include "node/tf/frame_pose.h"

namespace hgrid {

/// Reads /tf and /tf_static: checks every transform, stores when it came and from whom, and feeds a tf2 buffer with the
/// good ones. One thread writes; any thread may use buffer().
///
/// One publisher at a time holds a frame of /tf. Only its transforms are used, until it stops sending. So no pose mixes
/// the transforms of two publishers. A frame of /tf_static stays static until two transforms of it have come on /tf. A
/// frame gets a number when its name first occurs, and keeps it.
class TfIntake {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// What came at one time.
  struct Sample {
    Time stamp{0};  // 0: nothing came
    std::uint32_t parent = kNone;
    FramePose parent_from_frame;
  };

  /// A time between two transforms that do not continue each other: the frame's pose is not known then.
  struct Seam {
    Time begin{0}, end{0};
  };

  /// What is known of a frame and of the transform that places it in its parent.
  struct Frame {
    std::string name;
    std::string publisher;         // of the newest transform
    std::uint32_t parent = kNone;  // of the newest transform; none: only known as a parent of others
    Sample newest, before;         // before: the one that was newest until then
    Time received{0};              // reading of the age clock when the newest came
    Time lead{0};                  // by how much that reading was ahead of ROS time
    double period = 0.0;           // [s] between stamps, smoothed; 0: not known yet
    double step = 0.0;             // [s] between the two newest stamps
    bool moves = false;            // /tf places it, not /tf_static
    bool placed = false;           // something placed it in a parent
    bool is_parent = false;
    bool from_tf = false, from_static = false;  // it came there at least once
    bool static_in_buffer = false;              // tf2 stores it as static, for good: one pose without a time
    std::vector<Sample> history;                // static_in_buffer, moves: the newest transforms, the newest last
    bool claimed = false;                       // claims() may know of it
    Sample stray;                               // the newest on /tf while it is static
    std::vector<Seam> seams;                    // the newest last
    Time parent_since{0};                       // stamp of the first transform in the newest parent
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
  /// The clock by which poses age. The tick calls its look().
  AgeClock& ages() { return ages_; }
  const AgeClock& ages() const { return ages_; }
  /// Frames that several publishers place.
  const FrameClaims& claims() const { return claims_; }
  /// Whether publishers fight over a frame.
  bool isContested(std::uint32_t number, Time reading) const {
    return frames_[number].claimed && claims_.isContested(number, reading);
  }
  /// Number of a frame that was heard of, or kNone.
  std::uint32_t find(const std::string& frame) const;
  /// Frames that were heard of; their numbers are smaller.
  std::size_t known() const { return frames_.size(); }
  const Frame& frame(std::uint32_t number) const { return frames_[number]; }
  /// The pose of a frame in its parent at a time. Empty: it is not known for that time.
  std::optional<FramePose> parentFromFrame(const Frame& frame, Time time) const;
  /// One more whenever a frame is new or has another parent.
  std::uint64_t revision() const { return revision_; }
  /// One more whenever a transform on /tf_static was another than before.
  std::uint64_t staticRevision() const { return static_revision_; }
  /// Frames that were placed in a parent.
  std::size_t frames() const { return placed_count_; }
  /// Names of the frames that come on /tf and on /tf_static, sorted.
  const std::vector<std::string>& conflicts() const { return conflicts_; }

 private:
  /// A transform of the message that is being taken in.
  struct Arrival {
    const geometry_msgs::TransformStamped& transform;
    const std::string& publisher;
    const Moment& now;
    Time reading;
    Time stamp() const { return Time(static_cast<std::int64_t>(transform.header.stamp.toNSec())); }
    const std::string& parent() const { return transform.header.frame_id; }
  };

  void takeOne(const Arrival& arrival, bool is_static);
  void takeStatic(std::uint32_t number, const Arrival& arrival);
  void takeMoving(std::uint32_t number, const Arrival& arrival);
  void takeNewest(std::uint32_t number, const Arrival& arrival, bool continues);
  void takeOlder(std::uint32_t number, const Arrival& arrival);
  void check(const geometry_msgs::TransformStamped& transform, bool is_static, const Moment& now) const;
  void noteRefusal(const Refusal& refusal, const std::string& child, bool is_static, const std::string& publisher);
  std::uint32_t admit(const geometry_msgs::TransformStamped& transform);
  void checkRoom(std::uint32_t parent, std::uint32_t number, const std::string& child) const;
  std::uint32_t guess(const std::string& child) const;
  std::uint32_t add(const std::string& frame);
  void noteSource(Frame& frame, bool is_static);
  bool isInParent(const Frame& frame, const std::string& parent) const;
  FrameClaim claimOf(const Frame& frame) const;
  bool isFarAhead(Time stamp, const Arrival& arrival) const;
  bool isHeld(std::uint32_t number, const Arrival& arrival) const;
  bool isStream(Frame& frame, const Arrival& arrival) const;
  bool isRepeated(std::uint32_t number, const Arrival& arrival);
  void takeRival(std::uint32_t number, const Arrival& arrival);
  void compareWithRival(std::uint32_t number, Time reading);
  void judge(std::uint32_t number, const FrameClaims::RivalTransform& rival, Time reading);
  void changeClaim(std::uint32_t number, const Arrival& arrival);
  static void addSeam(Frame& frame, Time until);
  void contradict(std::uint32_t number, const FrameClaim& other, Time reading);
  void hangOn(std::uint32_t number, const std::string& parent);
  bool feed(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher);
  void accept(Frame& frame);
  static void remember(Frame& frame);
  static std::optional<FramePose> recall(const Frame& frame, Time time);
  void forgetStamps();

  double max_future_;
  Time cache_;  // how long tf2 keeps transforms
  std::size_t max_frames_;
  Ledger& ledger_;
  AgeClock ages_;
  tf2::BufferCore buffer_;
  std::vector<Frame> frames_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  FrameClaims claims_;
  std::size_t placed_count_ = 0, parent_count_ = 0;
  std::uint64_t revision_ = 0, static_revision_ = 0;
  std::vector<std::string> conflicts_;
  std::uint32_t last_ = kNone;  // frame of the transform that came before this one
  std::uint64_t accepted_ = 0;  // of this message
};

}  // namespace hgrid
