// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/tf_intake.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hgrid_proximity/geometry/pose.h"
#include "node/tf/frames.h"

namespace hgrid {
namespace {

constexpr double kFarthest = 1e9;           // [m] translations beyond are no place on earth
constexpr std::size_t kLongestFrame = 256;  // bytes of a frame's name
constexpr std::size_t kMostSeams = 16;      // of a frame; with more, publishers fight over it
constexpr std::size_t kMostHistory = 64;    // transforms of a frame that tf2 takes for static
constexpr double kSameDistance = 0.01;      // [m] poses that differ by less agree: frames move between two transforms
constexpr double kSameAngle = 0.01;         // [rad]
constexpr Time kLeastPatience{50000000};    // [ns] a frame's holder may be silent for so long
constexpr Time kMostPatience{3000000000};

Time timeOf(const ros::Time& time) { return Time(static_cast<std::int64_t>(time.toNSec())); }

bool equal(const geometry_msgs::Transform& a, const geometry_msgs::Transform& b) {
  return a.translation.x == b.translation.x && a.translation.y == b.translation.y &&
         a.translation.z == b.translation.z && a.rotation.x == b.rotation.x && a.rotation.y == b.rotation.y &&
         a.rotation.z == b.rotation.z && a.rotation.w == b.rotation.w;
}

/// Whether checkedPose() and checkWithin() will accept it: most do, and need no sentence.
bool sound(const geometry_msgs::Transform& transform) {
  const geometry_msgs::Vector3& t = transform.translation;
  const geometry_msgs::Quaternion& q = transform.rotation;
  const double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  return std::abs(norm - 1.0) <= 0.5 * kQuaternionTolerance && std::abs(t.x) <= kFarthest &&
         std::abs(t.y) <= kFarthest && std::abs(t.z) <= kFarthest;
}

bool hasSlash(const std::string& frame) { return !frame.empty() && frame.front() == '/'; }

geometry_msgs::TransformStamped withoutSlashes(geometry_msgs::TransformStamped transform) {
  transform.header.frame_id = withoutSlash(transform.header.frame_id);
  transform.child_frame_id = withoutSlash(transform.child_frame_id);
  return transform;
}

/// The pose between two samples.
FramePose interpolated(const TfIntake::Sample& from, const TfIntake::Sample& to, Time time) {
  const double way = static_cast<double>((to.stamp - from.stamp).count());
  return between(from.parent_from_frame, to.parent_from_frame, static_cast<double>((time - from.stamp).count()) / way);
}

/// tf2 wants a quaternion of length 1.
bool isUnit(const geometry_msgs::Quaternion& q) {
  return std::abs(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w) - 1.0) <= 1e-6;
}

geometry_msgs::TransformStamped normalised(geometry_msgs::TransformStamped transform) {
  geometry_msgs::Quaternion& q = transform.transform.rotation;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  q.x /= norm;
  q.y /= norm;
  q.z /= norm;
  q.w /= norm;
  return transform;
}

}  // namespace

TfIntake::TfIntake(double max_future, double cache, std::size_t max_frames, bool simulated, Ledger& ledger)
    : max_future_(max_future),
      cache_(std::llround(1e9 * cache)),
      max_frames_(max_frames),
      ledger_(ledger),
      ages_(simulated),
      buffer_(ros::Duration(cache)) {}

void TfIntake::take(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher,
                    const Moment& now) {
  accepted_ = 0;
  const Time reading = ages_.read(now);
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    try {
      if (hasSlash(transform.header.frame_id) || hasSlash(transform.child_frame_id)) {
        const geometry_msgs::TransformStamped clean = withoutSlashes(transform);
        takeOne({clean, publisher, now, reading}, is_static);
      } else {
        takeOne({transform, publisher, now, reading}, is_static);
      }
    } catch (const Refusal& refusal) {
      noteRefusal(refusal, withoutSlash(transform.child_frame_id), is_static, publisher);
    }
  }
  if (accepted_ > 0) ledger_.count("tf.accepted", accepted_);
}

/// A refused transform makes a frame INVALID until a good one comes. A static frame gets no other one by itself, so
/// only the publisher that placed it can make it INVALID, on /tf_static.
void TfIntake::noteRefusal(const Refusal& refusal, const std::string& child, bool is_static,
                           const std::string& publisher) {
  ledger_.refuse("tf.refused", refusal);
  const std::uint32_t number = find(child);
  if (number == kNone || !frames_[number].placed) return;
  Frame& frame = frames_[number];
  if (frame.moves ? !is_static : is_static && frame.publisher == publisher) frame.refused = refusal;
}

