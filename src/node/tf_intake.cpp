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
constexpr std::size_t kLongestChain = 1000;

Time timeOf(const ros::Time& time) { return Time(static_cast<std::int64_t>(time.toNSec())); }

bool equal(const geometry_msgs::Transform& a, const geometry_msgs::Transform& b) {
  return a.translation.x == b.translation.x && a.translation.y == b.translation.y &&
         a.translation.z == b.translation.z && a.rotation.x == b.rotation.x && a.rotation.y == b.rotation.y &&
         a.rotation.z == b.rotation.z && a.rotation.w == b.rotation.w;
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
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    try {
      takeOne(transform, is_static, publisher, now);
    } catch (const Refusal& refusal) {
      ledger_.refuse("tf.refused", refusal);
      const auto known = records_.find(withoutSlash(transform.child_frame_id));
      if (known != records_.end()) known->second.refused = refusal;
    }
  }
}

void TfIntake::check(const geometry_msgs::TransformStamped& transform, const std::string& parent,
                     const std::string& child, bool is_static, const Moment& now) const {
  const std::string what = "transform of frame '" + printable(child) + "'";
  for (const std::string& frame : {parent, child}) {
    if (frame.empty() || frame.size() > kLongestFrame) {
      throw Refusal(Code::bad_id, what + " in '" + printable(parent) + "': a frame's name has " +
                                      std::to_string(frame.size()) + " bytes; it must have 1 .. " +
                                      std::to_string(kLongestFrame));
    }
  }
  if (parent == child) throw Refusal(Code::bad_id, what + " has itself as parent; the two must differ");
  const geometry_msgs::Vector3& t = transform.transform.translation;
  const geometry_msgs::Quaternion& q = transform.transform.rotation;
  checkWithin(checkedPose({t.x, t.y, t.z}, {q.x, q.y, q.z, q.w}, what).translation(), kFarthest, what);
  if (!is_static) {
    const double ahead = seconds(timeOf(transform.header.stamp) - now.ros);
    if (now.ros.count() == 0) throw Refusal(Code::clock, what + " came before the clock; there is no time yet");
    if (ahead > max_future_) {
      throw Refusal(Code::clock, what + " is stamped " + secondsText(ahead) + " in the future; at most " +
                                     text(max_future_) + " s are allowed");
    }
  }
  const bool new_child = records_.count(child) == 0 && records_.size() >= max_frames_;
  if (new_child || (parents_.count(parent) == 0 && parents_.size() >= max_frames_)) {
    throw Refusal(Code::limit, what + " would be one more than ~max_frames, which is " + std::to_string(max_frames_));
  }
}

void TfIntake::takeOne(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher,
                       const Moment& now) {
  const std::string parent = withoutSlash(transform.header.frame_id), child = withoutSlash(transform.child_frame_id);
  check(transform, parent, child, is_static, now);
  Record& record = records_[child];
  const Time stamp = timeOf(transform.header.stamp);
  const bool was_conflict = record.from_tf && record.from_static;
  (is_static ? record.from_static : record.from_tf) = true;
  if (!was_conflict && record.from_tf && record.from_static) {
    ledger_.refuse("tf.conflict",
                   Refusal(Code::dup_id, "frame '" + printable(child) +
                                             "' comes on /tf and on /tf_static; it must come on one of them"));
  }
  if (!is_static) {
    if (stamp == record.stamp && parent == record.parent) {
      if (!equal(transform.transform, record.last)) {
        ledger_.refuse("tf.ignored", Refusal(Code::dup_id, "frame '" + printable(child) + "' came twice with stamp " +
                                                               text(seconds(stamp)) + " s and another pose (from " +
                                                               printable(publisher) + "); the first is kept"));
      }
      return;
    }
    if (record.stamp.count() > 0 && stamp > record.stamp) {
      const double step = seconds(stamp - record.stamp);
      record.period = record.period == 0.0 ? step : 0.9 * record.period + 0.1 * step;
    }
    if (stamp < record.stamp) ledger_.count("tf.out_of_order");
  }
  geometry_msgs::TransformStamped clean = transform;  // tf2 wants no slashes and a unit quaternion
  clean.header.frame_id = parent;
  clean.child_frame_id = child;
  const geometry_msgs::Quaternion& q = transform.transform.rotation;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (std::abs(norm - 1.0) > 1e-6) {
    clean.transform.rotation.x /= norm;
    clean.transform.rotation.y /= norm;
    clean.transform.rotation.z /= norm;
    clean.transform.rotation.w /= norm;
    ledger_.count("tf.renormalised");
  }
  if (!buffer_.setTransform(clean, publisher, is_static)) {
    ledger_.count("tf.too_old");
    return;
  }
  parents_.insert(parent);
  record.refused.reset();
  record.parent = parent;
  ledger_.count("tf.accepted");
  if (is_static || stamp < record.stamp) return;  // what is not newer makes nothing fresh
  record.received = now.steady;
  record.last = transform.transform;
  record.stamp = stamp;
  record.latency = std::max(0.0, seconds(now.ros - stamp));
}

