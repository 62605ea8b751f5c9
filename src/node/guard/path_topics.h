// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "node/callback_threads.h"
#include "node/commons.h"
#include "node/guard/guard.h"
#include "node/wire/message_bytes.h"

namespace hgrid {

/// Subscribes to the topics of ~guard/topics, and passes the paths in their messages to the guard.
///
/// If a message is refused, the node does not know which path the robot follows. Then no robot with a path is CLEAR,
/// until the next message on this topic. Counters: "guard.received" is the sum of "guard.followed", "guard.stopped",
/// "guard.ended" (the path was over before the message arrived, so controllers ignore it, as this class does) and
/// "guard.refused.<CODE>".
class PathTopics {
 public:
  /// @param node    the names of topics are resolved in its namespace; a thread of this object reads the messages
  /// @param newest  returns the newest tick; any thread may call it
  /// All references must outlive this object.
  PathTopics(const ros::NodeHandle& node, Commons& commons, Guard& guard,
             std::function<std::shared_ptr<const Tick>()> newest);

  void start();
  /// Waits for the message that is being read, and reads no further ones.
  void stop();

 private:
  void onMessage(const ros::MessageEvent<const MessageBytes>& event, const PathTopicParams& topic);
  void take(const ros::MessageEvent<const MessageBytes>& event, const PathTopicParams& topic);

  CallbackThreads thread_;
  Commons& commons_;
  Guard& guard_;
  std::function<std::shared_ptr<const Tick>()> newest_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hgrid
