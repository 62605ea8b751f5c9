// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/path_topics.h"

#include <ros/names.h>
#include <ros/time.h>

#include <boost/make_shared.hpp>
#include <utility>

#include "node/guard/action_message.h"
#include "node/health/guarded.h"
#include "node/time/ros_time.h"
#include "node/wire/bytes_subscriber.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostBytes = 16 << 20;  // of a message
constexpr int kQueue = 10;                    // messages of one topic that wait to be read; the oldest is dropped
constexpr std::size_t kMostWaiting = 100;     // goals whose paths are kept until they begin

/// Returns the bytes of a message. @throws Refusal limit
const std::string& checkedBytes(const MessageBytes& message) {
  if (message.size > kMostBytes) {
    throw Refusal(Code::limit, "it has " + std::to_string(message.size) + " bytes; at most " +
                                   std::to_string(kMostBytes) + " are allowed");
  }
  return message.bytes;
}

/// Returns the name that a topic of a controller begins with: "/arm" of "/arm/command". Empty: it has none.
std::string above(const std::string& name) { return name.substr(0, name.rfind('/')); }

bool isOver(GoalPhase phase) {
  return phase == GoalPhase::stopped || phase == GoalPhase::over || phase == GoalPhase::refused;
}

}  // namespace

PathTopics::PathTopics(const ros::NodeHandle& node, Commons& commons, Guard& guard,
                       std::function<std::shared_ptr<const Tick>()> newest)
    : thread_(node, node), commons_(commons), guard_(guard), newest_(std::move(newest)) {}

void PathTopics::start() {
  for (const PathTopicParams& params : commons_.settings.params.path_topics) {
    Topic topic{params, PathSource(params.topic), nullptr};
    const std::string name = thread_.node().resolveName(params.topic), parent = above(name);
    // A controller "/arm" has the topic "/arm/command" and the action "/arm/follow_joint_trajectory". In others, the
    // action itself is "/arm".
    if (name == parent + "/command") topic.source.command_of = parent;
    if (name == parent + "/goal") {
      topic.action = std::make_shared<Action>();
      topic.source.action_of = {parent, above(parent)};
      const auto follow = [&](const std::string& word, ActionTopic kind) {
        subscribe(parent + word, [this, topic, kind](const Event& event) { onAction(event, topic, kind); });
      };
      follow("/cancel", ActionTopic::cancel);
      follow("/status", ActionTopic::status);
      follow("/result", ActionTopic::result);
    }
    subscribe(name, [this, topic](const Event& event) { onMessage(event, topic); });
  }
  if (!subscribers_.empty()) thread_.setThreads(1);
}

void PathTopics::subscribe(const std::string& name, const std::function<void(const Event&)>& callback) {
  ros::SubscribeOptions options = bytesOptions(name, kQueue, kMostBytes, callback);
  subscribers_.push_back(ros::NodeHandle(thread_.node()).subscribe(options));
}

void PathTopics::stop() {
  subscribers_.clear();
  thread_.stop();
}

void PathTopics::onMessage(const Event& event, const Topic& topic) {
  guarded(commons_.ledger, "guard.message.failed", [&] {
    commons_.ledger.count("guard.received");
    Refusal refused(Code::ok, "");
    PathSource source = topic.source;
    GoalPhase phase = GoalPhase::followed;
    try {
      take(event, topic, source, phase);
    } catch (...) {
      refused = caughtRefusal();
    }
    if (refused.code() == Code::ok) return;
    const std::string& robot = topic.params.robot;
    refused = Refusal(refused.code(), "the path of robot '" + robot + "' in a message on " + topic.params.topic +
                                          " was refused: " + refused.what());
    if (const auto tick = newest_()) {
      guard_.markUnreadable(source, robot, std::string(name(refused.code())) + ": " + refused.what(), *tick, phase);
    }
    commons_.ledger.refuse("guard.refused", refused);
  });
}

/// @param source  receives the name of the goal that the path is from
/// @param phase   receives the phase of this goal
void PathTopics::take(const Event& event, const Topic& topic, PathSource& source, GoalPhase& phase) {
  const std::string& bytes = checkedBytes(*event.getConstMessage());
  const std::string md5 = md5Of(event);
  const std::optional<GoalId> id = topic.action ? readGoalId(bytes, md5) : std::nullopt;
  if (id) {
    const GoalNews news = topic.action->goals.send(*id, fromRos(event.getReceiptTime()));
    if (isOver(news.phase)) return commons_.ledger.count("guard.ended");
    source.goal = news.key;
    phase = news.phase;
  }
  const std::shared_ptr<const Tick> tick = newest_();
  if (!tick || !tick->snapshot) throw Refusal(Code::not_ready, "there is no complete tick yet; send the path again");
  PathCommand command = readPathMessage(bytes, md5, fromRos(event.getReceiptTime()));
  command.path.robot = topic.params.robot;
  source.is_plan = command.is_plan;
  if (command.path.times.empty()) {
    guard_.stop(source, topic.params.robot);
    commons_.ledger.count("guard.stopped");
  } else if (command.path.times.back() < tick->made.ros) {
    commons_.ledger.count("guard.ended");
  } else {
    guard_.follow(source, command.path, command.start, *tick, phase);
    commons_.ledger.count("guard.followed");
    if (!id || command.is_stamped) return;
    auto& waiting = topic.action->waiting;
    if (waiting.size() >= kMostWaiting) waiting.clear();
    waiting[source.goal] = std::move(command);
  }
}

void PathTopics::onAction(const Event& event, const Topic& topic, ActionTopic kind) {
  guarded(commons_.ledger, "guard.message.failed", [&] {
    const std::shared_ptr<const Tick> tick = newest_();
    if (!tick || !tick->snapshot) return;  // the server repeats the status
    Action& action = *topic.action;
    const Time now = fromRos(event.getReceiptTime());
    std::vector<GoalNews> all;
    try {
      const std::string& bytes = checkedBytes(*event.getConstMessage());
      const std::string md5 = md5Of(event);
      if (kind == ActionTopic::cancel) all = action.goals.cancel(readCancel(bytes, md5), now);
      if (kind == ActionTopic::status) all = action.goals.status(readStatus(bytes, md5), now);
      if (kind == ActionTopic::result) all = action.goals.result(readResult(bytes, md5), now);
    } catch (const Refusal& refusal) {
      commons_.ledger.refuse("guard.action.refused",
                             Refusal(refusal.code(), "a message of the action of " + topic.params.topic +
                                                         " was refused: " + refusal.what()));
      return;
    }
    PathSource source = topic.source;
    for (const GoalNews& news : all) {
      source.goal = news.key;
      const auto waiting = action.waiting.find(news.key);
      if (news.phase == GoalPhase::followed && waiting != action.waiting.end()) {
        RobotPath path = std::move(waiting->second.path);
        for (Time& time : path.times) time += now - waiting->second.start;
        try {
          guard_.begin(source, std::move(path), now, *tick);
        } catch (const Refusal& refusal) {  // the path stays as it was when the goal was sent
          commons_.ledger.refuse("guard.action.refused", refusal);
        }
      }
      if (waiting != action.waiting.end() && news.phase != GoalPhase::waiting) action.waiting.erase(waiting);
      guard_.note(source, topic.params.robot, news.phase, *tick);
    }
  });
}

}  // namespace hgrid
