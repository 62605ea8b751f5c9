// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "node/diagnostics/ledger.h"
#include "node/tf/frame_pace.h"
#include "node/tf/frame_rivals.h"
#include "node/tf/transform_lookup.h"
#include "node/tf/transform_store.h"
#include "node/time/age_clock.h"

namespace hgrid {

/// Takes in what comes on /tf and /tf_static: decides for every transform whether it is used. One thread writes; any
/// thread may use lookup().
///
/// - checkTransform() says whether a transform is valid,
/// - FrameRivals compares those of several publishers,
/// - TransformStore stores those that are used.
///
/// One publisher at a time holds a frame of /tf. Only its transforms are used, until it stops sending. So no pose mixes
/// the transforms of two publishers. A frame of /tf_static stays static until two transforms of it have come on /tf.
class TfIntake {
 public:
  static constexpr std::uint32_t kNone = FrameTable::kNone;

  /// What is known of the transforms that place a frame in its parent.
  struct Frame {
    FramePace pace;                             // of /tf
    std::string publisher;                      // of the newest transform
    std::optional<Refusal> refused;             // why the newest transform was refused
    Time stray{0};                              // stamp of the newest transform on /tf while the frame is static
    bool from_tf = false, from_static = false;  // a transform came there at least once
    bool claimed = false;                       // claims() may know of it

    bool hasConflict() const { return from_tf && from_static; }
  };

  TfIntake(double max_future, double cache, std::size_t max_frames, bool simulated, Ledger& ledger);

  /// Takes in the transforms of one message. A refused transform is counted and logged; the others are used.
  void take(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher, const Moment& now);
  /// Forgets what came on /tf, because the clock jumped. Static transforms stay.
  void forgetMoving();
  /// Forgets the stamps of what came on /tf, because the wall clock was set. When it was received stays known.
  void restamp();

  /// Poses of frames, for any thread.
  const TransformLookup& lookup() const { return lookup_; }
  /// The clock by which poses age. The tick calls its look().
  AgeClock& ages() { return ages_; }
  const AgeClock& ages() const { return ages_; }
  /// Frames that several publishers place.
  const FrameClaims& claims() const { return rivals_.claims(); }
  /// Whether publishers fight over a frame.
  bool isContested(std::uint32_t number, Time reading) const {
    return frames_[number].claimed && claims().isContested(number, reading);
  }
  /// The frames' names, numbers and parents.
  const FrameTable& table() const { return store_.table(); }
  const Frame& frame(std::uint32_t number) const { return frames_[number]; }
  /// Where a frame was in its parent.
  const FrameHistory& history(std::uint32_t number) const { return store_.history(number); }
  /// A number that is larger whenever a transform on /tf_static was another than before.
  std::uint64_t staticRevision() const { return static_revision_; }
  /// Names of the frames that come on /tf and on /tf_static, sorted.
  const std::vector<std::string>& conflicts() const { return conflicts_; }

 private:
  /// A transform of the message that is being taken in.
  struct Arrival {
    const geometry_msgs::TransformStamped& transform;
    const std::string& publisher;
    const Moment& now;
    Time reading, stamp;

    const std::string& parent() const { return transform.header.frame_id; }
    /// Of the rotation's quaternion, as it came.
    double rotationLength() const {
      const auto& q = transform.transform.rotation;
      return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    }
    FramePose pose() const { return toFramePose(transform.transform); }
    FrameClaim claim() const { return {publisher, parent()}; }
  };

  /// How the newest transform of a frame follows the one before.
  struct Step {
    bool is_period = false;  // the time between the two tells how often transforms come
    bool continues = false;  // as in PoseSample
  };

  void takeOne(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher,
               const Moment& now);
  void takeStatic(std::uint32_t number, const Arrival& arrival);
  void takeMoving(std::uint32_t number, const Arrival& arrival);
  void takeNewest(std::uint32_t number, const Arrival& arrival, const Step& step);
  void takeOlder(std::uint32_t number, const Arrival& arrival);
  void takeRival(std::uint32_t number, const Arrival& arrival);
  bool takeRepeated(std::uint32_t number, const Arrival& arrival);
  void noteRefusal(const Refusal& refusal, const std::string& child, bool is_static, const std::string& publisher);
  void noteTopic(std::uint32_t number, bool is_static);
  bool isStream(Frame& frame, const Arrival& arrival) const;
  bool isHeld(std::uint32_t number, const Arrival& arrival) const;
  bool isFarAhead(Time stamp, const Arrival& arrival) const;
  void changeClaim(std::uint32_t number, const Arrival& arrival);
  FrameRivals::Holder holderOf(std::uint32_t number) const;
  std::uint32_t admit(const Arrival& arrival);
  void accept(Frame& frame);
  void forgetStamps();

  double max_future_;
  Ledger& ledger_;
  AgeClock ages_;
  TransformStore store_;
  TransformLookup lookup_{store_};
  std::vector<Frame> frames_;  // by number
  FrameRivals rivals_;
  std::vector<std::string> conflicts_;
  std::uint64_t static_revision_ = 0;
  std::uint64_t accepted_ = 0;  // of this message
};

}  // namespace hgrid
