// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/messages/status_message.h"

#include <gtest/gtest.h>

#include "src/node/messages/world_state_message.h"
#include "test/node/support/settings.h"
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
  params.max_reasons = 2;
  auto models = std::make_shared<ModelReport>();
  models->uncovered = models->waived = models->without_collision = models->uses_visual = sentencesUpTo(5);
  models->warnings = sentencesUpTo(1039);
  Tick tick;
  tick.models = models;
  tick.not_ready = tick.missing_frames = tick.contested_frames = sentencesUpTo(4);
  const msg::Status status = statusOf(tick, params);
  for (const auto& list : {status.not_ready, status.missing_frames, status.contested_frames, status.uncovered,
                           status.waived, status.without_collision, status.uses_visual, status.model_warnings}) {
    ASSERT_EQ(list.size(), 4u);
    EXPECT_EQ(list[2], "sentence 2");
  }
  EXPECT_EQ(status.not_ready.back(), "... and 1 more");
  EXPECT_EQ(status.model_warnings.back(), "... and 1036 more");
  EXPECT_EQ(status.world.reasons, sentencesUpTo(2)) << "there is no world yet";
  EXPECT_EQ(status.world.reasons_total, 4u);
}

TEST(StatusMessage, HasTheReasonsThatExplainManyBodiesFirst) {
  Params params;
  Scene scene{SceneOptions{}};
  for (const char* name : {"a", "b"}) scene.add(test::ball(name));
  Tick tick;
  tick.models = std::make_shared<ModelReport>();
  tick.unplaced = {"UNPLACED robot 'arm': 7 of its 8 links never had a pose"};
  tick.snapshot = scene.commit(Time{1}, {});
  params.max_reasons = 2;
  const msg::Status status = statusOf(tick, params);
  EXPECT_EQ(status.world.reasons,
            std::vector<std::string>({tick.unplaced[0], "UNPLACED obstacle/a: it never had a pose (frame 'world')"}));
  EXPECT_EQ(status.world.reasons_total, 3u);
  EXPECT_EQ(status.not_ready, tick.unplaced);
}

}  // namespace
}  // namespace hgrid
