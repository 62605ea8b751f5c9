// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "node/guard/action_goals.h"
#include "node/guard/guard.h"
#include "node/guard/path_message.h"
#include "node/health/commons.h"
#include "node/threads/callback_threads.h"
#include "node/wire/message_bytes.h"

namespace hgrid {

/// Subscribes to the topics of ~guard/topics, and passes the paths in their messages to the guard. For the topic goal
/// of an action, it also subscribes to the topics cancel, status and result, and follows what becomes of the goals.
///
/// If a message with a path is refused, the node does not know which path the robot follows. Then no robot with a path
/// is CLEAR, until the next message on this topic. Counters: "guard.received" is the sum of "guard.followed",
/// "guard.stopped", "guard.ended" (the path was over before the message arrived, or the server of the action has a goal
/// with this id already; controllers ignore such a message, as this class does) and "guard.refused.<CODE>". Messages of
/// the other topics of an action count only if they are refused: "guard.action.refused.<CODE>".
class PathTopics {
 public:
  /// @param node    the names of topics are resolved in its namespace; a thread of this object reads the messages
  /// @param newest  returns the newest tick; any thread may call it
  PathTopics(const ros::NodeHandle& node, Commons& commons, Guard& guard,
             std::function<std::shared_ptr<const Tick>()> newest);

  void start();
  /// Waits for the message that is being read, and reads no further ones.
  void stop();

 private:
  using Event = ros::MessageEvent<const MessageBytes>;
  enum class ActionTopic { cancel, status, result };
  /// The action that a topic belongs to.
  struct Action {
    ActionGoals goals;
    std::map<std::string, PathCommand> waiting;  // goals that begin when the server accepts them
  };
  struct Topic {
    PathTopicParams params;
    PathSource source;
    std::shared_ptr<Action> action;  // null: it is no topic of an action
  };

  void subscribe(const std::string& name, const std::function<void(const Event&)>& callback);
  void onMessage(const Event& event, const Topic& topic);
  void take(const Event& event, const Topic& topic, PathSource& source, GoalPhase& phase);
  void onAction(const Event& event, const Topic& topic, ActionTopic kind);

  CallbackThreads thread_;
  Commons& commons_;
  Guard& guard_;
  std::function<std::shared_ptr<const Tick>()> newest_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hgrid
