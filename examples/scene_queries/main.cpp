// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Uses the library without ROS. Reads a robot from a URDF, places it beside a table, lists the near pairs with their
// exact distances, and asks which bodies a sphere touches.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/world/scene.h"

namespace {

constexpr char kUsage[] =
    "usage: scene_queries [-h] FILE.urdf\n\n"
    "Places a robot beside a table, lists the near pairs with their distances, and asks what a sphere touches.\n";

/// Adds a body whose pose is known.
void put(hgrid::Scene& scene, hgrid::NarrowPhase& narrow, hgrid::Body body, const hgrid::Pose& world_from_body) {
  for (hgrid::BodyShape& shape : body.shapes) shape.solid = narrow.solidOf(shape.shape);  // needed for exact distances
  scene.place(scene.add(std::move(body)), world_from_body, hgrid::Time{1});
}

/// Adds each link that has collision shapes. All joints have the same angle [rad].
void putRobot(hgrid::Scene& scene, hgrid::NarrowPhase& narrow, const hgrid::RobotModel& model, double angle) {
  std::vector<std::string> warnings;
  const auto matrix = std::make_shared<const hgrid::LinkMatrix>(model, hgrid::LinkRules{}, warnings);
  std::vector<hgrid::Pose> world_from_links;  // parents come before their children
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    const hgrid::RobotLink& link = model.links[i];
    hgrid::Pose pose = link.parent < 0 ? hgrid::Pose::Identity() : world_from_links[link.parent];
    pose = pose * link.parent_from_joint;
    if (link.joint_kind == hgrid::JointKind::revolute) pose.rotate(Eigen::AngleAxisd(angle, link.axis));
    world_from_links.push_back(pose);

    // The matrix allows pairs of adjacent links. If a shape could not be read, queries never answer CLEAR.
    if (link.hasGeometry()) put(scene, narrow, hgrid::linkBody(model, i, "robot", matrix), pose);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "--help" || word == "-h") return std::fputs(kUsage, stdout), 0;
  std::ifstream file(argc == 2 ? word : "");
  const std::string urdf(std::istreambuf_iterator<char>(file), {});
  if (urdf.empty()) return std::fputs("scene_queries needs the path of a URDF file; see --help\n", stderr), 2;
  const std::shared_ptr<hgrid::NarrowPhase> narrow = hgrid::makeCoreNarrowPhase();
  hgrid::Scene scene{hgrid::SceneOptions{}};
  putRobot(scene, *narrow, hgrid::readUrdf(urdf, {}), 0.7);  // {}: no mesh loader, because this robot has no mesh files
  hgrid::Body table;
  table.name = "obstacle/table";
  table.shapes.push_back(
      {hgrid::Shape::box({2.0, 2.0, 0.1}), hgrid::Pose::Identity(), 0.0, "", Eigen::Vector3d::Ones(), nullptr});
  put(scene, *narrow, table, hgrid::Pose(Eigen::Translation3d(0.0, 0.0, -0.1)));

  const std::shared_ptr<const hgrid::Snapshot> snapshot = scene.commit(hgrid::Time{1}, {});
  const hgrid::BodyList& bodies = snapshot->structure().bodies;
  const std::shared_ptr<const hgrid::PairDistances> distances = hgrid::PairMeter(narrow, {}).measure(*snapshot);
  for (const hgrid::PairDistance& pair : distances->pairs) {
    std::printf("%s and %s: gap %.3f m, distance %.3f m\n", bodies[pair.first].name.c_str(),
                bodies[pair.second].name.c_str(), pair.gap, pair.proximity.distance);
  }

  hgrid::QueryScope scope;
  scope.exact = narrow.get();
  const hgrid::QueryAnswer answer = query(*snapshot, hgrid::Sphere{{0.5, 0.3, 0.6}, 0.2}, scope);
  for (const hgrid::QueryHit& hit : answer.hits) std::printf("the sphere touches %s\n", bodies[hit.body].name.c_str());
  if (answer.verdict == hgrid::Verdict::clear) std::printf("the sphere touches nothing\n");
  if (answer.verdict == hgrid::Verdict::unknown) std::printf("unknown: %s\n", answer.reason.c_str());
}
