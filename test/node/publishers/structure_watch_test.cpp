// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/publishers/structure_watch.h"

#include <gtest/gtest.h>

#include "test/support/rules.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

TEST(StructureWatch, NoticesTheFirstTickBodiesRulesAndEpochsButNotMotion) {
  Scene scene{SceneOptions{}};
  StructureWatch watch;
  Tick tick;
  tick.epoch = 1;
  EXPECT_TRUE(watch.changed(tick)) << "the first tick";
  EXPECT_FALSE(watch.changed(tick));
  const BodyId body = put(scene, ball("a"), at(0));
  tick.snapshot = scene.commit(Time{1}, {});
  EXPECT_TRUE(watch.changed(tick)) << "a body was added";
  scene.place(body, at(1), Time{2});
  tick.snapshot = scene.commit(Time{2}, {});
  EXPECT_FALSE(watch.changed(tick));
  scene.setRules({allow("*", "*")});
  tick.snapshot = scene.commit(Time{3}, {});
  EXPECT_TRUE(watch.changed(tick)) << "a rule was added";
  scene.setRules({});
  tick.snapshot = scene.commit(Time{4}, {});
  EXPECT_TRUE(watch.changed(tick)) << "the rule was removed";
  tick.epoch = 2;
  EXPECT_TRUE(watch.changed(tick)) << "the epoch changed";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
