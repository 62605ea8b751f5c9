// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/joint_state_topics.h"

#include <boost/make_shared.hpp>
#include <set>

#include "node/guard/guarded_joints.h"
#include "node/guard/path_message_types.h"
#include "node/health/guarded.h"
#include "node/time/ros_time.h"
#include "node/wire/bytes_subscriber.h"

namespace hgrid {
namespace {

constexpr const char* kJointState = "3066dcd76a6cfaef579bd0f34173e9fd";
constexpr std::size_t kMostStateBytes = 1 << 20;  // of a message
constexpr int kStateQueue = 10;  // messages of one topic that wait to be read; a robot may have several publishers

}  // namespace

JointStateTopics::JointStateTopics(const ros::NodeHandle& node, Commons& commons, JointStates& joint_states)
    : thread_(node, node), commons_(commons), joint_states_(joint_states) {}

void JointStateTopics::follow(const Tick& tick) {
  if (tick.robots == robots_) return;
  robots_ = tick.robots;
  std::set<std::string> wanted;
  for (const auto& [name, entry] : *robots_) {
    if (entry.inWorld() && entry.spec && mayHideTurns(*entry.model)) {
      wanted.insert(jointStatesTopic(entry.spec->params));
    }
  }
  for (auto it = subscribers_.begin(); it != subscribers_.end();) {
    const auto next = std::next(it);
    if (wanted.count(it->first) == 0) {
      joint_states_.forget(it->first);
      subscribers_.erase(it);
    }
    it = next;
  }
  for (const std::string& topic : wanted) {
    ros::Subscriber& subscriber = subscribers_[topic];
    if (subscriber) continue;
    ros::SubscribeOptions options = bytesOptions(topic, kStateQueue, kMostStateBytes,
                                                 [this, topic](const BytesEvent& event) { onMessage(event, topic); });
    guarded(commons_.ledger, "guard.joint_states.failed",
            [&] { subscriber = ros::NodeHandle(thread_.node()).subscribe(options); });
  }
  if (!subscribers_.empty()) thread_.setThreads(1);
}

void JointStateTopics::stop() {
  subscribers_.clear();
  thread_.stop();
}

void JointStateTopics::onMessage(const ros::MessageEvent<const MessageBytes>& event, const std::string& topic) {
  guarded(commons_.ledger, "guard.joint_states.failed", [&] {
    const MessageBytes& message = *event.getConstMessage();
    if (message.size > kMostStateBytes || md5Of(event) != kJointState) {
      throw Refusal(Code::unsupported, "a message on " + topic +
                                           " was refused: it must be sensor_msgs/JointState, of " +
                                           std::to_string(kMostStateBytes) + " bytes at most");
    }
    joint_states_.take(topic, readMessage<moveit::JointState>(message.bytes), fromRos(event.getReceiptTime()));
  });
}

}  // namespace hgrid
