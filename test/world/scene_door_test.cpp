// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <functional>

#include "test/support/refusals.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::refusalOf;
using test::says;

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

/// Two spheres that are near each other. Calls that are refused must not change the spheres or their pair.
class Door : public ::testing::Test {
 protected:
  Door() : scene_(options()) {
    a_ = test::put(scene_, test::ball("a"), test::at(0));
    b_ = test::put(scene_, test::ball("b"), test::at(0.5));
  }
  static SceneOptions options() {
    SceneOptions options;
    options.max_bodies = 3;
    return options;
  }
  void expectUnchanged() {
    EXPECT_EQ(scene_.size(), 2u);
    EXPECT_EQ(scene_.poseOf(a_).world_from_body.translation().x(), 0.0);
    EXPECT_EQ(scene_.poseOf(b_).world_from_body.translation().x(), 0.5);
    const auto snapshot = scene_.commit(Time{++tick_}, {});
    EXPECT_EQ(test::namedPairs(*snapshot), test::NamePairs({{"obstacle/a", "obstacle/b"}}));
    EXPECT_EQ(snapshot->pairs()[0].since, Time{1}) << "a refused call has interrupted the pair";
    EXPECT_TRUE(snapshot->complete());
  }
  void expectRefused(Code code, const std::function<void()>& act, const std::string& word) {
    std::string sentence;
    EXPECT_EQ(refusalOf(act, &sentence), code) << word;
    EXPECT_TRUE(says(sentence, word));
    expectUnchanged();
  }
  Scene scene_;
  BodyId a_, b_;
  int tick_ = 0;
};

TEST_F(Door, ANameThatIsThereAlreadyIsRefused) {
  expectRefused(
      Code::dup_id, [&] { scene_.add(test::ball("a")); }, "obstacle/a");
  expectRefused(
      Code::dup_id, [&] { scene_.add(test::ball("b", 3.0)); }, "obstacle/b");
}

TEST_F(Door, ANameThatIsNoneIsRefused) {
  for (const std::string& bad :
       {std::string(), std::string("noslash"), std::string("/local"), std::string("source/"), std::string("a\n/b"),
        std::string("a/b\0c", 5), "a/" + std::string(129, 'x'), std::string("a/\xff")}) {
    Body body = test::ball("x");
    body.name = bad;
    expectRefused(
        Code::bad_id, [&] { scene_.add(body); }, "");
  }
  Body longest = test::ball("x");
  longest.name = "a/" + std::string(128, 'x');
  EXPECT_EQ(refusalOf([&] { scene_.add(longest); }), Code::ok);
}

TEST_F(Door, OneBodyTooManyIsRefusedAndRoomIsMadeByRemoving) {
  const BodyId c = test::put(scene_, test::ball("c"), test::at(50));
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { scene_.add(test::ball("d")); }, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "3"));
  EXPECT_EQ(scene_.size(), 3u);
  scene_.remove(c);
  EXPECT_EQ(refusalOf([&] { scene_.add(test::ball("d")); }), Code::ok);
}

TEST_F(Door, PaddingsAndMarginsOutOfRangeAreRefused) {
  for (const double bad : {-1.0, -1e-300, kNan, kInfinity, 1e9}) {
    Body body = test::ball("x");
    body.margin = bad;
    expectRefused(
        Code::out_of_range, [&] { scene_.add(body); }, "margin");
    body = test::ball("x");
    body.shapes[0].padding = bad;
    expectRefused(
        Code::out_of_range, [&] { scene_.add(body); }, "padding");
    SceneOptions options;
    options.margin = bad;
    EXPECT_EQ(refusalOf([&] { Scene{options}; }), Code::out_of_range) << bad;
    options = SceneOptions{};
    options.event_hysteresis = bad;
    EXPECT_EQ(refusalOf([&] { Scene{options}; }), Code::out_of_range) << bad;
  }
}

TEST_F(Door, AShapeThatStandsNowhereIsRefused) {
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e300}) {
    Body body = test::ball("x");
    body.shapes[0].body_from_shape.translation().y() = bad;
    const Code code = refusalOf([&] { scene_.add(body); });
    EXPECT_TRUE(code == Code::nonfinite || code == Code::out_of_range)
        << "position " << bad << " gives code " << name(code);
    if (code == Code::ok)
      scene_.remove([&] {
        BodyId id;
        scene_.find("obstacle/x", id);
        return id;
      }());
  }
  expectUnchanged();
}

