// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/BodyState.h>

#include <cmath>
#include <limits>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

/// A robot has three spheres: a and b are near each other, c is far away. Each message has one transform for each
/// sphere, all with the same stamp. A wrong transform of a must not affect b and c. The age limits are too long to have
/// an effect.
class TransformNumbers : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    transforms_ = std::make_unique<TransformSource>();
    NodeSetup setup;
    setup.params = dict({{"stale_after", 3600.0}, {"lost_after", 3600.0}, {"late_after", 3600.0}});
    setup.beside["robot_description"] = balls({"a", "b", "c"});
    node_ = std::make_unique<NodeUnderTest>(setup);
    send(at(0));
    node_->waitForComplete();  // the node may load the robot after the first transforms arrive
  }
  static void TearDownTestSuite() {
    node_.reset();
    transforms_.reset();
  }
  void SetUp() override { good(); }

  static void send(const geometry_msgs::Transform& a) {
    const ros::Time now = transforms_->now();
    transforms_->send(
        {stamped("base", "a", a, now), stamped("base", "b", at(0.25), now), stamped("base", "c", at(9), now)});
  }
  static msg::Status::ConstPtr take(const geometry_msgs::Transform& a) {
    send(a);
    return node_->waitForTransforms(transforms_->sent());
  }
  static void good() { EXPECT_TRUE(take(at(0))->world.complete); }
  /// Waits until robot/a is INVALID with this code. Checks that the node uses its last valid pose. Then sends a valid
  /// pose.
  static void expectRefused(const std::string& code, const std::string& words) {
    const auto status = node_->waitForStatus("a is refused: " + code + " " + words, [&](const msg::Status& s) {
      const auto* entry = entryOf(s, "robot/a");
      return entry != nullptr && entry->code.text.find(words) != std::string::npos;
    });
    const msg::BodyStatus& a = *entryOf(*status, "robot/a");
    EXPECT_EQ(a.code.name, code);
    EXPECT_TRUE(says(a.code.text, "a"));
    EXPECT_EQ(a.state, msg::BodyState::INVALID);
    EXPECT_EQ(entryOf(*status, "robot/b"), nullptr) << "the transform of b in the same message is valid";
    EXPECT_FALSE(status->world.complete);
    EXPECT_TRUE(oneSays(status->world.reasons, "INVALID robot/a"));
    EXPECT_NEAR(xOf(*node_, "robot/a"), 0.0, 1e-6) << "the last valid pose is kept";
    const auto pairs = node_->waitForPairs("the pair is flagged", [](const msg::Pairs& p) {
      const int i = indexOf(p, "robot/a", "robot/b");
      return i >= 0 && p.state[static_cast<std::size_t>(i)] == msg::BodyState::INVALID;
    });
    EXPECT_NEAR(pairs->gap.at(0), 0.05, 1e-6);
    EXPECT_TRUE(node_->process().alive());
    good();
  }

  static std::unique_ptr<TransformSource> transforms_;
  static std::unique_ptr<NodeUnderTest> node_;
};

std::unique_ptr<TransformSource> TransformNumbers::transforms_;
std::unique_ptr<NodeUnderTest> TransformNumbers::node_;

TEST_F(TransformNumbers, ANumberThatIsNotFiniteIsRefusedByField) {
  static double geometry_msgs::Vector3::*const kPosition[] = {&geometry_msgs::Vector3::x, &geometry_msgs::Vector3::y,
                                                              &geometry_msgs::Vector3::z};
  static double geometry_msgs::Quaternion::*const kRotation[] = {
      &geometry_msgs::Quaternion::x, &geometry_msgs::Quaternion::y, &geometry_msgs::Quaternion::z,
      &geometry_msgs::Quaternion::w};
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    const std::string value = std::isnan(bad) ? "nan" : bad > 0.0 ? "inf" : "-inf";
    for (int field = 0; field < 7; ++field) {
      geometry_msgs::Transform transform = at(0);
      std::string name = "position.";
      if (field < 3) {
        transform.translation.*kPosition[field] = bad;
        name += "xyz"[field];
      } else {
        transform.rotation.*kRotation[field - 3] = bad;
        name = std::string("orientation.") + "xyzw"[field - 3];
      }
      SCOPED_TRACE(name + " " + value);
      send(transform);
      expectRefused("NONFINITE", name + " is " + value + "; it must be finite");
    }
  }
  EXPECT_TRUE(throttled(*node_, "tf.refused.NONFINITE"));
}

