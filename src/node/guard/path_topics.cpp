// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/path_topics.h"

#include <ros/time.h>

#include <boost/make_shared.hpp>
#include <utility>

#include "node/guard/path_message.h"
#include "node/services/guarded.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostBytes = 16 << 20;  // of a message
constexpr int kQueue = 10;                    // messages of one topic that wait to be read; the oldest is dropped

}  // namespace

PathTopics::PathTopics(const ros::NodeHandle& node, Commons& commons, Guard& guard,
                       std::function<std::shared_ptr<const Tick>()> newest)
    : thread_(node, node), commons_(commons), guard_(guard), newest_(std::move(newest)) {}

void PathTopics::start() {
  using Event = ros::MessageEvent<const MessageBytes>;
  for (const PathTopicParams& topic : commons_.settings.params.path_topics) {
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const Event&>(
        topic.topic, kQueue, [this, topic](const Event& event) { onMessage(event, topic); },
        [] {
          const auto message = boost::make_shared<MessageBytes>();
          message->most_bytes = kMostBytes;
          return message;
        });
    subscribers_.push_back(ros::NodeHandle(thread_.node()).subscribe(options));
  }
  if (!subscribers_.empty()) thread_.setThreads(1);
}

void PathTopics::stop() {
  subscribers_.clear();
  thread_.stop();
}

void PathTopics::onMessage(const ros::MessageEvent<const MessageBytes>& event, const PathTopicParams& topic) {
  guarded(commons_.ledger, "guard.message.failed", [&] {
    commons_.ledger.count("guard.received");
    Refusal refused(Code::ok, "");
    try {
      take(event, topic);
    } catch (...) {
      refused = caughtRefusal();
    }
    if (refused.code() == Code::ok) return;
    refused = Refusal(refused.code(), "the path of robot '" + topic.robot + "' in a message on " + topic.topic +
                                          " was refused: " + refused.what());
    if (const auto tick = newest_()) {
      guard_.markUnreadable(topic.topic, topic.robot, std::string(name(refused.code())) + ": " + refused.what(), *tick);
    }
    commons_.ledger.refuse("guard.refused", refused);
  });
}

void PathTopics::take(const ros::MessageEvent<const MessageBytes>& event, const PathTopicParams& topic) {
  const MessageBytes& message = *event.getConstMessage();
  if (message.size > kMostBytes) {
    throw Refusal(Code::limit, "it has " + std::to_string(message.size) + " bytes; at most " +
                                   std::to_string(kMostBytes) + " are allowed");
  }
  const std::shared_ptr<const Tick> tick = newest_();
  if (!tick || !tick->snapshot) throw Refusal(Code::not_ready, "there is no complete tick yet; send the path again");
  const ros::M_string& connection = event.getConnectionHeader();
  const auto md5 = connection.find("md5sum");
  const Time arrival(static_cast<std::int64_t>(event.getReceiptTime().toNSec()));
  PathCommand command = readPathMessage(message.bytes, md5 == connection.end() ? "" : md5->second, arrival);
  command.path.robot = topic.robot;
  if (command.path.times.empty()) {
    guard_.stop(topic.topic, topic.robot);
    commons_.ledger.count("guard.stopped");
  } else if (command.path.times.back() < tick->made.ros) {
    commons_.ledger.count("guard.ended");
  } else {
    guard_.follow(topic.topic, std::move(command.path), command.start, *tick);
    commons_.ledger.count("guard.followed");
  }
}

}  // namespace hgrid
