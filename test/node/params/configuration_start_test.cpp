// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <ros/package.h>
#include <ros/param.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "src/node/messages/interface_version.h"
#include "src/node/params/params.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

template <class Struct, class Member>
void expectEqualMember(const Struct& a, const Struct& b, Member member) {
  EXPECT_EQ(a.*member, b.*member);
}

template <class Struct, class... Member>
void expectEqual(const Struct& a, const Struct& b, Member... member) {
  (expectEqualMember(a, b, member), ...);
}

TEST(ParamsFile, LoadingItGivesTheDefaults) {
  Value loaded;  // the values that configuration.test loads
  ASSERT_TRUE(ros::param::get("/params_file", loaded));
  const Params read = readParams(loaded), defaults = readParams(dict());
  using P = Params;
  expectEqual(read, defaults, &P::world_frame, &P::origin, &P::rate, &P::heartbeat, &P::follow_data, &P::realtime, &P::margin, &P::broad_phase, &P::late_after,
              &P::stale_after, &P::lost_after, &P::horizon, &P::growth_cap, &P::default_max_speed, &P::max_sync_wait,
              &P::max_future, &P::tf_cache, &P::valid_for, &P::world_limit, &P::min_size, &P::max_size,
              &P::allow_flat, &P::max_bodies, &P::max_frames, &P::max_pairs, &P::event_hysteresis, &P::max_events,
              &P::event_queue, &P::max_hits, &P::max_listed, &P::max_rules, &P::max_description_bytes,
              &P::max_description_depth, &P::max_links, &P::mesh_roots, &P::use_visual, &P::max_mesh_bytes,
              &P::max_mesh_triangles, &P::mesh_memory, &P::mesh_timeout, &P::query_threads, &P::batch_threads, &P::marker_rate,
              &P::distances_max, &P::distances_budget, &P::distances_threads);
  ASSERT_EQ(read.robots.size(), 1u);
  using R = RobotParams;
  expectEqual(read.robots[0], defaults.robots.at(0), &R::name, &R::description, &R::semantic, &R::tf_prefix);
  using K = PairKinds;
  expectEqual(read.pair_kinds, defaults.pair_kinds, &K::self, &K::robot_robot, &K::robot_obstacle, &K::robot_map,
              &K::moving_obstacle);
  EXPECT_TRUE(read.obstacles.empty() && read.allowed_pairs.empty() && read.accept_uncovered.empty());
  EXPECT_TRUE(read.margins.empty() && read.pair_margins.empty() && read.padding.empty() && read.max_speed.empty());
}

TEST(ParamsFile, EveryParameterInItIsKnownAndNoOtherIs) {
  Value loaded;
  ASSERT_TRUE(ros::param::get("/params_file", loaded));
  for (auto& member : loaded) {
    Value one = dict();
    one[member.first] = Value(dict({{"not", "like that"}}));  // a wrong value for every parameter
    try {
      readParams(one);
      ADD_FAILURE() << member.first << " is not read";
    } catch (const std::invalid_argument& refusal) {
      const bool group = member.second.getType() == Value::TypeStruct;
      EXPECT_TRUE(says(refusal.what(), group ? "~" + member.first + "/not is not a parameter of this node"
                                             : "~" + member.first + " is a dictionary; it must be "))
          << member.first;
    }
  }
}

TEST(Start, IsRefusedWithOneMessageThatListsEveryError) {
  NodeSetup setup;
  setup.params = dict({{"rate", "fast"},
                       {"marign", 0.1},
                       {"margin", -1.0},
                       {"obstacles", list({ball("o", 0, 0, 0, -2), ball("o", 0, 0, 0, 1)})}});
  NodeUnderTest node(setup, false);
  const std::optional<int> code = node.process().waitForEnd(20.0);
  ASSERT_TRUE(code) << "the node still runs";
  EXPECT_EQ(*code, 1);
  EXPECT_EQ(node.lines("FATAL"), 1u);
  EXPECT_EQ(node.lines(""), 6u) << node.output();
  EXPECT_TRUE(says(node.output(), "5 parameters are wrong:"));
  EXPECT_TRUE(says(node.output(), "~rate is a string ('fast'); it must be a number"));
  EXPECT_TRUE(says(node.output(), "~margin is -1 m; it must be within 0 .. 1000 m"));
  EXPECT_TRUE(says(node.output(), "~marign is not a parameter of this node"));
  EXPECT_TRUE(says(node.output(), "~obstacles[0]/shapes[0] is not a valid shape: sphere: radius is -2 m"));
  EXPECT_TRUE(says(node.output(), "~obstacles[1]/name is 'o', which is already used"));
}

TEST(Start, IsRefusedWhereAnEntryOfAListLacksAField) {
  NodeSetup setup;
  setup.params = dict({{"max_speed", list({dict({{"pattern", "*"}})})}});
  NodeUnderTest node(setup, false);
  EXPECT_EQ(node.process().waitForEnd(20.0).value_or(-1), 1);
  EXPECT_TRUE(says(node.output(), "~max_speed[0] has no 'speed'; it must have one"));
}

TEST(Start, SaysWhichVersionOfThePackageAndOfTheInterfaceRuns) {
  NodeSetup setup;
  setup.params = dict({{"world_frame", "world"}});
  const NodeUnderTest node(setup);
  const msg::Status status = *node.heard().status.back();
  EXPECT_EQ(status.interface_version, kInterfaceVersion);
  std::ifstream file(ros::package::getPath("hgrid_proximity") + "/package.xml");
  std::ostringstream package;
  package << file.rdbuf();
  EXPECT_TRUE(says(package.str(), "<version>" + status.node_version + "</version>"));
}

TEST(Start, AndEndWithAnInterruptIsClean) {
  NodeSetup setup;
  setup.params = dict({{"world_frame", "world"}});
  NodeUnderTest node(setup);
  node.process().signal(SIGINT);
  EXPECT_EQ(node.process().waitForEnd(20.0).value_or(-1), 0);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
