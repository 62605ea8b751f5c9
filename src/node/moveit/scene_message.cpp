// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_message.h"

#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "node/health/ledger.h"
#include "node/moveit/scene_octomap.h"
#include "node/wire/checked.h"
#include "node/world/rules_in_force.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

using moveit::CollisionObject;
using Lack = SceneGaps::Lack;

template <class Message>
Message deserialized(const ReceivedScene& scene) {
  Checked<Message> message;
  message.read(reinterpret_cast<const std::uint8_t*>(scene.message->bytes.data()), scene.message->bytes.size());
  return message.value();
}

/// Returns the exception that is being handled, which is final: the message is not read again.
Refusal finalRefusal() {
  const Refusal why = caughtRefusal();
  return why.code() == Code::not_ready ? Refusal(Code::internal, why.what()) : why;
}

}  // namespace

ReadScene::ReadScene(const ReceivedScene& scene, const SceneReader& reader)
    : what_(scene.name()), hides_octomap_(scene.topic == SceneTopic::planning_scene) {
  try {
    switch (scene.topic) {
      case SceneTopic::collision_object:
        readAs<moveit::CollisionObject>(scene, reader);
        break;
      case SceneTopic::attached_collision_object:
        readAs<moveit::AttachedCollisionObject>(scene, reader);
        break;
      case SceneTopic::planning_scene:
        readAs<moveit::PlanningScene>(scene, reader);
        break;
    }
  } catch (...) {
    refused_ = finalRefusal();
    const bool is_read = !placed_.empty() || !detached_.empty() || !removed_.empty();
    if (!is_read) placed_ = {{"", Lack::shapes}};
  }
}

ReadScene::ReadScene(const moveit::PlanningScene& scene, const SceneReader& reader)
    : what_("the request of apply_planning_scene") {
  try {
    note(scene, reader);
    changes_ = reader.changesOf(scene);
  } catch (...) {
    refused_ = finalRefusal();
  }
}

ReadScene::ReadScene(const Refusal& dropped, bool is_scene)
    : placed_{{"", Lack::shapes}}, hides_octomap_(is_scene), refused_(dropped) {}

/// Reads a message. @throws Refusal version, truncated, or as SceneReader
template <class Message>
void ReadScene::readAs(const ReceivedScene& scene, const SceneReader& reader) {
  if (scene.md5 != moveit::kMd5<Message>) {
    throw Refusal(Code::version, "its type has the MD5 " + printable(scene.md5) + "; it must be that of Noetic, " +
                                     moveit::kMd5<Message>);
  }
  const Message message = deserialized<Message>(scene);
  note(message, reader);
  changes_ = reader.changesOf(message);
}

void ReadScene::noteObject(const CollisionObject& object) {
  const std::string name = joined("obstacle", object.id);
  if (object.operation == CollisionObject::REMOVE) {
    removed_.push_back(name);
  } else {
    placed_.push_back({name, object.operation == CollisionObject::MOVE ? Lack::place : Lack::shapes});
  }
}

void ReadScene::noteAttached(const CollisionObject& object) {
  const std::string name = joined("obstacle", object.id);
  if (object.operation == CollisionObject::REMOVE) {
    detached_.push_back({object.id.empty() ? "" : name, Lack::place});
  } else {
    const bool has_shapes = !object.primitives.empty() || !object.meshes.empty() || !object.planes.empty();
    placed_.push_back({name, has_shapes ? Lack::shapes : Lack::place, true});
  }
}

void ReadScene::note(const moveit::PlanningScene& scene, const SceneReader& reader) {
  for (const auto& attached : scene.robot_state.attached_collision_objects) noteAttached(attached.object);
  for (const auto& object : scene.collision_objects) noteObject(object);
  unused_ = unusedPartsOf(scene, reader.params());
  if (SceneOctomap::isIn(scene)) octomap_ = std::make_shared<const moveit::OctomapWithPose>(scene.octomap);
  hides_octomap_ = false;
  most_paddings_ = static_cast<std::size_t>(reader.params().max_links);
  extras_ = reader.extrasOf(scene);
}

std::shared_ptr<PreparedObstacles> ReadScene::prepare(const PrepareObstacles& prepare_obstacles,
                                                      const Tick* newest) const {
  if (isDone() || newest == nullptr || !newest->snapshot) return nullptr;
  if (!extras_ || !extras_->matrix) return prepare_obstacles(changes_, nullptr);
  const std::vector<PairRule> rules =
      withMoveItRules(newest->snapshot->structure().filter.rules(), rulesOf(*extras_->matrix, *newest->robots));
  return prepare_obstacles(changes_, &rules);
}

void ReadScene::applyTo(World& world, Time now, PreparedObstacles* prepared) {
  if (isDone()) return;
  try {
    LinkPaddings paddings;
    std::optional<std::vector<MatrixRule>> matrix;
    if (extras_) {
      paddings = paddingsAfter(*extras_, world.linkPaddings(), most_paddings_);
      matrix = extras_->matrix;
    }
    world.applyObstacles(changes_, now, prepared);
    // The code below does not throw.
    applied_ = true;
    if (extras_) world.setLinkPaddings(std::move(paddings));
    if (matrix) world.setMatrix(std::move(*matrix));
  } catch (...) {
    refused_ = caughtRefusal();
  }
}

void ReadScene::noteIn(SceneGaps& gaps) const {
  if (applied_) return gaps.noteApplied(changes_);
  gaps.noteRefused(placed_, refused_->what());
  // An object that does not exist or is not attached does not need to be detached. If the message has other parts, the
  // code may be about one of them.
  const bool detaches_one = placed_.empty() && removed_.empty() && detached_.size() == 1;
  const bool is_detached = refused_->code() == Code::unknown_id || refused_->code() == Code::conflict;
  if (!detaches_one || !is_detached) gaps.noteRefused(detached_, refused_->what());
  for (const SceneGaps::Object& object : detached_) gaps.noteDetached(object.name);
  const bool removes_one = placed_.empty() && detached_.empty() && removed_.size() == 1;
  if (removes_one && refused_->code() == Code::unknown_id) gaps.noteRemoved(removed_.front());
}

}  // namespace hgrid
