// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "node/health/ledger.h"
#include "node/tf/frame_pace.h"
#include "node/tf/frame_rivals.h"
#include "node/tf/publisher_clocks.h"
#include "node/tf/publisher_name.h"
#include "node/tf/tf_news.h"
#include "node/tf/transform_lookup.h"
#include "node/tf/transform_store.h"
#include "node/time/age_clock.h"
#include "node/wire/transform_view.h"

namespace hgrid {

/// Receives the transforms of /tf and /tf_static, and decides for each one whether it is used. Only one thread
/// at a time may use this class (see TfReader::Hold), except that any thread may use lookup().
///
/// - checkTransform() checks whether a transform is valid.
/// - FrameRivals compares the transforms of several publishers of one frame.
/// - TransformStore stores the transforms that are used.
///
/// One publisher at a time holds a frame of /tf. Only its transforms are used, until it stops sending. So no pose mixes
/// the transforms of two publishers. A static frame starts to move only after two transforms of it arrived on /tf.
class TfIntake {
 public:
  static constexpr std::uint32_t kNone = FrameTable::kNone;

  /// What is known about the transforms that place a frame in its parent. It fills one line of the processor's cache,
  /// because take() reads it for each transform.
  struct alignas(64) Frame {
    FramePace pace;                             // pace of the transforms on /tf
    SharedName publisher;                       // publisher of the newest transform
    Time stray{0};                              // stamp of the newest transform on /tf while the frame is static
    bool from_tf = false, from_static = false;  // whether a transform arrived on /tf, or on /tf_static
    bool claimed = false;                       // whether claims() may have an entry for this frame
    bool refused = false;                       // whether the newest transform was refused; see refusal()

    bool hasConflict() const { return from_tf && from_static; }
  };
  static_assert(sizeof(Frame) == 64);

  /// @param max_future   [s] how far a stamp may be ahead of ROS time
  /// @param cache        [s] how long transforms are kept
  /// @param max_frames   limits the number of frames, as in FrameTable
  /// @param simulated    whether /clock drives ROS time
  /// @param max_samples  how many transforms of one frame are kept
  /// @param max_wait     [s] how long a tick may wait for slower frames, as in TickTime
  TfIntake(double max_future, double cache, std::size_t max_frames, bool simulated, Ledger& ledger,
           std::size_t max_samples = TransformStore::kMaxSamples, double max_wait = 0.1);

  /// Handles transforms of one message. Counts and logs each refused transform, and uses the others. Another thread
  /// that uses lookup() waits meanwhile, except while a line is written to the log.
  void take(const std::vector<TransformView>& transforms, bool is_static, const std::string& publisher,
            const Moment& now);
  /// Sets which frames bodies need. There is room for them even if there are too many other frames.
  void need(const std::vector<std::string>& names, const Moment& now);
  /// Sets the names of the free frames: those that a planar or floating joint moves. Their static poses are not used.
  void setFree(std::set<std::string, std::less<>> names);
  /// Drops the stamps and periods of all frames of /tf. Call this after a simulated clock jumped back. Static
  /// transforms stay.
  void forgetMoving();
  /// Drops the stamps of all transforms of /tf, but not their arrival times. Call this after the wall clock was set.
  void restamp();

  /// Returns what has arrived since the last tick.
  TfNews& news() { return news_; }
  const TfNews& news() const { return news_; }
  /// Returns which publishers of /tf send stamps that are constantly early or late.
  const PublisherClocks& publisherClocks() const { return publisher_clocks_; }
  /// Returns the object that looks up poses of frames. Any thread may use it.
  const TransformLookup& lookup() const { return lookup_; }
  /// Returns the clock that measures the age of poses. Each tick calls its look().
  AgeClock& ages() { return ages_; }
  const AgeClock& ages() const { return ages_; }
  /// Returns what is known about frames that several publishers place.
  const FrameClaims& claims() const { return rivals_.claims(); }
  /// Whether a frame is contested: two publishers place it differently.
  bool isContested(std::uint32_t number, Time reading) const {
    return frames_[number].claimed && claims().isContested(number, reading);
  }
  /// Returns the names, numbers and parents of all frames.
  const FrameTable& table() const { return store_.table(); }
  const Frame& frame(std::uint32_t number) const { return frames_[number]; }
  /// Returns why the newest transform of a frame was refused. Null: it was not.
  const Refusal* refusal(std::uint32_t number) const;
  /// Does the same as TransformStore::isFreeButStatic().
  bool isFreeButStatic(std::uint32_t number) const { return store_.isFreeButStatic(number); }
  /// Returns the stored poses of a frame in its parent.
  const FrameHistory& history(std::uint32_t number) const { return store_.history(number); }
  /// Returns a number that increases whenever a static frame gets another pose, or one that is used or not.
  std::uint64_t staticRevision() const { return static_revision_; }
  /// Returns the names of the frames that are published on both /tf and /tf_static, sorted.
  const std::vector<std::string>& conflicts() const { return conflicts_; }

