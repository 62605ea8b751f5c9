// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Random robots and worlds for the tests of StateChecker, and an oracle that measures all shapes.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/maps/map_cells.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "narrow/mesh_solid.h"
#include "test/support/joints.h"
#include "test/support/maps.h"
#include "test/support/scenes.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {

/// The narrow phase that all worlds of a test program share.
inline const std::shared_ptr<NarrowPhase>& narrowPhase() {
  static const std::shared_ptr<NarrowPhase> shared = makeCoreNarrowPhase();
  return shared;
}

inline BodyShape solidShape(const Shape& shape, const Pose& body_from_shape = Pose::Identity(), double padding = 0.0) {
  BodyShape result = shapeOf(shape);
  result.body_from_shape = body_from_shape;
  result.padding = padding;
  result.solid = narrowPhase()->solidOf(shape);
  return result;
}

/// A robot in a world, and the shapes of both as a list.
struct StateWorld {
  RobotModel model;
  std::shared_ptr<const LinkMatrix> matrix;
  std::shared_ptr<Scene> scene;
  std::shared_ptr<const Snapshot> snapshot;

  Kinematics kinematics() const { return Kinematics(model); }
  StateChecker checker(const StateCheckerOptions& options = {}) const {
    return {snapshot, kinematics(), "robot", narrowPhase(), options};
  }
};

/// Describes how a random world looks.
struct WorldPlan {
  int links = 6, obstacles = 12;
  int shapes = 3;      ///< largest number of shapes of a link
  double size = 0.15;  ///< [m] of these shapes
  double far = 1.2;    ///< [m] how far obstacles are from the origin along each axis
  bool attached = true, map = true, plane = true;
  bool closed_meshes = false;  ///< whether the links are those of addClosedMeshes()
  Pose world_from_root = Pose::Identity();
};

/// Gives each moving link of a robot random shapes, at least one and at most `most`. @param size  [m] of the shapes
inline void addShapes(RobotModel& model, Random& random, int most = 3, double size = 0.15) {
  for (RobotLink& link : model.links) {
    link.has_collision = random.chance(0.8);
    for (int i = random.between(1, most); link.has_collision && i > 0; --i) {
      link.shapes.push_back(solidShape(randomShape(random, size), randomPose(random, 0.1),
                                       random.chance(0.2) ? random.uniform(0, 0.02) : 0.0));
    }
  }
  model.links[0].has_collision = true;
  if (model.links[0].shapes.empty()) model.links[0].shapes.push_back(solidShape(Shape::sphere(0.05)));
}

/// Makes the lattice of a shape, if it is a closed mesh. @returns whether it has one
inline bool makeLattice(const BodyShape& shape) {
  const auto* mesh = dynamic_cast<const MeshSolid*>(shape.solid.get());
  for (int i = 0; mesh != nullptr && mesh->lattice() == nullptr && i < 10000; ++i) mesh->countApart();
  return mesh != nullptr && mesh->lattice() != nullptr;
}

/// Gives each link of a robot a closed mesh with a lattice: the first link a tray, in which the others are.
/// @param size  [m] longest side of the meshes of the others
inline void addClosedMeshes(RobotModel& model, Random& random, double size) {
  for (RobotLink& link : model.links) {
    const bool is_first = &link == &model.links.front();
    const TriangleMesh mesh =
        is_first ? trayMesh({1.5, 1.5, 0.8}, 0.03) : lumpMesh(random, {size, 0.6 * size, 0.5 * size});
    link.has_collision = true;
    link.shapes = {solidShape(meshOf(mesh), randomPose(random, 0.1), random.chance(0.2) ? 0.01 : 0.0)};
    makeLattice(link.shapes.front());
  }
}