std::uint32_t TfIntake::find(const std::string& frame) const {
  const auto found = numbers_.find(frame);
  return found == numbers_.end() ? kNone : found->second;
}

/// Messages name the same frames in the same order again and again: the one that came next the last time is nearly
/// always the right one, and looking is dearer than comparing.
std::uint32_t TfIntake::guess(const std::string& child) const {
  const std::uint32_t next = last_ == kNone ? kNone : frames_[last_].next;
  return next != kNone && frames_[next].name == child ? next : find(child);
}

std::uint32_t TfIntake::add(const std::string& frame) {
  const auto number = static_cast<std::uint32_t>(frames_.size());
  frames_.emplace_back();
  frames_.back().name = frame;
  numbers_.emplace(frame, number);
  ++revision_;
  return number;
}

void TfIntake::check(const geometry_msgs::TransformStamped& transform, bool is_static, const Moment& now) const {
  const std::string &parent = transform.header.frame_id, &child = transform.child_frame_id;
  const auto what = [&] { return "transform of frame '" + printable(child) + "'"; };
  for (const std::string* frame : {&parent, &child}) {
    if (frame->empty() || frame->size() > kLongestFrame) {
      throw Refusal(Code::bad_id, what() + " in '" + printable(parent) + "': a frame's name has " +
                                      std::to_string(frame->size()) + " bytes; it must have 1 .. " +
                                      std::to_string(kLongestFrame));
    }
  }
  if (parent == child) throw Refusal(Code::bad_id, what() + " has itself as parent; the two must differ");
  if (!sound(transform.transform)) {
    const geometry_msgs::Vector3& t = transform.transform.translation;
    const geometry_msgs::Quaternion& q = transform.transform.rotation;
    checkWithin(checkedPose({t.x, t.y, t.z}, {q.x, q.y, q.z, q.w}, what()).translation(), kFarthest, what());
  }
  if (!is_static) {
    const double ahead = seconds(timeOf(transform.header.stamp) - now.ros);
    if (now.ros.count() == 0) throw Refusal(Code::clock, what() + " came before the clock; there is no time yet");
    if (transform.header.stamp.isZero()) {
      throw Refusal(Code::clock, what() + " has stamp 0; a transform on /tf must have the time of its data");
    }
    if (ahead > max_future_) {
      throw Refusal(Code::clock, what() + " is stamped " + secondsText(ahead) + " in the future; at most " +
                                     text(max_future_) + " s are allowed");
    }
  }
}

void TfIntake::checkRoom(std::uint32_t parent, std::uint32_t number, const std::string& child) const {
  const bool new_child = number == kNone || !frames_[number].placed;
  const bool new_parent = parent == kNone || !frames_[parent].is_parent;
  if ((new_child && placed_count_ >= max_frames_) || (new_parent && parent_count_ >= max_frames_)) {
    throw Refusal(Code::limit, "transform of frame '" + printable(child) +
                                   "' would be one more than ~max_frames, which is " + std::to_string(max_frames_));
  }
}

/// Number of the frame that a transform places; a new one is added if there is room.
std::uint32_t TfIntake::admit(const geometry_msgs::TransformStamped& transform) {
  const std::string &parent = transform.header.frame_id, &child = transform.child_frame_id;
  std::uint32_t number = guess(child);
  const bool same_parent =
      number != kNone && frames_[number].parent != kNone && frames_[frames_[number].parent].name == parent;
  if (!same_parent) {
    checkRoom(find(parent), number, child);
    if (number == kNone) number = add(child);
    if (!frames_[number].placed) {
      frames_[number].placed = true;
      ++placed_count_;
      ++revision_;
    }
  }
  if (last_ != kNone) frames_[last_].next = number;
  return last_ = number;
}

void TfIntake::noteSource(Frame& frame, bool is_static) {
  const bool was_conflict = frame.from_tf && frame.from_static;
  (is_static ? frame.from_static : frame.from_tf) = true;
  if (was_conflict || !frame.from_tf || !frame.from_static) return;
  conflicts_.insert(std::lower_bound(conflicts_.begin(), conflicts_.end(), frame.name), frame.name);
  ledger_.refuse("tf.conflict", Refusal(Code::conflict, "frame '" + printable(frame.name) +
                                                            "' comes on /tf and on /tf_static; it must come on one of "
                                                            "them"));
}

void TfIntake::hangOn(std::uint32_t number, const std::string& parent) {
  if (isInParent(frames_[number], parent)) return;
  std::uint32_t known = find(parent);
  if (known == kNone) known = add(parent);
  if (!frames_[known].is_parent) {
    frames_[known].is_parent = true;
    ++parent_count_;
  }
  frames_[number].parent = known;
  ++revision_;
}