TEST_F(TransformNumbers, AQuaternionThatIsNoRotationIsRefused) {
  for (const double w : {0.0, std::sqrt(0.9), std::sqrt(1.1), 1e-200, 1e200}) {
    SCOPED_TRACE(w);
    geometry_msgs::Transform transform = at(0);
    transform.rotation.w = w;
    if (w == 1e-200 || w == 1e200) transform.rotation.x = transform.rotation.y = transform.rotation.z = w;
    send(transform);
    expectRefused("BAD_ROTATION", "it must be within 0.97 .. 1.03");
  }
  EXPECT_TRUE(throttled(*node_, "tf.refused.BAD_ROTATION"));
}

TEST_F(TransformNumbers, AQuaternionThatIsAlmostARotationIsNormalizedAndCounted) {
  for (const double squared_norm : {0.99, 1.01}) {
    SCOPED_TRACE(squared_norm);
    const auto before = counter(*take(at(0)), "tf.renormalised");
    geometry_msgs::Transform transform = at(0.01);
    transform.rotation.w = std::sqrt(squared_norm);
    const auto status = take(transform);
    EXPECT_EQ(counter(*status, "tf.renormalised"), before + 1);
    EXPECT_TRUE(status->world.complete);
    EXPECT_NEAR(xOf(*node_, "robot/a"), 0.01, 1e-6);
  }
}

TEST_F(TransformNumbers, APlaceOutsideTheWorldIsRefusedAndTheLimitNamed) {
  for (const double x : {1e7, -1e7, 1e16, 1e300}) {
    SCOPED_TRACE(x);
    send(at(x));
    expectRefused("OUT_OF_RANGE", "it must be within -1");
  }
  EXPECT_GE(node_->lines("pose.refused.OUT_OF_RANGE") + node_->lines("tf.refused.OUT_OF_RANGE"), 1u);
  EXPECT_LE(node_->lines("pose.refused.OUT_OF_RANGE"), 1u + static_cast<std::size_t>(node_->uptime()));
}

TEST_F(TransformNumbers, TheWorldEndsExactlyAtItsLimit) {
  for (const double limit : {1e6, -1e6}) {
    SCOPED_TRACE(limit);
    EXPECT_TRUE(take(at(limit))->world.complete);
    const auto answer = node_->sphere(limit, 0, 0, 0.0).answer;
    EXPECT_EQ(namesOf(answer), std::vector<std::string>({"robot/a"}));
    good();
    send(at(std::nextafter(limit, 2.0 * limit)));
    expectRefused("OUT_OF_RANGE", "it must be within -1000000 .. 1000000 m");
  }
}

TEST_F(TransformNumbers, MinusZeroAndTheSmallestNumbersAreZero) {
  const double denormal = std::numeric_limits<double>::denorm_min();
  take(at(0));
  const double zero = xOf(*node_, "robot/a");
  for (const double tiny : {-0.0, denormal, -denormal, 1e-310}) {
    SCOPED_TRACE(tiny);
    geometry_msgs::Transform transform = at(tiny, tiny, tiny);
    transform.rotation.x = tiny;
    const auto status = take(transform);
    EXPECT_TRUE(status->world.complete);
    EXPECT_EQ(xOf(*node_, "robot/a"), zero);
    EXPECT_NEAR(node_->heard().pairs.back()->gap.at(0), 0.05, 1e-6);
  }
}

TEST_F(TransformNumbers, AFrameNeedsANameAndAnotherParent) {
  const auto refused = [&](const std::string& parent, const std::string& child, const std::string& words) {
    const auto before = counter(*take(at(0)), "tf.refused.BAD_ID");
    transforms_->send({stamped(parent, child, at(1), transforms_->now())});
    const auto status = node_->waitForTransforms(transforms_->sent());
    EXPECT_EQ(counter(*status, "tf.refused.BAD_ID"), before + 1) << words;
  };
  refused("base", "", "an empty child");
  refused("", "d", "an empty parent");
  refused("/", "d", "nothing but a slash");
  refused("d", "d", "its own parent");
  refused("base", std::string(100000, 'x'), "a name of 100,000 bytes");
  refused(std::string(257, 'x') + "\n\x1b[31m", "d", "a name with an escape sequence");
  EXPECT_EQ(node_->output().find("\x1b[31m\n"), std::string::npos) << "names are escaped in the log";
  EXPECT_TRUE(throttled(*node_, "tf.refused.BAD_ID"));
  EXPECT_TRUE(node_->heard().status.back()->world.complete);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