inline StateWorld randomStateWorld(Random& random, const WorldPlan& plan) {
  StateWorld world;
  world.model = randomMechanism(random, plan.links, 0.25);
  plan.closed_meshes ? addClosedMeshes(world.model, random, plan.size)
                     : addShapes(world.model, random, plan.shapes, plan.size);
  LinkRules rules;
  if (plan.links > 3) rules.disabled.push_back({"link1", "link3", ""});
  world.matrix = std::make_shared<const LinkMatrix>(matrixOf(world.model, rules));
  SceneOptions options;
  options.origin << 0.25, -0.5, 0.125;
  options.allowed_pairs.push_back({"robot/link*", "obstacle/1*", "test"});
  world.scene = std::make_shared<Scene>(options);
  for (const Body& body : bodiesOf(world.model, "robot", world.matrix)) {
    put(*world.scene, body, body.link == 0 ? plan.world_from_root : randomPose(random, 1.0));
  }
  for (int i = 0; i < plan.obstacles; ++i) {
    Body body = obstacle(std::to_string(i), random.chance(0.5) ? Mobility::fixed : Mobility::moving);
    for (int k = random.between(1, 2); k > 0; --k) {
      body.shapes.push_back(solidShape(randomShape(random, 0.2), randomPose(random, 0.1),
                                       random.chance(0.2) ? random.uniform(0, 0.03) : 0.0));
    }
    put(*world.scene, body, plan.world_from_root * randomPose(random, plan.far));
  }
  if (plan.attached) {
    Body body = obstacle("held");
    body.frame = "link" + std::to_string(plan.links - 1);
    body.frame_from_body = randomPose(random, 0.1);
    body.shapes.push_back(solidShape(Shape::box({0.05, 0.1, 0.15})));
    put(*world.scene, body, randomPose(random, 1.0));
  }
  if (plan.plane) {
    Body body = obstacle("floor", Mobility::fixed);
    body.shapes.push_back(solidShape(Shape::plane()));
    Pose pose = plan.world_from_root;
    pose.translation().z() -= 0.6;
    put(*world.scene, body, pose);
  }
  if (plan.map) {
    const BodyId id = put(*world.scene, mapBody("hall"), plan.world_from_root * randomPose(random, 0.3));
    const auto grid = std::make_shared<StaticGrid>(0.05, randomVoxels(random, 30, 24));
    world.scene->setCells(id, makeMapCells(grid, *narrowPhase()));
  }
  world.snapshot = world.scene->commit(Time{2}, {});
  return world;
}

/// The truth about one state: which bodies are in contact, and the distance of the nearest pair.
struct Truth {
  std::set<std::pair<std::uint32_t, std::uint32_t>> contacts;  ///< bodies, the smaller index first
  double distance = std::numeric_limits<double>::infinity();   ///< [m]
};

/// Measures all shapes of the robot against each other and against all shapes and cells of the snapshot.
class StateOracle {
 public:
  explicit StateOracle(const StateWorld& world) : world_(world), snapshot_(*world.snapshot) {}

  bool surfaces_only = false;  ///< whether a shape that may be inside an open mesh does not count