bool TfIntake::isInParent(const Frame& frame, const std::string& parent) const {
  return frame.parent != kNone && frames_[frame.parent].name == parent;
}

FrameClaim TfIntake::claimOf(const Frame& frame) const {
  return {frame.publisher, frame.parent == kNone ? std::string() : frames_[frame.parent].name};
}

bool TfIntake::feed(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher) {
  if (isUnit(transform.transform.rotation)) return buffer_.setTransform(transform, publisher, is_static);
  ledger_.count("tf.renormalised");
  return buffer_.setTransform(normalised(transform), publisher, is_static);
}

void TfIntake::takeOne(const Arrival& arrival, bool is_static) {
  check(arrival.transform, is_static, arrival.now);
  const std::uint32_t number = admit(arrival.transform);
  noteSource(frames_[number], is_static);
  if (is_static) {
    takeStatic(number, arrival);
  } else {
    takeMoving(number, arrival);
  }
}

void TfIntake::accept(Frame& frame) {
  ++accepted_;
  frame.refused.reset();
}

/// The stamp of a static transform means nothing. A frame that moved becomes static again if nothing comes on /tf any
/// more.
void TfIntake::takeStatic(std::uint32_t number, const Arrival& arrival) {
  Frame& frame = frames_[number];
  const bool moved = frame.moves;
  if (moved && arrival.reading - frame.received <= kMostPatience) {
    ledger_.count("tf.ignored.CONFLICT");
    return;
  }
  if (!moved || frame.static_in_buffer) {  // tf2 cannot make a static frame of one that moved
    frame.static_in_buffer = feed(arrival.transform, true, arrival.publisher);
  }
  hangOn(number, arrival.parent());
  Frame& placed = frames_[number];  // hangOn() may have added a frame
  const Sample sample{Time(0), placed.parent, toFramePose(arrival.transform.transform)};
  const bool same = !moved && sample.parent_from_frame == placed.newest.parent_from_frame;
  if (!same) ++static_revision_;
  placed.newest = sample;
  placed.before = placed.stray = Sample{};
  placed.seams.clear();
  placed.history.clear();
  placed.publisher = arrival.publisher;
  placed.moves = false;
  placed.period = placed.step = 0.0;
  accept(placed);
}

/// Whether this is more than a single transform on /tf of a static frame.
bool TfIntake::isStream(Frame& frame, const Arrival& arrival) const {
  const bool again = frame.stray.stamp.count() > 0 && arrival.stamp() > frame.stray.stamp &&
                     arrival.reading - frame.received <= kMostPatience;
  frame.stray.stamp = arrival.stamp();
  frame.received = arrival.reading;
  return again;
}

/// Whether another publisher holds the frame. A holder may send nothing for two periods. It may do so for longer while
/// the frame is contested, so that the holder does not change at each gap in its stream.
bool TfIntake::isHeld(std::uint32_t number, const Arrival& arrival) const {
  const Frame& frame = frames_[number];
  if (!frame.moves || frame.newest.stamp.count() == 0 || frame.publisher == arrival.publisher) return false;
  const Time periods(static_cast<std::int64_t>(2e9 * frame.period));
  const Time patience =
      isContested(number, arrival.reading) ? kMostPatience : std::min(kMostPatience, std::max(kLeastPatience, periods));
  return arrival.reading - frame.received <= patience;
}

/// Whether the frame's newest stamp came again. If the rest is not the same, that is counted or is a contradiction.
bool TfIntake::isRepeated(std::uint32_t number, const Arrival& arrival) {
  const Frame& frame = frames_[number];
  if (arrival.stamp() != frame.newest.stamp) return false;
  const bool same_parent = isInParent(frame, arrival.parent());
  if (same_parent && equal(arrival.transform.transform, frame.last)) return true;
  if (frame.publisher != arrival.publisher) {
    takeRival(number, arrival);
    return true;
  }
  ledger_.refuse("tf.ignored", Refusal(Code::dup_id, "frame '" + printable(frame.name) + "' came twice with stamp " +
                                                         text(seconds(arrival.stamp())) + " s and another " +
                                                         (same_parent ? "pose" : "parent") + " (from " +
                                                         printable(arrival.publisher) + "); the first is kept"));
  if (!same_parent) {
    frames_[number].claimed = true;
    contradict(number, {arrival.publisher, arrival.parent()}, arrival.reading);
  }
  return true;
}

bool TfIntake::isFarAhead(Time stamp, const Arrival& arrival) const { return stamp > arrival.now.ros + cache_ / 2; }

