// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/this_node.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// Starts another process that publishes the frame b in `parent` 20 times per second.
std::unique_ptr<ChildProcess> rivalOf(const std::string& parent) {
  const std::string message = "{transforms: [{header: {stamp: now, frame_id: " + parent +
                              "}, child_frame_id: b, transform: {translation: {x: 3.0}, rotation: {w: 1.0}}}]}";
  const std::vector<std::string> command = {"rostopic", "pub", "-s", "-r", "20", "/tf", "tf2_msgs/TFMessage", message};
  return std::make_unique<ChildProcess>(command, "/dev/null", std::map<std::string, std::string>{});
}

bool isWarned(const Heard& all) {
  const auto found = all.diagnostics.find("transforms");
  return found != all.diagnostics.end() && found->second.level == DiagnosticStatus::WARN &&
         found->second.message.find("only one publisher may place a frame") != std::string::npos;
}

TEST(TransformFights, AreReportedWithBothPublishersWhileTheyLastAndNotForLong) {
  for (const std::string parent : {"island", "base"}) {
    SCOPED_TRACE(parent);
    TransformSource transforms;
    NodeSetup setup;
    setup.params = dict({{"late_after", 1.0}, {"stale_after", 2.0}, {"lost_after", 5.0}});
    setup.beside["robot_description"] = balls({"a", "b"});
    NodeUnderTest node(setup);
    transforms.stream("base", "a", at(0));
    transforms.stream("base", "b", at(0.25));
    node.waitForComplete();
    EXPECT_TRUE(node.heard().status.back()->contested_frames.empty());

    std::unique_ptr<ChildProcess> rival = rivalOf(parent);
    const auto status = node.waitForStatus("the contested frame is listed",
                                           [](const msg::Status& s) { return !s.contested_frames.empty(); });
    const std::string sentence = status->contested_frames.at(0);
    EXPECT_TRUE(says(sentence, "frame 'b' comes from /"));
    EXPECT_TRUE(says(sentence, ros::this_node::getName() + " with parent 'base'"));
    EXPECT_TRUE(says(sentence, "from /rostopic_"));
    EXPECT_TRUE(says(sentence, "with parent '" + parent + "'"));
    ASSERT_NE(entryOf(*status, "robot/b"), nullptr);
    EXPECT_EQ(entryOf(*status, "robot/b")->code.name, "CONFLICT");
    EXPECT_EQ(entryOf(*status, "robot/b")->code.text, sentence);
    EXPECT_EQ(stateOf(*status, "robot/b"), msg::BodyState::INVALID);
    EXPECT_EQ(entryOf(*status, "robot/a"), nullptr);
    EXPECT_FALSE(status->world.complete);
    EXPECT_EQ(node.sphere(20, 0, 0, 0.1).answer.verdict, msg::Verdict::UNKNOWN);
    EXPECT_NEAR(xOf(node, "robot/b"), 0.25, 1e-6) << "the transforms of the first publisher are used";
    node.waitUntil("/diagnostics warn", isWarned);
    EXPECT_GT(counter(*node.heard().status.back(), "tf.fight.CONFLICT"), 0u);
    EXPECT_TRUE(throttled(node, "tf.fight.CONFLICT"));

    rival.reset();
    node.waitForStatus("no frame is contested any more",
                       [](const msg::Status& s) { return s.contested_frames.empty() && s.bodies_total == 0; });
    node.waitForComplete();
    node.waitUntil("/diagnostics no longer warn", [](const Heard& all) { return !isWarned(all); });
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
