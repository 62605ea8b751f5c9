// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "batch_measurement.h"

#include <hgrid_proximity/CheckStates.h>
#include <hgrid_proximity/QueryBatch.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <stdexcept>

#include "bench/measure/median.h"
#include "bench/states/state_scene.h"
#include "call.h"
#include "hgrid_proximity/adapters/srdf.h"
#include "hgrid_proximity/queries/query.h"
#include "running_node.h"
#include "test/support/robots.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kRate = 20.0;  // [Hz] of /tf and ticks; a high rate would only take processor time from the requests
constexpr std::size_t kStates = 1000, kBoxes = 1000, kSpheres = 10000, kBodies = 10000;
constexpr double kRadius = 0.1;  // [m] of the spheres

double msOf(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Answers all questions once and writes the verdicts.
using Answer = std::function<void(std::vector<std::uint8_t>&)>;

/// Lets service and library answer in turn. @throws std::runtime_error if their verdicts differ
BatchMeasurement race(const std::string& title, double duration, const Answer& service, const Answer& library) {
  BatchMeasurement result;
  result.title = title;
  std::vector<double> by_service, by_library, ratios;
  std::vector<std::uint8_t> verdicts, expected;
  for (double spent = 0.0; spent < 1e3 * duration || ratios.size() < 10;) {
    by_service.push_back(msOf([&] { service(verdicts); }));
    by_library.push_back(msOf([&] { library(expected); }));
    ratios.push_back(by_service.back() / by_library.back());
    spent += by_service.back() + by_library.back();
    if (verdicts != expected) throw std::runtime_error("the verdicts of the node and of the library differ: " + title);
  }
  result.questions = verdicts.size();
  result.hits =
      static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), static_cast<std::uint8_t>(Verdict::hit)));
  result.service_ms = medianOf(by_service);
  result.library_ms = medianOf(by_library);
  result.ratio = medianOf(ratios);
  return result;
}

template <class Service>
ros::ServiceClient clientOf(const RunningNode& node, const char* name) {
  return ros::NodeHandle().serviceClient<Service>(node.name() + "/" + name, true);
}

BatchMeasurement measureStates(double duration) {
  const std::vector<OrientedBox> boxes = randomBoxes(kBoxes);
  const Workload workload = pandaAmong(boxes, kRate);
  const test::RealRobot texts = test::realRobot("panda");
  MeshLoader loader(test::meshPolicy());
  StateRobot robot{"Panda", test::readWith(loader, texts.urdf), readSrdf(texts.srdf), {}};
  const Kinematics kinematics(robot.model);
  for (const JointVariable& variable : kinematics.variables()) robot.group.push_back(variable.name);
  StateScene scene(robot, StateWorld{boxes, {}, Pose::Identity()});
  Random random(5);
  scene.batch.positions = scene.randomStates(random, kStates);

  const RunningNode node(workload, duration);
  ros::ServiceClient client = clientOf<hgrid_proximity::CheckStates>(node, "check_states");
  hgrid_proximity::CheckStates question;
  question.request.robot = "panda";
  question.request.joint_names = scene.batch.joints;
  question.request.positions = scene.batch.positions;
  return race(
      "~check_states, " + workload.title, duration,
      [&](std::vector<std::uint8_t>& verdicts) {
        call(client, question);
        verdicts = question.response.verdicts;
      },
      [&](std::vector<std::uint8_t>& verdicts) {
        scene.checker->checkStates(scene.batch, {}, scene.scratch, scene.answers);
        verdicts.clear();
        for (const StateAnswer& state : scene.answers.states) {
          verdicts.push_back(static_cast<std::uint8_t>(state.verdict));
        }
      });
}

/// Returns a snapshot of the obstacles of a workload. They must be fixed boxes.
/// @param around  is extended by their centers
std::shared_ptr<const Snapshot> snapshotOf(const Workload& workload, Eigen::AlignedBox3d& around) {
  std::vector<OrientedBox> boxes;
  XmlRpc::XmlRpcValue obstacles = workload.params["obstacles"];
  for (int i = 0; i < obstacles.size(); ++i) {
    OrientedBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.size[axis] = static_cast<double>(obstacles[i]["shapes"][0]["size"][axis]);
      box.world_from_box.translation()[axis] = static_cast<double>(obstacles[i]["pose"]["xyz"][axis]);
    }
    around.extend(box.world_from_box.translation());
    boxes.push_back(box);
  }
  Scene scene{SceneOptions{}};
  addBoxes(scene, boxes, *makeCoreNarrowPhase());
  return scene.commit(Time{1}, {});
}

BatchMeasurement measureSpheres(double duration) {
  const Workload workload = freeBodies(kBodies, 0, kRate);
  Eigen::AlignedBox3d around;
  const std::shared_ptr<const Snapshot> snapshot = snapshotOf(workload, around);
  const RunningNode node(workload, duration);
  ros::ServiceClient client = clientOf<hgrid_proximity::QueryBatch>(node, "query_batch");
  hgrid_proximity::QueryBatch question;
  std::vector<Sphere> spheres;
  Random random(6);
  for (std::size_t i = 0; i < kSpheres; ++i) {
    Eigen::Vector3d at;
    for (int axis = 0; axis < 3; ++axis) at[axis] = random.uniform(around.min()[axis], around.max()[axis]);
    spheres.push_back({at, kRadius});
    geometry_msgs::Point center;
    center.x = at.x();
    center.y = at.y();
    center.z = at.z();
    question.request.sphere_center.push_back(center);
    question.request.sphere_radius.push_back(kRadius);
  }
  QueryScope scope;
  scope.limit = 1;
  return race(
      "~query_batch, spheres among " + std::to_string(kBodies) + " boxes", duration,
      [&](std::vector<std::uint8_t>& verdicts) {
        call(client, question);
        verdicts = question.response.verdicts;
      },
      [&](std::vector<std::uint8_t>& verdicts) {
        verdicts.clear();
        for (const Sphere& sphere : spheres) {
          verdicts.push_back(static_cast<std::uint8_t>(query(*snapshot, sphere, scope).verdict));
        }
      });
}

}  // namespace

std::vector<BatchMeasurement> measureBatches(double duration) {
  std::vector<BatchMeasurement> all;
  if (!test::sharedData().empty()) all.push_back(measureStates(duration));
  all.push_back(measureSpheres(duration));
  return all;
}

}  // namespace bench
}  // namespace hgrid