void TfIntake::takeMoving(std::uint32_t number, const Arrival& arrival) {
  if (frames_[number].from_static && !frames_[number].moves && !isStream(frames_[number], arrival)) {
    ledger_.count("tf.ignored.CONFLICT");
    return;
  }
  if (frames_[number].moves && isRepeated(number, arrival)) return;
  if (isHeld(number, arrival)) return takeRival(number, arrival);
  const Frame& frame = frames_[number];
  const Time stamp = arrival.stamp();
  // A stamp far ahead of the clock is the newest only until a transform comes whose stamp is not ahead.
  const bool was_ahead = isFarAhead(frame.newest.stamp, arrival) && stamp <= arrival.now.ros;
  const bool first = !frame.moves || frame.newest.stamp.count() == 0;
  if (!first && stamp < frame.newest.stamp && !was_ahead) return takeOlder(number, arrival);
  const bool other = !first && (frame.publisher != arrival.publisher || !isInParent(frame, arrival.parent()));
  if (other) changeClaim(number, arrival);
  if (!first && !other && stamp > frame.newest.stamp + cache_)
    addSeam(frames_[number], stamp);  // tf2 dropped the old one
  takeNewest(number, arrival, !first && !other && !was_ahead);
}

/// @param continues  the frame moved from its newest transform so far to this one
void TfIntake::takeNewest(std::uint32_t number, const Arrival& arrival, bool continues) {
  // tf2 would refuse all that comes after a stamp far ahead.
  if (!isFarAhead(arrival.stamp(), arrival)) feed(arrival.transform, false, arrival.publisher);
  const bool same_parent = isInParent(frames_[number], arrival.parent());
  hangOn(number, arrival.parent());
  Frame& frame = frames_[number];
  const Time stamp = arrival.stamp();
  if (!frame.moves) frame.newest = Sample{};
  if (continues) {
    const double before = std::exchange(frame.step, seconds(stamp - frame.newest.stamp));
    const double usual = std::min(before, frame.step);  // a single long step is an outage, not a period
    frame.period = frame.period == 0.0 ? usual : 0.9 * frame.period + 0.1 * usual;
  } else if (frame.publisher != arrival.publisher || !same_parent) {
    frame.period = frame.step = 0.0;
  }
  const bool behind = stamp < frame.newest.stamp;
  if (!same_parent) frame.parent_since = frame.placed && frame.newest.stamp.count() > 0 ? stamp : Time(0);
  frame.before = behind ? Sample{} : frame.newest;
  frame.newest = {stamp, frame.parent, toFramePose(arrival.transform.transform)};
  frame.received = arrival.reading;
  frame.lead = arrival.reading - arrival.now.ros;
  if (frame.publisher != arrival.publisher) frame.publisher = arrival.publisher;
  frame.last = arrival.transform.transform;
  frame.moves = true;
  if (frame.static_in_buffer) remember(frame);
  accept(frame);
  if (frame.claimed) compareWithRival(number, arrival.reading);
}

/// Takes a transform that is not the newest. It makes no pose fresh, but the frame is known at its time.
void TfIntake::takeOlder(std::uint32_t number, const Arrival& arrival) {
  Frame& frame = frames_[number];
  if (frame.publisher != arrival.publisher || !isInParent(frame, arrival.parent())) return takeRival(number, arrival);
  ledger_.count("tf.out_of_order");
  const Time stamp = arrival.stamp();
  const bool before_claim = !frame.seams.empty() && stamp < frame.seams.back().end;
  if (before_claim || !feed(arrival.transform, false, arrival.publisher)) {
    ledger_.count("tf.too_old");
    return;
  }
  if (stamp >= arrival.now.ros) frame.received = arrival.reading;  // the newest is stamped farther ahead
  if (stamp > frame.before.stamp) frame.before = {stamp, frame.parent, toFramePose(arrival.transform.transform)};
  accept(frame);
}

/// Takes a transform of a publisher that does not hold the frame. It is compared, not used.
void TfIntake::takeRival(std::uint32_t number, const Arrival& arrival) {
  Frame& frame = frames_[number];
  frame.claimed = true;
  ledger_.count("tf.rival");
  const FrameClaims::RivalTransform rival{
      {arrival.publisher, arrival.parent()}, arrival.stamp(), toFramePose(arrival.transform.transform)};
  if (rival.stamp <= frame.newest.stamp) {
    judge(number, rival, arrival.reading);
  } else {
    claims_.keep(number, rival);
  }
}

/// Compares the transform of a rival that waits, if the holder has caught up with its stamp.
void TfIntake::compareWithRival(std::uint32_t number, Time reading) {
  const auto rival = claims_.take(number, frames_[number].newest.stamp);
  if (rival) judge(number, *rival, reading);
}

