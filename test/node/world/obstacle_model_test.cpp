// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Random requests of ~apply_obstacles are compared with a model that does the same in the simplest way. The test needs
// no ROS master.
#include <algorithm>
#include <iterator>
#include <limits>

#include "test/node/world/obstacle_world.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

/// What the node must do, in the simplest way.
class Model {
 public:
  struct Thing {
    double x, radius;
    std::string frame, owner;
    double ends;
    bool attached = false, configured = false;
  };
  /// Returns the refusal; nullopt: the changes are applied.
  std::optional<std::pair<Code, std::size_t>> apply(const std::vector<msg::Obstacle>& changes,
                                                    const std::string& complete_set_of, double time, double cart) {
    std::map<std::string, Thing> after = things;
    std::vector<std::string> added;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const msg::Obstacle& change = changes[i];
      const auto old = after.find(change.name);
      if (change.operation == Operation::ADD) {
        const double life = change.lifetime.toSec();
        const Thing thing{change.pose.position.x,
                          change.shapes[0].dimensions[0],
                          change.header.frame_id,
                          change.owner,
                          life == 0.0 ? std::numeric_limits<double>::infinity() : time + life,
                          false,
                          false};
        const bool equal = old != after.end() && !old->second.attached && old->second.x == thing.x &&
                           old->second.radius == thing.radius && old->second.frame == thing.frame &&
                           std::isinf(old->second.ends) == std::isinf(thing.ends) && !old->second.configured;
        if (old != after.end() && !equal && !change.replace) return std::pair(Code::dup_id, i);
        after[change.name] = thing;
        added.push_back(change.name);
        continue;
      }
      if (old == after.end()) return std::pair(Code::unknown_id, i);
      if (change.operation == Operation::REMOVE) {
        after.erase(old);
        continue;
      }
      Thing& thing = old->second;
      switch (change.operation) {
        case Operation::MOVE:
          if (thing.attached) return std::pair(Code::conflict, i);
          thing.x = change.pose.position.x;
          thing.frame = change.header.frame_id;
          break;
        case Operation::ATTACH:
          if (change.link == "arm/foot") return std::pair(Code::unknown_id, i);
          if (change.at_attach_pose) {
            thing.x = change.attach_pose.position.x + (change.link == "arm/tool" ? 0.25 : 0.0);
          } else if (thing.frame != "cart") {
            thing.x -= cart;
          }
          thing.frame = "cart";
          thing.attached = true;
          break;
        default:
          if (!thing.attached) return std::pair(Code::conflict, i);
          thing.x += cart;
          thing.frame.clear();
          thing.attached = false;
      }
      if (!std::isinf(thing.ends)) thing.ends = time + kLife;
    }
    for (auto thing = after.begin(); thing != after.end();) {
      const bool before = things.count(thing->first) != 0;
      const bool gone = before && !complete_set_of.empty() && thing->second.owner == complete_set_of &&
                        std::find(added.begin(), added.end(), thing->first) == added.end();
      thing = gone ? after.erase(thing) : std::next(thing);
    }
    things = after;
    return std::nullopt;
  }
  std::map<std::string, double> places(double time, double cart) {
    std::map<std::string, double> places;
    for (auto thing = things.begin(); thing != things.end();) {
      thing = thing->second.ends <= time ? things.erase(thing) : std::next(thing);
    }
    for (const auto& [name, thing] : things) {
      places[name] = std::round(1e6 * (thing.x + (thing.frame == "cart" ? cart : 0.0))) / 1e6;
    }
    return places;
  }

  static constexpr double kLife = 0.35;  // [s]
  std::map<std::string, Thing> things{{"post", {3, 0.1, "", "", std::numeric_limits<double>::infinity(), false, true}}};
};

/// Claim: after random requests the world contains what a simple model contains, and refuses what the model refuses.
TEST_F(Obstacles, AreWhatASimpleModelSays) {
  Random random(1);
  Model model;
  int applied = 0, refusals = 0, interrupted = 0;
  const auto randomChanges = [&] {
    std::vector<msg::Obstacle> changes;
    for (std::uint32_t count = random.below(4); count > 0; --count) {
      const std::string name = random.below(10) == 0 ? "post" : std::string(1, char('a' + random.below(6)));
      const double x = random.below(4);
      const std::string frame = random.below(3) == 0 ? "cart" : "";
      const char* link = random.below(8) == 0 ? "arm/foot" : random.below(2) == 0 ? "arm/hand" : "arm/tool";
      switch (random.below(6)) {
        case 5:
          changes.push_back(random.below(2) == 0 ? attaching(name, link) : attaching(name, link, x));
          break;
        case 4:
          changes.push_back(detaching(name));
          break;
        case 0:
          changes.push_back(removing(name));
          break;
        case 1:
          changes.push_back(moving(name, x, frame));
          break;
        default:
          changes.push_back(adding(name, x, 0.1 * (1 + random.below(2)), frame));
          changes.back().owner = random.below(2) == 0 ? "one" : "two";
          changes.back().replace = random.below(2) == 0;
          if (random.below(3) == 0) changes.back().lifetime = ros::Duration(Model::kLife);
      }
    }
    return changes;
  };
  for (int round = 0; round < 10000; ++round) {
    const std::vector<msg::Obstacle> changes = randomChanges();
    const std::string complete = random.below(6) == 0 ? "one" : "";
    std::optional<std::pair<Code, std::size_t>> expected;
    between_ = [&] {  // sometimes applies another request before, so that what was prepared is out of date
      if (random.below(4) == 0) {
        const std::vector<msg::Obstacle> others = randomChanges();
        if (!model.apply(others, "", time_, cart(time_))) {
          world_.applyObstacles(changesOf(others, ""), momentAt(time_).ros);
          ++interrupted;
        }
      }
      expected = model.apply(changes, complete, time_, cart(time_));
    };
    const auto found = refused(changes, complete);
    ASSERT_EQ(found, expected) << "round " << round;
    ++(expected ? refusals : applied);
    const Snapshot& snapshot = tick();
    ASSERT_EQ(placesIn(snapshot), model.places(time_, cart(time_))) << "round " << round;
    for (std::size_t i = 0; i < snapshot.structure().bodies.size(); ++i) {
      const Body& body = snapshot.structure().bodies[i];
      if (body.kind != BodyKind::obstacle) continue;
      const Model::Thing& thing = model.things.at(body.name.substr(9));
      ASSERT_EQ(body.mobility == Mobility::moving, thing.frame == "cart") << body.name;
      ASSERT_EQ(mayTouch(snapshot, body.name, "arm/hand"), thing.attached) << body.name;
    }
  }
  EXPECT_GT(applied, 500);
  EXPECT_GT(refusals, 500);
  EXPECT_GT(interrupted, 500);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