  /// @param ignored  index of a body that does not count
  Truth of(const std::vector<double>& state, const Pose& world_from_root,
           std::uint32_t ignored = Structure::kNone) const {
    const BodyList& bodies = snapshot_.structure().bodies;
    std::vector<bool> own(bodies.size());
    const std::vector<Pose> poses = posesIn(state, world_from_root, own);
    Truth truth;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      for (std::uint32_t k = 0; k < bodies.size(); ++k) {
        if (!own[i] || (own[k] && k <= i) || i == ignored || k == ignored) continue;
        if (snapshot_.structure().filter.allowed(i, k)) continue;
        const double distance = distanceOf(bodies[i], poses[i], k, poses[k]);
        if (distance <= 0.0) truth.contacts.insert(std::minmax(i, k));
        truth.distance = std::min(truth.distance, distance);
      }
    }
    return truth;
  }

  /// Expects that the point of a contact lies in both bodies of a pair, and that its other values are known. Does
  /// nothing if one of the bodies may be inside an open mesh, since the point may then lie in only one of them.
  void expectContact(const StatePair& pair, const std::vector<double>& state, const Pose& world_from_root) const {
    if (pair.proximity.status == Measure::containment_unknown) return;
    std::vector<bool> own(snapshot_.structure().bodies.size());
    const std::vector<Pose> poses = posesIn(state, world_from_root, own);
    ASSERT_TRUE(pair.contact.point.allFinite());
    Body point;
    point.shapes.push_back(shapeOf(Shape::sphere(1.0)));
    point.shapes.front().solid = narrowPhase()->point();
    const Pose there(Eigen::Translation3d(pair.contact.point));
    for (const std::uint32_t body : {pair.first, pair.second}) {
      EXPECT_LE(distanceOf(point, there, body, poses[body]), 1e-6);
    }
    EXPECT_NEAR(pair.contact.normal.norm(), 1.0, 1e-9);
    EXPECT_GE(pair.contact.depth, 0.0);
  }

 private:
  /// Returns where all bodies are. @param own  for each body: becomes true if the joints move it
  std::vector<Pose> posesIn(const std::vector<double>& state, const Pose& world_from_root,
                            std::vector<bool>& own) const {
    const BodyList& bodies = snapshot_.structure().bodies;
    const Kinematics kinematics = world_.kinematics();
    const JointOracle joints(world_.model, kinematics, state);
    std::vector<Pose> poses;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      poses.push_back(snapshot_.poses()[i].world_from_body);
      const int link = bodies[i].kind == BodyKind::link ? int(bodies[i].link) : world_.model.find(bodies[i].frame);
      if (link < 0 || (bodies[i].kind != BodyKind::link && bodies[i].mobility == Mobility::fixed)) continue;
      own[i] = true;
      poses[i] = world_from_root * joints.rootFromLink(link) * bodies[i].frame_from_body;
    }
    return poses;
  }

  double distanceOf(const Body& i, const Pose& world_from_i, std::uint32_t k, const Pose& world_from_k) const {
    double least = std::numeric_limits<double>::infinity();
    const auto add = [&](const BodyShape& a, const Solid& solid, const Pose& world_from_solid, double padding) {
      const Pose world_from_a = world_from_i * a.body_from_shape;
      const Proximity found =
          narrowPhase()->measure({*a.solid, world_from_a, a.padding}, {solid, world_from_solid, padding}, 1.0);
      if (surfaces_only && found.status == Measure::containment_unknown) return;
      least = std::min(least, found.distance);
    };
    const BodyList& bodies = snapshot_.structure().bodies;
    const auto cells = snapshot_.cellsOf(k);
    for (const BodyShape& a : i.shapes) {
      for (const BodyShape& b : bodies[k].shapes) add(a, *b.solid, world_from_k * b.body_from_shape, b.padding);
      if (!cells) continue;
      for (const Voxel& voxel : cells->grid->voxels()) {
        add(a, *cells->cubes[voxel.level], world_from_k * Eigen::Translation3d(cells->centerOf(voxel)), 0.0);
      }
    }
    return least;
  }

  const StateWorld& world_;
  const Snapshot& snapshot_;
};

/// Returns the pairs of bodies that an answer lists, the smaller index first.
inline std::set<std::pair<std::uint32_t, std::uint32_t>> pairsOf(const StateAnswers& answers, std::size_t state) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  const StateAnswer& answer = answers.states[state];
  for (std::uint32_t i = answer.first_pair; i < answer.first_pair + answer.pairs; ++i) {
    pairs.insert(std::minmax(answers.pairs[i].first, answers.pairs[i].second));
  }
  return pairs;
}

/// Appends a state to a batch.
inline void append(StateBatch& batch, const std::vector<double>& state) {
  batch.positions.insert(batch.positions.end(), state.begin(), state.end());
}

}  // namespace test
}  // namespace hgrid
