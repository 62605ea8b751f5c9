// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <map>
#include <memory>
#include <string>

#include "node/guard/joint_states.h"
#include "node/health/commons.h"
#include "node/threads/callback_threads.h"
#include "node/tick/tick.h"
#include "node/wire/message_bytes.h"

namespace hgrid {

/// Subscribes to the joint states of those robots whose joints have turns that tf does not tell apart.
class JointStateTopics {
 public:
  /// @param node  the names of topics are resolved in its namespace; a thread of this object reads the messages
  JointStateTopics(const ros::NodeHandle& node, Commons& commons, JointStates& joint_states);

  /// Subscribes to the topics of the robots of a tick, and to no others. One thread may call this, until stop().
  void follow(const Tick& tick);
  /// Waits for the message that is being read, and reads no further ones.
  void stop();

 private:
  void onMessage(const ros::MessageEvent<const MessageBytes>& event, const std::string& topic);

  CallbackThreads thread_;
  Commons& commons_;
  JointStates& joint_states_;
  std::shared_ptr<const RobotEntries> robots_;  // of the last tick
  std::map<std::string, ros::Subscriber> subscribers_;
};

}  // namespace hgrid