void TfIntake::forgetMoving() {
  buffer_.clear();  // tf2 keeps static transforms
  for (auto& named : records_) {
    Record& record = named.second;
    record.stamp = Time(0);
    record.period = 0.0;
    record.refused.reset();
  }
}

void TfIntake::restamp() {
  buffer_.clear();
  for (auto& named : records_) named.second.stamp = Time(0);
}

double TfIntake::ageOf(const Record& record, const Moment& now) const {
  // Under /clock ages are in its time. Otherwise they are counted on the steady clock from the moment of
  // reception, so that setting the wall clock ages nothing.
  if (simulated_) return std::max(0.0, seconds(now.ros - record.stamp));
  return record.latency + std::chrono::duration<double>(now.steady - record.received).count();
}

ChainState TfIntake::chain(const std::string& target, const std::string& source, const Moment& now) const {
  ChainState state;
  // Way up from the target, then up from the source until the two meet.
  std::vector<std::string> above;
  for (std::string frame = target; std::find(above.begin(), above.end(), frame) == above.end();) {
    above.push_back(frame);
    const auto record = records_.find(frame);
    if (record == records_.end()) break;
    frame = record->second.parent;
  }
  std::vector<const Record*> way;
  std::string frame = source;
  auto met = std::find(above.begin(), above.end(), frame);
  while (met == above.end() && way.size() < kLongestChain) {
    const auto record = records_.find(frame);
    if (record == records_.end()) break;
    way.push_back(&record->second);
    frame = record->second.parent;
    met = std::find(above.begin(), above.end(), frame);
  }
  if (met == above.end()) {
    for (const std::string& end : {target, source}) {  // of two, the source is named
      if (records_.count(end) == 0 && parents_.count(end) == 0) state.unknown_frame = end;
    }
    return state;
  }
  for (auto below = above.begin(); below != met; ++below) way.push_back(&records_.at(*below));

  state.connected = true;
  for (const Record* record : way) {
    if (record->refused) state.refused = record->refused;
    if (!record->from_tf) continue;
    if (record->from_static) state.conflict = true;
    if (record->stamp.count() == 0) state.connected = false;  // nothing since the clock jumped
    state.newest = state.moves ? std::min(state.newest, record->stamp) : record->stamp;
    state.age = std::max(state.age, ageOf(*record, now));
    state.period = std::max(state.period, record->period);
    state.moves = true;
  }
  return state;
}

std::vector<std::string> TfIntake::conflicts() const {
  std::vector<std::string> frames;
  for (const auto& record : records_) {
    if (record.second.from_tf && record.second.from_static) frames.push_back(record.first);
  }
  return frames;
}

}  // namespace hgrid
