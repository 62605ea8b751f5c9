// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/messages/status_message.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/bodies/source.h"
#include "src/node/messages/world_state_message.h"
#include "test/node/support/settings.h"
#include "test/support/random.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

std::vector<std::string> sentencesUpTo(int count) {
  std::vector<std::string> sentences;
  for (int i = 0; i < count; ++i) sentences.push_back("sentence " + std::to_string(i));
  return sentences;
}

msg::Status statusOf(Tick tick, const Params& params) {
  tick.settings = test::settingsOf(params);
  return statusMessage(tick, worldState(tick, 0.0), params, Ledger(), Stopwatch());
}

TEST(StatusMessage, BoundsEveryListAndSaysHowManyEntriesAreLeftOut) {
  Params params;
  params.max_listed = 3;
  auto models = std::make_shared<ModelReport>();
  models->uncovered = models->waived = models->without_collision = models->uses_visual = sentencesUpTo(5);
  models->warnings = sentencesUpTo(1039);
  Tick tick;
  tick.models = models;
  tick.not_ready = tick.missing_frames = tick.contested_frames = sentencesUpTo(10);
  const msg::Status status = statusOf(tick, params);
  for (const auto& list : {status.not_ready, status.missing_frames, status.contested_frames, status.uncovered,
                           status.waived, status.without_collision, status.uses_visual, status.model_warnings}) {
    ASSERT_EQ(list.size(), 4u);
    EXPECT_EQ(list[2], "sentence 2");
  }
  EXPECT_EQ(status.not_ready.back(), "... and 7 more");
  EXPECT_EQ(status.model_warnings.back(), "... and 1036 more");
  EXPECT_EQ(status.world.reasons, sentencesUpTo(8)) << "there is no world yet";
  EXPECT_EQ(status.world.reasons_total, 10u);
}

TEST(StatusMessage, HasTheReasonsThatExplainManyBodiesFirst) {
  Params params;
  Scene scene{SceneOptions{}};
  for (const char* name : {"a", "b"}) scene.add(test::ball(name));
  Tick tick;
  tick.models = std::make_shared<ModelReport>();
  tick.unplaced = {"UNPLACED robot 'arm': 7 of its 8 links never had a pose"};
  tick.snapshot = scene.commit(Time{1}, {});
  const msg::Status status = statusOf(tick, params);
  EXPECT_EQ(status.world.reasons,
            std::vector<std::string>({tick.unplaced[0], "UNPLACED obstacle/a: it never had a pose (frame 'world')",
                                      "UNPLACED obstacle/b: it never had a pose (frame 'world')"}));
  EXPECT_EQ(status.world.reasons_total, 3u);
  EXPECT_EQ(status.not_ready, tick.unplaced);
}

/// Returns the text of a source's entry, computed from all bodies one by one.
std::string expectedEntry(const Snapshot& snapshot, const std::string& source) {
  std::uint32_t bodies = 0;
  std::uint8_t state = 0;
  double age = std::nan("");
  for (std::uint32_t body = 0; body < snapshot.poses().size(); ++body) {
    if (sourceOf(snapshot.structure().bodies[body]) != source) continue;
    const BodyPose& pose = snapshot.poses()[body];
    ++bodies;
    state = std::max(state, static_cast<std::uint8_t>(pose.state));
    if (pose.state != Freshness::unplaced) age = std::isnan(age) ? pose.age : std::max(age, pose.age);
  }
  return source + " " + std::to_string(bodies) + " " + std::to_string(state) + " " + std::to_string(age);
}

TEST(StatusMessage, SaysOfEachSourceWhatItsBodiesAreOneByOne) {
  const Params params;
  const std::vector<std::string> sources = {"arm", "cart", "obstacle"};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    Scene scene{SceneOptions{}};
    std::vector<BodyId> ids;
    for (std::uint64_t i = 0; i < 12; ++i) {
      Body body = test::ball(std::to_string(i));
      body.name = sources[static_cast<std::size_t>(random.below(3))] + "/" + std::to_string(i);
      if (body.name[0] != 'o') body.kind = BodyKind::link;
      ids.push_back(scene.add(body));
      if (random.below(3) > 0) scene.setState(ids.back(), Freshness::unplaced, 0.0);
    }
    for (int step = 1; step <= 30; ++step) {
      const BodyId id = ids[static_cast<std::size_t>(random.below(12))];
      const bool settled = random.below(3) == 0;
      scene.place(id, test::at(random.uniform(-9, 9)), Time{step});
      scene.setState(id, settled ? Freshness::fresh : static_cast<Freshness>(random.below(4)),
                     settled ? 0.0 : random.uniform(0, 2));
      Tick tick;
      tick.models = std::make_shared<ModelReport>();
      tick.snapshot = scene.commit(Time{step}, {});
      const msg::Status status = statusOf(tick, params);
      for (const msg::SourceStatus& source : status.sources) {
        if (source.bodies == 0) continue;
        EXPECT_EQ(source.name + " " + std::to_string(source.bodies) + " " + std::to_string(source.state) + " " +
                      std::to_string(source.age),
                  expectedEntry(*tick.snapshot, source.name));
      }
    }
  }
}

}  // namespace
}  // namespace hgrid
