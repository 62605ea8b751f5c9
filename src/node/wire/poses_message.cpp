// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/wire/poses_message.h"

#include <geometry_msgs/TransformStamped.h>
#include <hgrid_proximity/Poses.h>

#include <algorithm>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/wire/checked.h"

namespace hgrid {
namespace {

namespace msg = ::hgrid_proximity;

constexpr std::size_t kLongestFrameName = 256;  // [byte]

/// @throws Refusal bad_geometry unless the list has one entry, or `width` values, for each pose
void checkLength(const char* list, std::size_t length, std::size_t poses, std::size_t width, bool may_be_empty) {
  if (length == width * poses || (may_be_empty && length == 0)) return;
  throw Refusal(Code::bad_geometry, std::string(list) + " has " + std::to_string(length) + " values for " +
                                        std::to_string(poses) + " poses; it must have " +
                                        std::to_string(width * poses) + (may_be_empty ? " or be empty" : ""));
}

void checkLengths(const msg::Poses& poses) {
  const std::size_t count = poses.position.size();
  checkLength("index", poses.index.size(), count, 1, true);
  checkLength("orientation", poses.orientation.size(), count, 1, false);
  checkLength("linear_velocity", poses.linear_velocity.size(), count, 1, true);
  checkLength("angular_velocity", poses.angular_velocity.size(), count, 1, true);
  checkLength("covariance", poses.covariance.size(), count, 36, true);
}

/// Returns which name a pose belongs to.
std::size_t nameOf(const msg::Poses& poses, std::size_t pose) { return poses.index.empty() ? pose : poses.index[pose]; }

/// @throws Refusal out_of_range
void checkIndices(const msg::Poses& poses, std::size_t names) {
  for (std::size_t pose = 0; pose < poses.position.size(); ++pose) {
    if (nameOf(poses, pose) < names) continue;
    throw Refusal(Code::out_of_range, "pose " + std::to_string(pose) + " is of name " +
                                          std::to_string(nameOf(poses, pose)) + ", but there are only " +
                                          std::to_string(names) + " names");
  }
}

/// Returns the bytes of a tf2_msgs/TFMessage. @param frames  tf frames of the names @throws Refusal limit
std::string serialized(const msg::Poses& poses, const std::vector<std::string>& frames, std::size_t most_bytes) {
  geometry_msgs::TransformStamped transform;
  transform.header = poses.header;
  const auto without_frame = static_cast<std::size_t>(ros::serialization::serializationLength(transform));
  std::size_t size = sizeof(std::uint32_t);
  for (std::size_t i = 0; i < poses.position.size(); ++i) size += without_frame + frames[nameOf(poses, i)].size();
  if (size > most_bytes) {
    throw Refusal(Code::limit, "its " + std::to_string(poses.position.size()) + " poses need " + std::to_string(size) +
                                   " bytes as transforms; at most " + std::to_string(most_bytes) +
                                   " are accepted (~limits/tf_queue_bytes)");
  }
  std::string result(size, '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&result[0]), static_cast<std::uint32_t>(size));
  stream.next(static_cast<std::uint32_t>(poses.position.size()));
  for (std::size_t i = 0; i < poses.position.size(); ++i) {
    const geometry_msgs::Point& position = poses.position[i];
    transform.child_frame_id = frames[nameOf(poses, i)];
    transform.transform.translation.x = position.x;
    transform.transform.translation.y = position.y;
    transform.transform.translation.z = position.z;
    transform.transform.rotation = poses.orientation[i];
    stream.next(transform);
  }
  return result;
}

}  // namespace

std::string posesFrameOf(const std::string& obstacle) {
  return std::string(kPosesFrame) + obstacle.substr(std::min(obstacle.size(), obstacle.find('/')));
}

std::string PosesConverter::toTransforms(const std::string& bytes, const std::string& publisher) {
  Checked<msg::Poses> checked;
  checked.read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const msg::Poses& poses = checked.value();
  checkLengths(poses);
  if (poses.names.size() > most_names_) {
    throw Refusal(Code::limit, "it has " + std::to_string(poses.names.size()) + " names; at most " +
                                   std::to_string(most_names_) + " are allowed (~limits/max_bodies)");
  }
  if (poses.header.frame_id.size() > kLongestFrameName) {
    throw Refusal(Code::limit, "its frame_id has " + std::to_string(poses.header.frame_id.size()) + " bytes; at most " +
                                   std::to_string(kLongestFrameName) + " are allowed");
  }
  const Key key(publisher, poses.names_version);
  if (poses.names.empty()) {
    const auto known = lists_.find(key);
    if (known == lists_.end()) {
      throw Refusal(Code::unknown_id, "it has no names, and no message of this publisher had the names of version " +
                                          std::to_string(poses.names_version) + "; send the names again");
    }
    known->second.used = ++messages_;
    checkIndices(poses, known->second.frames.size());
    return serialized(poses, known->second.frames, most_bytes_);
  }
  std::vector<std::string> frames;
  for (const std::string& name : poses.names) {
    checkLocal(name, "a name");
    frames.push_back(std::string(kPosesFrame) + "/" + name);
  }
  checkIndices(poses, frames.size());
  std::string result = serialized(poses, frames, most_bytes_);
  store(key, std::move(frames));
  return result;
}

/// Stores a list of names. Forgets the lists that were not used for longest, if there are too many lists or names.
void PosesConverter::store(const Key& key, std::vector<std::string> frames) {
  const auto forget = [this](std::map<Key, Names>::iterator list) {
    stored_ -= list->second.frames.size();
    lists_.erase(list);
  };
  const auto old = lists_.find(key);
  if (old != lists_.end()) forget(old);
  while (!lists_.empty() && (lists_.size() >= kMostLists || stored_ + frames.size() > 4 * most_names_)) {
    forget(std::min_element(lists_.begin(), lists_.end(),
                            [](const auto& a, const auto& b) { return a.second.used < b.second.used; }));
  }
  const std::size_t count = frames.size();
  lists_[key] = {std::move(frames), ++messages_};
  stored_ += count;
}

}  // namespace hgrid
