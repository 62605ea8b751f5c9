// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_queue.h"

#include <utility>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

const char* name(SceneTopic topic) {
  switch (topic) {
    case SceneTopic::collision_object:
      return "collision_object";
    case SceneTopic::attached_collision_object:
      return "attached_collision_object";
    case SceneTopic::planning_scene:
      break;
  }
  return "planning_scene";
}

std::string ReceivedScene::name() const {
  return std::string("the message on ") + hgrid::name(topic) + " from '" + printable(publisher) + "'";
}

bool SceneQueue::push(ReceivedScene scene) {
  const std::size_t bytes = scene.message->size + kOverhead;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (bytes > most_bytes_ - bytes_) return false;
    waiting_.messages.push_back(std::move(scene));
    bytes_ += bytes;
  }
  changed_.notify_one();
  return true;
}

void SceneQueue::noteDropped(bool is_scene) noexcept {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.dropped_at = waiting_.messages.size();
    waiting_.dropped_scene = waiting_.dropped_scene || is_scene;
  }
  changed_.notify_one();
}

SceneQueue::Popped SceneQueue::popAll() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.ended || waiting_.dropped_at || !waiting_.messages.empty(); });
  Popped popped = std::move(waiting_);
  waiting_ = Popped();
  waiting_.ended = popped.ended;
  bytes_ = 0;
  return popped;
}

void SceneQueue::end() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.ended = true;
  }
  changed_.notify_one();
}

}  // namespace hgrid
