// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "node/health/commons.h"
#include "node/moveit/scene_changes.h"
#include "node/moveit/scene_gaps.h"
#include "node/moveit/scene_message.h"
#include "node/moveit/scene_octomap.h"
#include "node/moveit/scene_queue.h"
#include "node/threads/immediate_callbacks.h"
#include "node/tick/newest_tick.h"
#include "node/tick/tick_jobs.h"

namespace hgrid {

/// Subscribes to the topics on which MoveIt announces its objects, and applies the messages to the world.
///
/// A separate thread reads the messages and prepares the shapes, and the structure with the first message. Then a tick
/// applies them in the order in which they were received, each message as a whole. What a tick cannot apply within a
/// few milliseconds, the next tick applies. While an object is missing because a message was refused or dropped, the
/// world is not complete.
///
/// Counters: "moveit.received" is the sum of "moveit.applied", "moveit.refused.<CODE>", "moveit.dropped.<CODE>" and of
/// the messages that still wait.
class SceneTopics {
 public:
  /// @param node       the names of the topics are resolved in its namespace
  /// @param is_ending  returns whether the node is shutting down
  /// `commons`, `octomap`, `gaps` and `jobs` must outlive this object.
  SceneTopics(ros::NodeHandle node, Commons& commons, SceneOctomap& octomap, SceneGaps& gaps, NewestTick newest,
              PrepareObstacles prepare, TickJobs& jobs, std::function<bool()> is_ending);
  ~SceneTopics();
  SceneTopics(const SceneTopics&) = delete;
  SceneTopics& operator=(const SceneTopics&) = delete;

 private:
  using SceneBatch = std::vector<std::shared_ptr<ReadScene>>;
  void subscribe(ros::NodeHandle& node, SceneTopic topic);
  void onMessage(const ros::MessageEvent<const MessageBytes>& event, SceneTopic topic);
  std::string whyDropped() const;
  void run();
  void takeAll(SceneQueue::Popped& popped);
  void apply(const SceneBatch& batch);
  static void applySome(const SceneBatch& batch, std::size_t& done, PreparedObstacles* first, SceneGaps& gaps,
                        World& world);
  void settle(const ReadScene& read);

  Commons& commons_;
  const NewestTick newest_;
  const PrepareObstacles prepare_;
  TickJobs& jobs_;
  const std::function<bool()> is_ending_;
  SceneReader reader_;
  SceneOctomap& octomap_;
  SceneGaps& gaps_;  // only jobs use it
  SceneQueue queue_;
  ImmediateCallbacks immediately_;
  std::vector<ros::Subscriber> subscribers_;
  std::thread thread_;
};

}  // namespace hgrid
