// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/states/state_scene.h"

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/maps/map_cells.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kSide = 4.0;   // [m] edge of the cube around the base that has the boxes
constexpr double kFree = 0.45;  // [m] no box is nearer to the axis of the base

Eigen::Matrix3d randomTurn(Random& random) {
  Eigen::Quaterniond turn;
  do {
    for (int i = 0; i < 4; ++i) turn.coeffs()[i] = random.uniform(-1, 1);
  } while (turn.squaredNorm() > 1.0 || turn.squaredNorm() < 0.01);
  return turn.normalized().toRotationMatrix();
}

}  // namespace

std::vector<OrientedBox> randomBoxes(std::size_t count) {
  Random random(count);
  const double least = count <= 100 ? 0.03 : 0.02, most = count <= 100 ? 0.10 : 0.03;
  std::vector<OrientedBox> boxes;
  while (boxes.size() < count) {
    OrientedBox box;
    for (int k = 0; k < 3; ++k) {
      box.size[k] = random.uniform(least, most);
      box.world_from_box.translation()[k] = random.uniform(-0.5 * kSide, 0.5 * kSide);
    }
    box.world_from_box.linear() = randomTurn(random);
    if (box.world_from_box.translation().head<2>().norm() - 0.5 * box.size.norm() > kFree) boxes.push_back(box);
  }
  return boxes;
}

std::vector<OrientedBox> StateWorld::allBoxes() const {
  std::vector<OrientedBox> all = boxes;
  if (!map) return all;
  for (const Voxel& leaf : map->occupied) {
    const Eigen::Vector3d low = minCorner(leaf, map->resolution), high = maxCorner(leaf, map->resolution);
    OrientedBox box;
    box.size = high - low;
    box.world_from_box = world_from_map * Eigen::Translation3d(0.5 * (low + high));
    all.push_back(box);
  }
  return all;
}

StateWorld randomWorld(std::size_t boxes) { return {randomBoxes(boxes), {}, Pose::Identity()}; }

StateScene::StateScene(const StateRobot& tested, const StateWorld& world)
    : robot(tested),
      kinematics(robot.model),
      matrix(std::make_shared<const LinkMatrix>(robot.model, robot.rules, warnings)),
      narrow_phase(makeCoreNarrowPhase()) {
  Scene scene{SceneOptions{}};
  addRobot(scene);
  addBoxes(scene, world.boxes, *narrow_phase);
  if (world.map) addMap(scene, world);
  StateCheckerOptions options;
  options.group = robot.group;
  checker = std::make_unique<StateChecker>(scene.commit(Time{1}, {}), kinematics, "robot", narrow_phase, options);
  batch.joints = robot.group;
  batch.world_from_root = Pose::Identity();
  batch.others.resize(kinematics.variables().size());
}

void StateScene::addRobot(Scene& scene) {
  for (std::uint32_t i = 0; i < robot.model.links.size(); ++i) {
    RobotLink& link = robot.model.links[i];
    if (link.shapes.empty()) continue;
    for (BodyShape& shape : link.shapes) shape.solid = narrow_phase->solidOf(shape.shape);
    scene.place(scene.add(linkBody(robot.model, i, "robot", matrix)), Pose::Identity(), Time{1});
  }
}

void StateScene::addMap(Scene& scene, const StateWorld& world) {
  Body body;
  body.name = "map/building";
  body.frame = "world";
  body.kind = BodyKind::map;
  body.mobility = Mobility::fixed;
  const BodyId id = scene.add(body);
  scene.place(id, world.world_from_map, Time{1});
  const auto grid = std::make_shared<const StaticGrid>(world.map->resolution, world.map->occupied);
  scene.setCells(id, makeMapCells(grid, *narrow_phase));
}

void addBoxes(Scene& scene, const std::vector<OrientedBox>& boxes, NarrowPhase& narrow_phase) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Body body;
    body.name = "obstacle/b" + std::to_string(i);
    body.frame = "world";
    body.mobility = Mobility::fixed;
    const Shape shape = Shape::box(boxes[i].size);
    body.shapes.push_back({shape, Pose::Identity(), 0.0, {}, Eigen::Vector3d::Ones(), narrow_phase.solidOf(shape)});
    scene.place(scene.add(body), boxes[i].world_from_box, Time{1});
  }
}

std::vector<double> StateScene::randomStates(Random& random, std::size_t count) const {
  std::vector<double> states;
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::string& name : robot.group) {
      const JointVariable& variable = kinematics.variables()[std::size_t(kinematics.find(name))];
      states.push_back(std::isfinite(variable.lower) ? random.uniform(variable.lower, variable.upper)
                                                     : random.uniform(-M_PI, M_PI));
    }
  }
  return states;
}

}  // namespace bench
}  // namespace hgrid
