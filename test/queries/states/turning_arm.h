// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A robot with one joint: a base at the origin, and an arm that turns about z. On the arm, 0.5 m from the axis, is a
// sphere of radius 0.1 m. While the joint is at 0, the sphere is on the x axis.
#pragma once

#include "test/queries/states/state_worlds.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {

constexpr double kQuarter = 1.5707963267948966;  // [rad] a quarter of a turn

inline RobotModel turningArm() {
  RobotModel model;
  model.name = "robot";
  addLink(model, "base", -1, JointKind::fixed, false);
  addLink(model, "arm", 0, JointKind::revolute, false);
  model.links[1].axis = Eigen::Vector3d::UnitZ();
  model.links[1].lower = -1.0;
  model.links[1].upper = 2.0;
  model.links[0].shapes.push_back(solidShape(Shape::sphere(0.1)));
  model.links[1].shapes.push_back(solidShape(Shape::sphere(0.1), at(0.5)));
  for (RobotLink& link : model.links) link.has_collision = true;
  findRigidGroups(model);
  return model;
}

/// The turning arm in a scene. Tests add bodies and change states, then call check().
class ArmWorld {
 public:
  explicit ArmWorld(const SceneOptions& options = {}, RobotModel robot = turningArm())
      : model(std::move(robot)), scene(options) {
    const auto matrix = std::make_shared<const LinkMatrix>(matrixOf(model));
    for (Body& body : bodiesOf(model, "robot", matrix)) links.push_back(put(scene, body, Pose::Identity()));
  }

  static Body ballBody(const std::string& name, double radius = 0.1) {
    Body body = obstacle(name);
    body.shapes.push_back(solidShape(Shape::sphere(radius)));
    body.max_speed = 1.0;
    return body;
  }

  /// Checks some positions of the joint. Replaces `answers` and `batch`.
  const StateAnswers& check(const std::vector<double>& positions, const StateRequest& request = {},
                            const StateCheckerOptions& options = {}) {
    snapshot = scene.commit(Time{2}, gaps);
    batch.positions = positions;
    const StateChecker checker(snapshot, Kinematics(model), "robot", narrowPhase(), options);
    checker.checkStates(batch, request, scratch, answers);
    sentences.clear();
    for (std::size_t i = 0; i < answers.states.size(); ++i) {
      sentences.push_back(checker.sentenceOf(batch, answers, i));
    }
    return answers;
  }
  /// Returns the verdict for one position of the joint.
  Verdict verdictAt(double position, const StateRequest& request = {}, const StateCheckerOptions& options = {}) {
    return check({position}, request, options).states.at(0).verdict;
  }
  /// Checks edges between positions of the joint. Replaces `edge_answers` and `batch`.
  const EdgeAnswer& checkEdge(double from, double to, const EdgeRequest& request = {}) {
    snapshot = scene.commit(Time{2}, gaps);
    batch.positions = {from, to};
    const StateChecker checker(snapshot, Kinematics(model), "robot", narrowPhase());
    checker.checkEdges(batch, {{0, 1}}, request, scratch, edge_answers);
    edge_sentence = checker.sentenceOf(batch, edge_answers, 0);
    return edge_answers.edges[0];
  }
  Unknown reason() const { return answers.states.at(0).because; }
  const std::string& sentence() const { return sentences.at(0); }

  RobotModel model;
  Scene scene;
  std::vector<BodyId> links;
  std::vector<SourceGap> gaps;
  StateBatch batch;
  StateScratch scratch;
  StateAnswers answers;
  EdgeAnswers edge_answers;
  std::string edge_sentence;
  std::vector<std::string> sentences;
  std::shared_ptr<const Snapshot> snapshot;
};

}  // namespace test
}  // namespace hgrid
