// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The node computes poses with its own tree of transforms. The tests compare these poses with the poses of tf2.
#include "src/node/tf/tf_tree.h"

#include <gtest/gtest.h>
#include <tf2/buffer_core.h>

#include <algorithm>
#include <map>

#include "test/node/support/moments.h"
#include "test/node/support/transform_views.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

constexpr std::int64_t kStart = 1000000000;  // [ns]
constexpr std::int64_t kStep = 10000000;

std::string frameName(int number) { return "a_frame_with_a_long_name_" + std::to_string(number); }

geometry_msgs::Transform randomTransform(Random& random) {
  geometry_msgs::Transform transform;
  transform.translation.x = random.uniform(-2.0, 2.0);
  transform.translation.y = random.uniform(-2.0, 2.0);
  transform.translation.z = random.uniform(-2.0, 2.0);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                                                     random.uniform(-1.0, 1.0), random.uniform(0.1, 1.0))
                                      .normalized();
  transform.rotation.x = turn.x();
  transform.rotation.y = turn.y();
  transform.rotation.z = turn.z();
  transform.rotation.w = turn.w();
  return transform;
}

/// A random tree of frames. Some frames are static, some are sent at different rates, and some change their parents.
/// The order of the transforms is different in each message.
class RandomTree {
 public:
  RandomTree(std::uint64_t seed, Ledger& ledger) : random_(seed), intake_(1e9, 10.0, 1000, false, ledger) {
    for (int frame = 1; frame < kFrames; ++frame) {
      parent_[frame] = random_.below(4) > 0 ? frame - 1 : random_.below(frame);
      if (random_.below(4) == 0) send({frame}, kStart, true);
      pace_[frame] = random_.below(4) > 0 ? 1 : 1 + random_.below(5);
    }
    changes_ = random_.below(2) == 0;
    const int cycles = random_.between(1, 12);
    for (int cycle = 0; cycle < cycles; ++cycle) {
      std::vector<int> moved;
      for (int frame = 1; frame < kFrames; ++frame) {
        const bool is_fixed = intake_.table().find(frameName(frame)) != TfIntake::kNone &&
                              intake_.frame(intake_.table().find(frameName(frame))).from_static;
        if (is_fixed || cycle % pace_[frame] != 0) continue;
        if (changes_ && random_.below(200) == 0) parent_[frame] = random_.below(frame);
        moved.insert(moved.begin() + random_.below(static_cast<int>(moved.size()) + 1), frame);
      }
      send(moved, kStart + cycle * kStep, false);
    }
    world_ = random_.below(kFrames);
  }

  void expectTheSameAsTf2() {
    std::vector<std::string> frames;
    for (int frame = 0; frame < kFrames; ++frame) frames.push_back(frameName(frame));
    TfTree tree(intake_);
    tree.plan(frameName(world_), frames);
    EXPECT_FALSE(tree.stale());
    tree.look(intake_.ages().read(Moment{Time(kStart), {}}));
    for (int i = 0; i < 8; ++i) {
      const std::int64_t between = random_.below(2) == 0 ? 0 : random_.below(kStep);
      const Time time(kStart + random_.between(-1, 13) * kStep + between);
      SCOPED_TRACE("at " + std::to_string(time.count()));
      tree.place(time);
      for (std::size_t frame = 0; frame < frames.size(); ++frame) expectTheSame(tree, frames[frame], frame, time);
    }
    for (std::size_t frame = 0; frame < frames.size(); ++frame)
      expectNewest(tree.state(frame), static_cast<int>(frame));
  }

 private:
  static constexpr int kFrames = 60;

  void send(const std::vector<int>& frames, std::int64_t stamp, bool is_static) {
    tf2_msgs::TFMessage message;
    for (const int frame : frames) {
      geometry_msgs::TransformStamped transform;
      transform.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
      transform.header.frame_id = frameName(parent_[frame]);
      transform.child_frame_id = frameName(frame);
      transform.transform = randomTransform(random_);
      message.transforms.push_back(transform);
      if (!is_static) newest_[frame] = stamp;
    }
    intake_.take(viewsOf(message), is_static, "test", Moment{Time(stamp), {}});
    for (const auto& transform : message.transforms) witness_.setTransform(transform, "test", is_static);
  }

  std::optional<FramePose> witnessAt(const std::string& target, const std::string& frame, Time time) const {
    if (target == frame) return FramePose{};
    const ros::Time stamp = ros::Time().fromNSec(static_cast<std::uint64_t>(time.count()));
    if (!witness_.canTransform(target, frame, stamp)) return std::nullopt;
    return toFramePose(witness_.lookupTransform(target, frame, stamp).transform);
  }

