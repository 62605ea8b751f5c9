// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "tf_intake.h"

#include <algorithm>
#include <cmath>

#include "frames.h"
#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {
namespace {

constexpr double kFarthest = 1e9;           // [m] translations beyond are no place on earth
constexpr std::size_t kLongestFrame = 256;  // bytes of a frame's name

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
      max_frames_(max_frames),
      simulated_(simulated),
      ledger_(ledger),
      buffer_(ros::Duration(cache)) {}

void TfIntake::take(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher,
                    const Moment& now) {
  accepted_ = 0;
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    try {
      if (hasSlash(transform.header.frame_id) || hasSlash(transform.child_frame_id)) {
        takeOne(withoutSlashes(transform), is_static, publisher, now);
      } else {
        takeOne(transform, is_static, publisher, now);
      }
    } catch (const Refusal& refusal) {
      ledger_.refuse("tf.refused", refusal);
      const std::uint32_t known = find(withoutSlash(transform.child_frame_id));
      if (known != kNone && frames_[known].placed) frames_[known].refused = refusal;
    }
  }
  if (accepted_ > 0) ledger_.count("tf.accepted", accepted_);
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
  if (frames_[number].parent != kNone && frames_[frames_[number].parent].name == parent) return;
  std::uint32_t known = find(parent);
  if (known == kNone) known = add(parent);
  if (!frames_[known].is_parent) {
    frames_[known].is_parent = true;
    ++parent_count_;
  }
  frames_[number].parent = known;
  ++revision_;
}

bool TfIntake::feed(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher) {
  if (isUnit(transform.transform.rotation)) return buffer_.setTransform(transform, publisher, is_static);
  ledger_.count("tf.renormalised");
  return buffer_.setTransform(normalised(transform), publisher, is_static);
}

void TfIntake::takeOne(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher,
                       const Moment& now) {
  check(transform, is_static, now);
  const std::uint32_t number = admit(transform);
  noteSource(frames_[number], is_static);
  const Time stamp = timeOf(transform.header.stamp);
  if (!is_static) {
    Frame& frame = frames_[number];
    if (stamp == frame.newest.stamp && frame.parent != kNone &&
        frames_[frame.parent].name == transform.header.frame_id) {
      if (!equal(transform.transform, frame.last)) {
        ledger_.refuse("tf.ignored",
                       Refusal(Code::dup_id, "frame '" + printable(frame.name) + "' came twice with stamp " +
                                                 text(seconds(stamp)) + " s and another pose (from " +
                                                 printable(publisher) + "); the first is kept"));
      }
      return;
    }
    if (frame.newest.stamp.count() > 0 && stamp > frame.newest.stamp) {
      const double step = seconds(stamp - frame.newest.stamp);
      frame.period = frame.period == 0.0 ? step : 0.9 * frame.period + 0.1 * step;
    }
    if (stamp < frame.newest.stamp) ledger_.count("tf.out_of_order");
  }
  if (!feed(transform, is_static, publisher)) {
    ledger_.count("tf.too_old");
    return;
  }
  hangOn(number, transform.header.frame_id);
  ++accepted_;
  Frame& frame = frames_[number];
  frame.refused.reset();
  if (is_static) {
    const Sample sample{Time(0), frame.parent, toFramePose(transform.transform)};
    if (frame.from_tf || !(sample.parent_from_frame == frame.newest.parent_from_frame)) ++static_revision_;
    if (!frame.from_tf) frame.newest = sample;
    return;
  }
  if (stamp < frame.newest.stamp) return;  // what is not newer makes nothing fresh
  frame.before = frame.newest;
  frame.newest = {stamp, frame.parent, toFramePose(transform.transform)};
  frame.received = now.steady;
  frame.last = transform.transform;
  frame.latency = std::max(0.0, seconds(now.ros - stamp));
}

void TfIntake::forgetStamps() {
  buffer_.clear();  // tf2 keeps static transforms
  for (Frame& frame : frames_) frame.newest.stamp = frame.before.stamp = Time(0);
}

void TfIntake::forgetMoving() {
  forgetStamps();
  for (Frame& frame : frames_) {
    frame.period = 0.0;
    frame.refused.reset();
  }
}

void TfIntake::restamp() { forgetStamps(); }

double TfIntake::ageOf(const Frame& frame, const Moment& now) const {
  // Under /clock ages are in its time. Otherwise they are counted on the steady clock from the moment of
  // reception, so that setting the wall clock ages nothing.
  if (simulated_) return std::max(0.0, seconds(now.ros - frame.newest.stamp));
  return frame.latency + std::chrono::duration<double>(now.steady - frame.received).count();
}

}  // namespace hgrid
