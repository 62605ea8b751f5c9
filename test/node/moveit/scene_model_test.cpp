// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Random messages of MoveIt, compared with a simple model of its planning scene.
#include <cmath>
#include <iterator>
#include <map>
#include <random>

#include "test/node/moveit/scene_messages.h"

namespace hgrid {
namespace test {
namespace {

using Object = CollisionObject;

// Claim: after any sequence of messages, the world is what a simple model of MoveIt's planning scene says.
TEST_F(SceneWorld, RandomMessagesGiveWhatASimpleModelSays) {
  struct Modeled {
    double x = 0.0;  // [m] in the world, or relative to the cart if it is attached
    bool attached = false, of_moveit = true;
    std::size_t shapes = 1;
  };
  std::map<std::string, Modeled> model = {{"post", {3, false, false, 1}}};
  std::mt19937 random(7);
  const std::vector<std::string> ids = {"a", "b", "c", "post"};
  std::size_t refused = 0;
  for (int step = 0; step < 10000; ++step) {
    SCOPED_TRACE("step " + std::to_string(step));
    const std::string id = ids[random() % ids.size()];
    const double x = double(random() % 64) / 8;
    const bool on_cart = random() % 2 == 0;
    const std::string frame = on_cart ? "cart" : "world";
    const double at = on_cart ? cart(time_) + x : x;
    const auto known = model.find(id);
    const bool exists = known != model.end(), attached = exists && known->second.attached;
    bool allowed = true, applied = true;
    const auto send = [&](const auto& message) { applied = !refusedScene(message); };
    switch (random() % 8) {
      case 0:
        send(sceneSphere(Object::ADD, id, x, frame));
        allowed = !attached;
        if (allowed) model[id] = {at, false, true, 1};
        break;
      case 1:
        if (exists && known->second.shapes > 20) break;
        send(sceneSphere(Object::APPEND, id, x, frame));
        allowed = !attached;
        if (attached) break;
        if (exists) {
          ++known->second.shapes;
        } else {
          model[id] = {at, false, true, 1};
        }
        break;
      case 2:
        send(sceneMove(id, x, frame));
        allowed = exists && !attached;
        if (allowed) known->second.x = at;
        break;
      case 3:
        send(sceneObject(Object::REMOVE, id));
        allowed = exists && !attached;
        if (allowed) model.erase(known);
        break;
      case 4:
        if (random() % 4 != 0) break;
        send(sceneObject(Object::REMOVE, ""));
        for (auto one = model.begin(); one != model.end();) {
          one = one->second.of_moveit && !one->second.attached ? model.erase(one) : std::next(one);
        }
        break;
      case 5:
        send(attachedTo("hand", sceneObject(Object::ADD, id)));
        allowed = exists;
        if (allowed && !attached) known->second.x -= cart(time_);
        if (allowed) known->second.attached = true;
        break;
      case 6:
        send(attachedTo("tool", sceneSphere(Object::ADD, id, x, "tool")));
        model[id] = {0.25 + x, true, true, 1};
        break;
      case 7:
        send(attachedTo("hand", sceneObject(Object::REMOVE, id)));
        allowed = attached;
        if (allowed) known->second.x += cart(time_);
        if (allowed) known->second.attached = false;
    }
    ASSERT_EQ(applied, allowed);
    refused += allowed ? 0 : 1;
    if (step % 4 != 0) continue;
    tick();
    Places expected;
    for (const auto& [name, modeled] : model) {
      expected[name] = std::round(1e6 * (modeled.x + (modeled.attached ? cart(time_) : 0.0))) / 1e6;
      ASSERT_EQ(bodyOf(*tick_->snapshot, "obstacle/" + name).shapes.size(), modeled.shapes) << name;
    }
    ASSERT_EQ(placesIn(*tick_->snapshot), expected);
  }
  EXPECT_GT(refused, 1000u);
  EXPECT_LT(refused, 7000u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