  void expectTheSame(const TfTree& tree, const std::string& frame, std::size_t index, Time time) {
    SCOPED_TRACE(frame + " in " + frameName(world_));
    ASSERT_TRUE(tree.state(index).connected);
    const FramePose* ours = tree.worldFrom(index);
    std::string why_not;
    const std::optional<FramePose> looked_up = intake_.lookup().at(frameName(world_), frame, time, &why_not);
    EXPECT_EQ(looked_up.has_value(), intake_.lookup().isKnown(frameName(world_), frame, time));
    EXPECT_EQ(looked_up.has_value(), why_not.empty());
    const std::optional<FramePose> witness = witnessAt(frameName(world_), frame, time);
    if (!witness) {
      EXPECT_EQ(ours, nullptr);
      EXPECT_FALSE(looked_up);
      return;
    }
    // While a frame changes its parent, tf2 uses the old parent, but the node does not know the pose. For earlier
    // times, TfTree knows only the chain through the newest parents.
    if (!changes_ || looked_up) {
      ASSERT_TRUE(looked_up) << why_not;
      expectTheSamePose(*looked_up, *witness);
    }
    if (ours == nullptr && changes_) return;
    ASSERT_NE(ours, nullptr);
    expectTheSamePose(*ours, *witness);
    const std::optional<FramePose> alone = tree.worldFrom(index, time);
    ASSERT_TRUE(alone);
    expectTheSamePose(*alone, *witness);
    EXPECT_LE((ours->pose().linear() * ours->pose().linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  }

  void expectTheSamePose(const FramePose& ours, const FramePose& witness) {
    ++compared_;
    EXPECT_LE((ours.translation - witness.translation).norm(), 1e-12 * kFrames);
    EXPECT_LE((ours.pose().linear() - witness.pose().linear()).norm(), 1e-12);
  }

  /// Expects that the newest time of a chain is the oldest among the newest stamps of its moving frames.
  void expectNewest(const ChainState& state, int frame) const {
    const auto upFrom = [&](int at) {
      std::vector<int> chain = {at};
      while (chain.back() != 0) chain.push_back(parent_.at(chain.back()));
      return chain;
    };
    std::vector<int> up = upFrom(frame), down = upFrom(world_);
    while (!up.empty() && !down.empty() && up.back() == down.back()) up.pop_back(), down.pop_back();
    up.insert(up.end(), down.begin(), down.end());
    Time newest = Time::max();
    for (const int at : up) {
      if (newest_.count(at) > 0) newest = std::min(newest, Time(newest_.at(at)));
    }
    EXPECT_EQ(state.moves, newest != Time::max());
    if (state.moves) {
      EXPECT_EQ(state.newest, newest);
    }
  }

 public:
  /// Returns the number of compared poses. These are the poses that both the node and tf2 knew.
  std::size_t compared() const { return compared_; }

 private:
  std::size_t compared_ = 0;
  Random random_;
  TfIntake intake_;
  tf2::BufferCore witness_{ros::Duration(10.0)};
  std::map<int, int> parent_, pace_;
  std::map<int, std::int64_t> newest_;  // newest stamp on /tf, by moving frame
  int world_ = 0;
  bool changes_ = false;  // whether frames change their parents
};

TEST(TfTree, PutsFramesWhereTf2SaysAtAnyTime) {
  std::size_t compared = 0;
  Ledger ledger;  // all trees use one ledger, so they log one line per second in total
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomTree tree(seed, ledger);
    tree.expectTheSameAsTf2();
    compared += tree.compared();
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(compared, 40000u);
}

/// The frame "base" arrives every 4 s up to 8 s, and the frame "arm" in it every 20 ms. Arm stops at 8 s, or at 16 s.
TEST(TfTree, JudgesEachFrameOfAChainByItsOwnPeriod) {
  Ledger ledger;
  TfIntake intake(1.0, 60.0, 100, false, ledger);
  const auto send = [&](const std::string& parent, const std::string& child, double time) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    message.transforms[0].header.frame_id = parent;
    message.transforms[0].header.stamp = ros::Time(100.0 + time);
    message.transforms[0].child_frame_id = child;
    message.transforms[0].transform.rotation.w = 1.0;
    intake.take(viewsOf(message), false, "test", test::moment(100.0 + time, time));
  };
  for (int i = 0; i <= 400; ++i) {
    if (i % 200 == 0) send("world", "base", 0.02 * i);
    send("base", "arm", 0.02 * i);
  }
  TfTree tree(intake, {0.1, 0.25, 2.0});
  tree.plan("world", {"base", "arm"});
  const auto worst = [&](std::size_t frame, double time) {
    tree.look(intake.ages().read(test::moment(100.0 + time, time)));
    return tree.state(frame).worst;
  };
  EXPECT_EQ(worst(1, 8.05), Freshness::fresh);
  EXPECT_EQ(worst(1, 8.15), Freshness::late);
  EXPECT_EQ(worst(1, 8.5), Freshness::stale);
  EXPECT_EQ(worst(1, 10.5), Freshness::lost) << "the period of base must not hide that arm stopped";
  EXPECT_EQ(worst(0, 10.5), Freshness::fresh) << "base is not due before 12 s";
  EXPECT_EQ(worst(0, 14.5), Freshness::lost);
  for (int i = 401; i <= 800; ++i) send("base", "arm", 0.02 * i);
  EXPECT_EQ(worst(1, 16.0), Freshness::lost) << "arm must not hide that base stopped";
}

TEST(TfTree, NamesTheFrameThatWasNeverPublished) {
  Ledger ledger;
  TfIntake intake(1.0, 10.0, 100, false, ledger);
  TfTree tree(intake);
  EXPECT_TRUE(tree.stale()) << "plan() was never called";
  tree.plan("world", {"world", "arm"});
  EXPECT_TRUE(tree.state(0).connected) << "a frame is always connected to itself";
  EXPECT_FALSE(tree.state(1).connected);
  EXPECT_EQ(tree.unknownFrame(1), "arm");

  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = "/base";
  message.transforms[0].child_frame_id = "arm";
  message.transforms[0].transform.rotation.w = 1.0;
  intake.take(viewsOf(message), true, "test", Moment{Time(1), {}});
  EXPECT_TRUE(tree.stale());
  tree.plan("world", {"world", "arm", "base", "hand"});
  EXPECT_EQ(tree.unknownFrame(1), "world");
  EXPECT_EQ(tree.unknownFrame(3), "hand");
  tree.plan("base", {"arm"});
  tree.look(Time(0));
  EXPECT_TRUE(tree.state(0).connected);
  intake.take(viewsOf(message), true, "test", Moment{Time(2), {}});
  EXPECT_FALSE(tree.stale()) << "there is no new frame or parent";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
