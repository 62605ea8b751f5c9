// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Uses the core without ROS: a scene with two boxes and one robot link, a query, and a separate grid. The exit status
// is 0 if all answers are as expected.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/world/scene.h"

namespace {

using namespace hgrid;

void require(bool holds, const char* claim) {
  if (holds) return;
  std::printf("This must be true, but is not: %s\n", claim);
  std::exit(1);
}

Pose at(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, z;
  return pose;
}

Body body(const std::string& name, const Shape& shape, NarrowPhase& narrow_phase) {
  Body body;
  body.name = name;
  body.shapes.push_back({shape, Pose::Identity(), 0.0, "", Eigen::Vector3d::Ones(), narrow_phase.solidOf(shape)});
  return body;
}

void put(Scene& scene, const Body& body, const Pose& world_from_body) {
  const BodyId id = scene.add(body);
  scene.place(id, world_from_body, Time{1});
  scene.setState(id, Freshness::fresh, 0.0);
}

void useScene() {
  const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  Scene scene{SceneOptions{}};
  put(scene, body("obstacle/table", Shape::box({2.0, 2.0, 0.1}), *narrow_phase), at(0.0, 0.0, -0.05));
  put(scene, body("obstacle/crate", Shape::box({0.2, 0.2, 0.2}), *narrow_phase), at(0.62, 0.0, 0.35));
  Body link = body("robot/forearm", Shape::capsule(0.4, 0.05), *narrow_phase);
  link.kind = BodyKind::link;
  link.robot = "robot";
  put(scene, link, at(0.45, 0.0, 0.3));

  const std::shared_ptr<const Snapshot> snapshot = scene.commit(Time{1}, {});
  const BodyList& bodies = snapshot->structure().bodies;
  for (const NearPair& pair : snapshot->pairs()) {
    std::printf("%s and %s: gap %.3f m\n", bodies[pair.first].name.c_str(), bodies[pair.second].name.c_str(), pair.gap);
  }
  require(snapshot->pairs().size() == 2, "the forearm is near the crate and near the table");

  QueryScope scope;
  scope.exact = narrow_phase.get();
  const QueryAnswer answer = query(*snapshot, Sphere{{0.72, 0.0, 0.75}, 0.31}, scope);
  // The sphere also touches the box around the forearm, but not the forearm itself.
  require(answer.verdict == Verdict::hit && answer.hits.size() == 1, "the sphere touches one body");
  std::printf("the sphere touches %s\n", bodies[answer.hits[0].body].name.c_str());
}

void useGrid() {
  HGrid grid;
  grid.insert(0, {{0, 0, 0}, {1, 1, 1}});
  grid.insert(1, {{1, 0, 0}, {2, 1, 1}});
  grid.insert(2, {{5, 5, 5}, {6, 6, 6}});
  std::vector<ProxyPair> pairs;
  grid.overlappingPairs(pairs);
  require(pairs == std::vector<ProxyPair>{{0, 1}}, "two boxes of the grid touch");
  std::printf("boxes %u and %u of the grid touch\n", pairs[0].first, pairs[0].second);
}

}  // namespace

int main() {
  useScene();
  useGrid();
}