/// Compares a transform of a rival with the holder's pose at its stamp.
void TfIntake::judge(std::uint32_t number, const FrameClaims::RivalTransform& rival, Time reading) {
  const Frame& frame = frames_[number];
  if (isInParent(frame, rival.claim.parent)) {
    if (rival.claim.publisher == frame.publisher) return;  // it holds the frame by now
    const std::optional<FramePose> held = parentFromFrame(frame, rival.stamp);
    if (!held) return;  // the holder's transforms do not reach back to that time
    const double turn = held->rotation.angularDistance(rival.parent_from_frame.rotation);
    const double apart = (held->translation - rival.parent_from_frame.translation).norm();
    if (apart <= kSameDistance && turn <= kSameAngle) return;
  }
  contradict(number, rival.claim, reading);
}

/// Another publisher or parent places the frame from this transform on. Between the transform before and this one the
/// pose of the frame is not known.
void TfIntake::changeClaim(std::uint32_t number, const Arrival& arrival) {
  Frame& frame = frames_[number];
  const FrameClaim before = claimOf(frame), after{arrival.publisher, arrival.parent()};
  frame.claimed = true;
  if (claims_.change(number, before, after, arrival.reading)) contradict(number, after, arrival.reading);
  addSeam(frame, arrival.stamp());
  if (before.parent != after.parent) return;
  geometry_msgs::TransformStamped held;  // so that tf2 does not interpolate from one publisher to the other
  held.header.frame_id = after.parent;
  held.child_frame_id = frame.name;
  held.header.stamp.fromNSec(static_cast<std::uint64_t>(arrival.stamp().count() - 1));
  held.transform = frame.last;
  feed(held, false, before.publisher);
}

/// From the newest transform so far to one of the time `until` the pose is not known.
void TfIntake::addSeam(Frame& frame, Time until) {
  if (frame.seams.size() >= kMostSeams) frame.seams.erase(frame.seams.begin());
  frame.seams.push_back({frame.newest.stamp, until});
}

void TfIntake::contradict(std::uint32_t number, const FrameClaim& other, Time reading) {
  claims_.contradict(number, frames_[number].name, claimOf(frames_[number]), other, reading);
  ledger_.refuse("tf.fight", Refusal(Code::conflict, claims_.sentence(number)));
}

void TfIntake::remember(Frame& frame) {
  if (frame.newest.stamp < frame.before.stamp || frame.before.stamp.count() == 0) frame.history.clear();
  if (frame.history.size() >= kMostHistory) frame.history.erase(frame.history.begin());
  frame.history.push_back(frame.newest);
}

std::optional<FramePose> TfIntake::recall(const Frame& frame, Time time) {
  for (std::size_t i = frame.history.size(); i > 1; --i) {
    const Sample &from = frame.history[i - 2], &to = frame.history[i - 1];
    if (time < from.stamp) continue;
    if (time > to.stamp || from.parent != frame.parent || to.parent != frame.parent) return std::nullopt;
    return interpolated(from, to, time);
  }
  return std::nullopt;
}

std::optional<FramePose> TfIntake::parentFromFrame(const Frame& frame, Time time) const {
  const Sample &newest = frame.newest, &before = frame.before;
  if (!frame.moves || time == newest.stamp) return newest.parent_from_frame;
  if (time > newest.stamp || time < frame.parent_since) return std::nullopt;
  for (const Seam& seam : frame.seams) {
    if (time > seam.begin && time < seam.end) return std::nullopt;
  }
  if (before.stamp.count() > 0 && before.parent == newest.parent && time >= before.stamp) {
    return interpolated(before, newest, time);
  }
  if (frame.static_in_buffer) return recall(frame, time);
  try {
    return toFramePose(buffer_
                           .lookupTransform(frames_[frame.parent].name, frame.name,
                                            ros::Time().fromNSec(static_cast<std::uint64_t>(time.count())))
                           .transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

void TfIntake::forgetStamps() {
  buffer_.clear();  // tf2 keeps static transforms
  claims_.forgetTransforms();
  for (Frame& frame : frames_) {
    frame.newest.stamp = frame.before.stamp = frame.stray.stamp = frame.parent_since = Time(0);
    frame.seams.clear();
    frame.history.clear();
  }
}

void TfIntake::forgetMoving() {
  forgetStamps();
  for (Frame& frame : frames_) {
    frame.period = frame.step = 0.0;
    if (frame.moves) frame.refused.reset();
  }
}

void TfIntake::restamp() { forgetStamps(); }

}  // namespace hgrid