TEST_F(Door, APoseThatIsNotFiniteIsRefused) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      for (const double bad : {kNan, kInfinity, -kInfinity}) {
        Pose pose = test::at(9);
        pose.matrix()(row, column) = bad;
        expectRefused(
            Code::nonfinite, [&] { scene_.place(a_, pose, Time{9}); }, "obstacle/a");
      }
    }
  }
}

TEST_F(Door, APoseBeyondTheWorldIsRefusedAndOneAtItsEndIsNot) {
  for (const double beyond : {std::nextafter(1e6, 2e6), 1e7, 1e16, 1e300}) {
    expectRefused(
        Code::out_of_range, [&] { scene_.place(a_, test::at(0, -beyond), Time{9}); }, text(1e6));
    expectRefused(
        Code::out_of_range, [&] { scene_.place(b_, test::at(0, 0, beyond), Time{9}); }, "obstacle/b");
  }
  for (const double within : {1e6, -1e6, std::nextafter(1e6, 0.0)}) {
    EXPECT_EQ(refusalOf([&] { scene_.place(a_, test::at(within), Time{9}); }), Code::ok);
  }
}

TEST_F(Door, AHandleWhoseBodyIsGoneIsRefused) {
  const BodyId old = test::put(scene_, test::ball("c"), test::at(50));
  scene_.remove(old);
  const BodyId next = scene_.add(test::ball("c"));
  EXPECT_NE(old, next) << "a new body has the handle of a removed body";
  scene_.remove(next);
  for (const BodyId& gone :
       {old, next, BodyId{99, 0}, BodyId{0xffffffff, 0xffffffff}, BodyId{a_.slot, a_.generation + 1}}) {
    expectRefused(
        Code::unknown_id, [&] { scene_.remove(gone); }, "");
    expectRefused(
        Code::unknown_id, [&] { scene_.place(gone, test::at(1), Time{2}); }, "");
    expectRefused(
        Code::unknown_id, [&] { scene_.setState(gone, Freshness::lost, 1.0); }, "");
    expectRefused(
        Code::unknown_id, [&] { scene_.body(gone); }, "");
    expectRefused(
        Code::unknown_id, [&] { scene_.poseOf(gone); }, "");
  }
}

TEST_F(Door, FindKnowsWhoIsThere) {
  BodyId id;
  ASSERT_TRUE(scene_.find("obstacle/b", id));
  EXPECT_EQ(id, b_);
  EXPECT_EQ(scene_.body(id).name, "obstacle/b");
  EXPECT_FALSE(scene_.find("obstacle/c", id));
  scene_.remove(b_);
  EXPECT_FALSE(scene_.find("obstacle/b", id));
}

TEST_F(Door, TheRevisionChangesWithTheBodiesOnly) {
  const auto first = scene_.commit(Time{1}, {});
  const std::uint64_t before = first->structure().revision;
  EXPECT_EQ(scene_.revision(), before);
  scene_.place(a_, test::at(0.1), Time{2});
  scene_.setState(a_, Freshness::late, 1.0);
  const auto second = scene_.commit(Time{2}, {});
  EXPECT_EQ(second->structure().revision, before);
  EXPECT_EQ(&second->structure(), &first->structure()) << "two snapshots of one revision do not share their structure";
  scene_.add(test::ball("c"));
  EXPECT_GT(scene_.commit(Time{3}, {})->structure().revision, before);
}

TEST_F(Door, ANewEpochCountsFromOneAndForgetsSinceWhen) {
  EXPECT_EQ(scene_.commit(Time{5}, {})->pairs().at(0).since, Time{5});
  const auto before = scene_.commit(Time{6}, {});
  EXPECT_EQ(before->pairs().at(0).since, Time{5});
  EXPECT_EQ(before->sequence(), 2u);
  scene_.beginEpoch(77);
  const auto after = scene_.commit(Time{3}, {});
  EXPECT_EQ(after->epoch(), 77u);
  EXPECT_EQ(after->sequence(), 1u);
  EXPECT_EQ(after->pairs().at(0).since, Time{3});
  EXPECT_NE(before->epoch(), 77u);
}

}  // namespace
}  // namespace hgrid
