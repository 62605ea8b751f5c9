// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_topics.h"

#include <ros/time.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/health/guarded.h"
#include "node/tick/match_names.h"
#include "node/time/ros_time.h"
#include "node/wire/bytes_subscriber.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

constexpr std::chrono::milliseconds kTickShare{5};                  // time of one tick for messages of MoveIt
constexpr std::size_t kBatchMessages = 256, kBatchBytes = 1 << 20;  // read before a tick applies them
constexpr std::chrono::milliseconds kRetryPause{100};  // before a message is applied again to a world that is not ready

/// Returns the full names of the obstacles that the messages may add.
std::vector<std::string> namesAddedBy(const std::vector<std::shared_ptr<ReadScene>>& batch) {
  std::vector<std::string> names;
  for (const std::shared_ptr<ReadScene>& read : batch) {
    const std::vector<std::string> more = addedNames(read->changes());
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

}  // namespace

SceneTopics::SceneTopics(ros::NodeHandle node, Commons& commons, SceneOctomap& octomap, SceneGaps& gaps,
                         NewestTick newest, PrepareObstacles prepare, TickJobs& jobs, std::function<bool()> is_ending)
    : commons_(commons),
      newest_(std::move(newest)),
      prepare_(std::move(prepare)),
      jobs_(jobs),
      is_ending_(std::move(is_ending)),
      reader_(commons.settings.params, *commons.narrow_phase),
      octomap_(octomap),
      gaps_(gaps),
      queue_(static_cast<std::size_t>(commons.settings.params.moveit_queue_bytes)) {
  node.setCallbackQueue(&immediately_);
  for (const SceneTopic topic :
       {SceneTopic::collision_object, SceneTopic::attached_collision_object, SceneTopic::planning_scene}) {
    subscribe(node, topic);
  }
  thread_ = std::thread([this] { run(); });
}

SceneTopics::~SceneTopics() {
  subscribers_.clear();
  queue_.end();
  thread_.join();
}

void SceneTopics::subscribe(ros::NodeHandle& node, SceneTopic topic) {
  ros::SubscribeOptions options =
      bytesOptions(name(topic), 1, static_cast<std::size_t>(commons_.settings.params.moveit_queue_bytes),
                   [this, topic](const BytesEvent& event) { onMessage(event, topic); });
  options.datatype = topic == SceneTopic::collision_object            ? "moveit_msgs/CollisionObject"
                     : topic == SceneTopic::attached_collision_object ? "moveit_msgs/AttachedCollisionObject"
                                                                      : "moveit_msgs/PlanningScene";
  subscribers_.push_back(node.subscribe(options));
}

/// The threads that receive messages call this.
void SceneTopics::onMessage(const ros::MessageEvent<const MessageBytes>& event, SceneTopic topic) {
  const auto failed = guarded(commons_.ledger, "moveit.failed", [&] {
    commons_.ledger.count("moveit.received");
    ReceivedScene scene{topic, md5Of(event), event.getPublisherName(), event.getConstMessage()};
    const std::string what = scene.name();
    if (queue_.push(std::move(scene))) return;
    queue_.noteDropped(topic == SceneTopic::planning_scene);
    commons_.ledger.refuse("moveit.dropped", Refusal(Code::limit, what + " is dropped: " + whyDropped()));
  });
  if (!failed) return;
  queue_.noteDropped(topic == SceneTopic::planning_scene);
  guarded(commons_.ledger, "moveit.failed", [&] { commons_.ledger.count("moveit.dropped.INTERNAL"); });
}

std::string SceneTopics::whyDropped() const {
  return "it is too long, or messages arrive faster than they are applied; at most " +
         std::to_string(commons_.settings.params.moveit_queue_bytes) + " bytes may wait (~limits/moveit_queue_bytes)";
}

void SceneTopics::run() {
  bool ended = false;
  while (!ended) {
    guarded(commons_.ledger, "moveit.failed", [&] {
      SceneQueue::Popped popped = queue_.popAll();
      ended = popped.ended;
      if (!ended) takeAll(popped);
    });
  }
}

/// Reads and applies messages, a few at a time, so that few prepared shapes wait for a tick.
void SceneTopics::takeAll(SceneQueue::Popped& popped) {
  std::size_t taken = 0;
  try {
    std::vector<ReceivedScene>& messages = popped.messages;
    SceneBatch batch;
    std::size_t bytes = 0;
    for (std::size_t i = 0; i <= messages.size() && !is_ending_(); ++i) {
      if (popped.dropped_at == i) {
        batch.push_back(std::make_shared<ReadScene>(Refusal(Code::limit, whyDropped()), popped.dropped_scene));
      }
      if (i < messages.size()) {
        bytes += messages[i].message->size;
        batch.push_back(std::make_shared<ReadScene>(messages[i], reader_));
        messages[i].message.reset();
      }
      if (batch.size() < kBatchMessages && bytes < kBatchBytes && i < messages.size()) continue;
      apply(batch);
      batch.clear();
      bytes = 0;
      taken = i + 1;
    }
  } catch (...) {
    if (taken <= popped.messages.size()) {  // equal: only the note about dropped messages was not taken
      queue_.noteDropped(true);
      commons_.ledger.count("moveit.dropped.INTERNAL", popped.messages.size() - taken);
    }
    throw;
  }
}

/// Applies messages in their order, in as many ticks as are necessary.
void SceneTopics::apply(const SceneBatch& batch) {
  const auto shared = std::make_shared<const SceneBatch>(batch);
  const auto all_matches = matchNames(namesAddedBy(batch), newest_());
  std::size_t settled = 0;
  while (settled < batch.size() && !is_ending_()) {
    const auto done = std::make_shared<std::size_t>(settled);  // shared: run() may end before the job does
    const auto matches = all_matches ? std::make_shared<NameMatches>(*all_matches) : nullptr;
    const std::shared_ptr<PreparedObstacles> first = batch[settled]->prepare(prepare_, newest_().get());
    try {
      jobs_.run([shared, done, matches, first, &gaps = gaps_](World& world) {
        world.prepareNames(matches);
        applySome(*shared, *done, first.get(), gaps, world);
      });
    } catch (const Refusal& refusal) {
      if (refusal.code() != Code::busy) throw;  // busy: no tick began in time, so nothing was applied
    }
    const bool advanced = *done > settled;
    while (settled < *done) settle(*batch[settled++]);
    if (!advanced) std::this_thread::sleep_for(kRetryPause);
  }
}

/// Applies messages for a few milliseconds, and tells the world what it lacks. The tick thread calls this.
/// @param done   number of messages that were applied or refused
/// @param first  what was prepared for the next message; null: nothing
void SceneTopics::applySome(const SceneBatch& batch, std::size_t& done, PreparedObstacles* first, SceneGaps& gaps,
                            World& world) {
  const auto begin = std::chrono::steady_clock::now();
  const Time now = fromRos(ros::Time::now());
  while (done < batch.size() && std::chrono::steady_clock::now() - begin < kTickShare) {
    ReadScene& read = *batch[done];
    read.applyTo(world, now, std::exchange(first, nullptr));
    if (!read.isDone()) break;  // the world is not ready, so this message and the later ones wait
    read.noteIn(gaps);
    ++done;
  }
  showGaps(gaps, world);
}

/// Counts a message that was applied or refused, and takes its octomap.
void SceneTopics::settle(const ReadScene& read) {
  if (!read.applied()) {
    const std::string what = read.standsForDropped() ? "a dropped message" : read.what();
    const Refusal why(read.refused()->code(), what + ": " + read.refused()->what());
    if (!read.standsForDropped()) commons_.ledger.refuse("moveit.refused", why);
    if (read.hidesOctomap() || (read.octomap() && !read.octomap()->data.empty())) octomap_.refuse(why);
    return;
  }
  commons_.ledger.count("moveit.applied");
  for (const char* part : read.unused()) commons_.ledger.count(std::string("moveit.unused.") + part);
  if (read.octomap()) octomap_.take(*read.octomap());
}

}  // namespace hgrid