 private:
  /// The message of one call of take().
  struct Message {
    bool is_static;
    MessagePublisher publisher;
    const Moment& now;
    Time reading;
  };
  /// One transform of the message that take() is handling.
  struct Arrival {
    TransformView transform;  // its names begin with no slash
    MessagePublisher& publisher;
    const Moment& now;
    Time reading, stamp;
    bool same_publisher = false;  // whether the newest transform of the frame has the same publisher
    bool same_parent = false;     // whether the newest transform of the frame has the same parent

    FramePose pose() const { return toFramePose(transform); }
    FrameClaim claim() const { return {publisher.name(), std::string(transform.parent)}; }
  };

  static constexpr std::size_t kAhead = 16;  // number of transforms whose frames are found together

  /// How the newest transform of a frame relates to the previous one.
  struct Step {
    bool is_period = false;  // whether the time between the two stamps is a period of the frame
    bool continues = false;  // as in PoseSample
  };

  std::array<std::uint32_t, kAhead> findFrames(const TransformView* transforms, std::size_t count);
  void takeSome(const TransformView* transforms, std::size_t count, Message& message);
  void takeOne(const TransformView& transform, Message& message, std::uint32_t known = kNone);
  void takeStatic(std::uint32_t number, const Arrival& arrival);
  void takeMoving(std::uint32_t number, const Arrival& arrival);
  void takeNewest(std::uint32_t number, const Arrival& arrival, const Step& step);
  void takeOlder(std::uint32_t number, const Arrival& arrival);
  void takeRival(std::uint32_t number, const Arrival& arrival);
  void takeRepeated(std::uint32_t number, const Arrival& arrival);
  void noteRefusal(const Refusal& refusal, std::string_view child, Message& message);
  void noteTopic(std::uint32_t number, bool is_static);
  void report(const char* where, const Refusal& refusal);
  bool isStream(Frame& frame, const Arrival& arrival) const;
  bool isHeld(std::uint32_t number, const Arrival& arrival) const;
  bool isFarAhead(Time stamp, const Arrival& arrival) const;
  void changeClaim(std::uint32_t number, const Arrival& arrival);
  FrameRivals::Holder holderOf(std::uint32_t number) const;
  std::uint32_t admit(Arrival& arrival, bool is_static, std::uint32_t known);
  void accept(std::uint32_t number);
  void forgetRefusal(std::uint32_t number);
  void forgetStamps();
  void keepLate(const TransformView& transform, const std::string& publisher);
  void takeLate(const Moment& now);

  /// A static transform that found no room, and its publisher.
  struct Late {
    std::string parent, publisher;
    TransformView transform;  // its names refer to a message that is gone
  };

  double max_future_;
  const std::size_t most_late_;
  Ledger& ledger_;
  AgeClock ages_;
  TransformStore store_;
  TransformLookup lookup_{store_};
  std::vector<Frame> frames_;                  // indexed by frame number
  std::map<std::uint32_t, Refusal> refusals_;  // of the frames whose newest transform was refused
  FrameRivals rivals_;
  TfNews news_;
  PublisherClocks publisher_clocks_;
  std::vector<std::string> conflicts_;
  // By child. Static transforms are sent only once, and a body may need them later.
  std::map<std::string, Late, std::less<>> late_;
  std::uint64_t static_revision_ = 0;
  std::uint64_t accepted_ = 0;  // number of accepted transforms of the current message
  Time newest_stamp_{0};        // newest stamp of the accepted transforms of the current message on /tf; 0: none
};

}  // namespace hgrid
