// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>
#include <hgrid_proximity/MeasureStatus.h>

#include <functional>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/distances/pair_meter.h"
#include "src/node/messages/distances_messages.h"
#include "src/node/messages/events_messages.h"
#include "test/support/maps.h"
#include "test/support/scenes.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {
namespace {

/// Two bodies in contact: a mesh, whose shape is a cube of 1 m at the origin, and another body.
class ContactMessages : public ::testing::Test {
 protected:
  Body bodyOf(const std::string& name, const Shape& shape) {
    Body body = obstacle(name);
    body.shapes.push_back(shapeOf(shape));
    body.shapes.front().solid = narrow_phase_->solidOf(shape);
    return body;
  }
  /// Adds the mesh and another body, and makes the messages of the tick.
  void add(const Shape& other, const Pose& world_from_other) {
    put(scene_, bodyOf("a", meshOf(boxMesh({1, 1, 1}))), Pose::Identity());
    put(scene_, bodyOf("b", other), world_from_other);
    tell();
  }
  void tell() {
    Tick tick;
    tick.snapshot = scene_.commit(Time{1}, {});
    PairMeter meter(narrow_phase_, {});
    distances_ = distancesMessage(tick, {}, meter.measure(*tick.snapshot).get(), Params());
    const auto messages = eventsMessages(tick, {}, Params(), *narrow_phase_);
    ASSERT_EQ(messages.size(), 1u);
    events_ = messages[0];
    ASSERT_EQ(distances_->status.size(), 1u);
    ASSERT_EQ(events_->distance.size(), 1u);
  }
  /// Expects in both messages: a point for which `isInBoth` holds, and this normal and depth.
  void expectContact(const std::function<bool(const Eigen::Vector3d&)>& isInBoth, const Eigen::Vector3d& normal,
                     double depth) const {
    expectContact(*distances_, isInBoth, normal, depth);
    expectContact(*events_, isInBoth, normal, depth);
  }

  std::shared_ptr<NarrowPhase> narrow_phase_ = makeCoreNarrowPhase();
  Scene scene_{SceneOptions{}};
  boost::shared_ptr<msg::Distances> distances_;
  boost::shared_ptr<msg::Events> events_;

 private:
  static Eigen::Vector3d vectorOf(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

  template <class Message>
  static void expectContact(const Message& message, const std::function<bool(const Eigen::Vector3d&)>& isInBoth,
                            const Eigen::Vector3d& normal, double depth) {
    EXPECT_EQ(message.distance[0], 0.0);
    const Eigen::Vector3d point = vectorOf(message.contact_point[0]);
    EXPECT_TRUE(isInBoth(point)) << point.transpose();
    EXPECT_TRUE(vectorOf(message.point_on_first[0]).allFinite());
    EXPECT_TRUE(vectorOf(message.point_on_second[0]).allFinite());
    const Eigen::Vector3d told(message.normal[0].x, message.normal[0].y, message.normal[0].z);
    EXPECT_TRUE(told.isApprox(normal, 1e-6)) << told.transpose();
    EXPECT_NEAR(message.depth[0], depth, 1e-6);
  }
};

bool isInCube(const Eigen::Vector3d& point, const Eigen::Vector3d& center, double edge) {
  return (point - center).cwiseAbs().maxCoeff() <= 0.5 * edge + 1e-6;
}

TEST_F(ContactMessages, DescribeMeshesThatCross) {
  add(meshOf(boxMesh({1, 1, 1})), at(0.9, 0.3, 0.2));
  EXPECT_EQ(distances_->status[0], msg::MeasureStatus::CONTACT);
  const auto is_in_both = [](const Eigen::Vector3d& point) {
    return isInCube(point, {0, 0, 0}, 1.0) && isInCube(point, {0.9, 0.3, 0.2}, 1.0);
  };
  expectContact(is_in_both, {1, 0, 0}, 0.1);
}

TEST_F(ContactMessages, DescribeABodyInsideAMesh) {
  add(Shape::box({0.2, 0.2, 0.2}), at(0.1, -0.2, 0));
  EXPECT_EQ(distances_->status[0], msg::MeasureStatus::CONTAINED);
  expectContact([](const Eigen::Vector3d& point) { return isInCube(point, {0.1, -0.2, 0}, 0.2); }, {0, -1, 0}, 0.4);
}

TEST_F(ContactMessages, DescribeTheCellOfAMapThatAMeshCrosses) {
  put(scene_, bodyOf("a", meshOf(boxMesh({1, 1, 1}))), Pose::Identity());
  Voxel cell;
  cell.x = Voxel::kOriginKey + 1;  // x: 0.25 .. 0.5 m in the map
  cell.y = cell.z = Voxel::kOriginKey;
  const auto grid = std::make_shared<StaticGrid>(0.25, std::vector<Voxel>{cell});
  scene_.setCells(put(scene_, mapBody("hall"), at(0.2)), makeMapCells(grid, *narrow_phase_));
  tell();
  const auto is_in_both = [](const Eigen::Vector3d& point) {
    return isInCube(point, {0, 0, 0}, 1.0) && isInCube(point, {0.575, 0.125, 0.125}, 0.25);
  };
  const bool map_first = distances_->names[0].find("hall") != std::string::npos;
  expectContact(is_in_both, map_first ? Eigen::Vector3d(-1, 0, 0) : Eigen::Vector3d(1, 0, 0), 0.05);
}

TEST_F(ContactMessages, SayNothingAboutBodiesThatAreApart) {
  add(meshOf(boxMesh({1, 1, 1})), at(1.05));
  EXPECT_EQ(distances_->status[0], msg::MeasureStatus::MEASURED);
  EXPECT_TRUE(std::isnan(distances_->contact_point[0].x) && std::isnan(events_->contact_point[0].x));
  EXPECT_TRUE(std::isnan(distances_->depth[0]) && std::isnan(events_->depth[0]));
  EXPECT_NEAR(distances_->normal[0].x, 1.0, 1e-9);
  EXPECT_NEAR(events_->normal[0].x, 1.0, 1e-9);
  EXPECT_NEAR(distances_->point_on_first[0].x, 0.5, 1e-9);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
