// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "audited_world.h"

#include <ros/serialization.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/bodies.h"

namespace hgrid {
namespace test {
namespace {

constexpr int kFrames = 10;

Shape shapeOfNumber(int number) {
  switch (number % 5) {
    case 0:
      return Shape::box(Eigen::Vector3d(0.2, 0.1, 0.3));
    case 1:
      return Shape::cylinder(0.3, 0.05);
    case 2:
      return Shape::cone(0.3, 0.1);
    case 3:
      return Shape::capsule(0.2, 0.05);
    default:
      break;
  }
  const auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {0.2, 0, 0}, {0, 0.3, 0}, {0, 0, 0.1}};
  mesh->triangles = {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}};
  return Shape::mesh(mesh);
}

ObstacleParams obstacle(const std::string& name, const std::string& frame, const Shape& shape) {
  ObstacleParams result;
  result.body.name = "obstacle/" + name;
  result.body.frame = frame;
  result.body.shapes.push_back(shapeOf(shape));
  result.body.shapes.back().padding = 0.01;
  result.body.frame_from_body.translation() = Eigen::Vector3d(0.02, 0.0, 0.05);
  return result;
}

TransformRecord::Message serialized(const geometry_msgs::TransformStamped& transform, bool is_static,
                                    const std::string& publisher, const Moment& now) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  const auto bytes = boost::make_shared<MessageBytes>();
  bytes->size = ros::serialization::serializationLength(message);
  std::vector<std::uint8_t> buffer(bytes->size);
  ros::serialization::OStream stream(buffer.data(), static_cast<std::uint32_t>(buffer.size()));
  ros::serialization::serialize(stream, message);
  bytes->bytes.assign(buffer.begin(), buffer.end());
  return std::make_shared<const ReceivedTransforms>(ReceivedTransforms{bytes, is_static, publisher, now});
}

}  // namespace

Params AuditedWorld::defaults() {
  Params params;
  for (int i = 0; i < kFrames; ++i) {
    const std::string number = std::to_string(i);
    params.obstacles.push_back(obstacle("part" + number, "f" + number, shapeOfNumber(i)));
  }
  for (int i = 0; i < 3; ++i) {
    params.obstacles.push_back(obstacle("post" + std::to_string(i), "base", shapeOfNumber(i)));
    params.obstacles.back().body.frame_from_body.translation().x() = 0.4 * i;
  }
  params.pair_margins = {{"obstacle/part1", "obstacle/*", 0.25}};
  PairRule rule;
  rule.first = "obstacle/part2";
  rule.second = "obstacle/post*";
  params.allowed_pairs = {rule};
  return params;
}

AuditedWorld::AuditedWorld(unsigned seed, const Params& params)
    : world_({"hub", "slow"}, SimulatedWorld::Clock::wall, params),
      random_(seed),
      record_(std::chrono::seconds(2), 1 << 24, 1000) {
  send(randomTransform("f0", "tip", 0.0), true);
}

void AuditedWorld::addRobot(double off, bool published) {
  LoadedRobot robot;
  robot.name = "arm";
  robot.root_frame = "arm_base";
  for (const char* link : {"arm_base", "arm_tool"}) {
    Body body;
    body.name = std::string("arm/") + link;
    body.frame = link;
    body.kind = BodyKind::link;
    body.robot = "arm";
    body.link = static_cast<std::uint32_t>(robot.bodies.size());
    body.shapes.push_back(shapeOf(Shape::sphere(0.1)));
    robot.bodies.push_back(body);
  }
  Pose base_from_tool = Pose::Identity();
  base_from_tool.translation().x() = 0.5 + off;
  robot.groups = {{"arm_base", {{0, Pose::Identity()}, {1, base_from_tool}}}};
  world_.world().setRobot(std::make_shared<const LoadedRobot>(robot));
  if (!published) return;
  geometry_msgs::TransformStamped fixed = randomTransform("arm_base", "arm_tool", 0.0);
  fixed.transform = geometry_msgs::Transform();
  fixed.transform.translation.x = 0.5;
  fixed.transform.rotation.w = 1.0;
  send(fixed, true);
}

void AuditedWorld::declareRobot(bool present) {
  RobotChange change;
  change.operation = present ? RobotOperation::declare_present : RobotOperation::declare_absent;
  change.name = "arm";
  world_.world().applyRobots({change});
}

void AuditedWorld::send(geometry_msgs::TransformStamped transform, bool is_static, const std::string& publisher) {
  record_.begins(*serialized(transform, is_static, publisher, world_.moment()));
  if (!tamper || tamper(transform)) world_.take(transform, is_static, publisher);
  record_.ends(true);
}

geometry_msgs::TransformStamped AuditedWorld::randomTransform(const std::string& parent, const std::string& child,
                                                              double delay) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.header.stamp.fromNSec(
      static_cast<std::uint64_t>((world_.moment().ros - Time(std::llround(1e9 * delay))).count()));
  transform.transform.translation.x = random_.uniform(-0.4, 0.4);
  transform.transform.translation.y = random_.uniform(-0.4, 0.4);
  transform.transform.translation.z = random_.uniform(-0.4, 0.4);
  const Eigen::Quaterniond rotation(
      Eigen::AngleAxisd(random_.uniform(-3.0, 3.0), Eigen::Vector3d(random_.uniform(-1, 1), 0.3, 1.0).normalized()));
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  return transform;
}

const Tick& AuditedWorld::step() {
  world_.wait(0.01);
  const auto move = [&](const std::string& parent, const std::string& child) {
    if (is_silent && is_silent(child)) return;
    send(randomTransform(parent, child, random_.uniform(0.0, 0.004)));
  };
  move("base", "hub");
  move("base", "arm_base");
  for (int i = 0; i < kFrames; ++i) move("hub", "f" + std::to_string(i));
  const Tick& tick = world_.tick();
  if (tick.epoch != epoch_) record_.forgetMoving(tick.made.ros);
  epoch_ = tick.epoch;
  return tick;
}

AuditCase AuditedWorld::audited() {
  static const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  return caseOf(world_.last(), record_.content(), 7, *narrow_phase);
}

}  // namespace test
}  // namespace hgrid
