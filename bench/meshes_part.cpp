// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bench/measure/turns.h"
#include "bench/meshes/mesh_peer.h"
#include "bench/meshes/mesh_set.h"
#include "bench/parts.h"
#include "narrow/winding_tree.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTurn = 0.01, kStep = 0.002;  // [rad], [m] motion of the second mesh in each step
constexpr int kWalks = 8, kSteps = 10;

Eigen::Vector3d randomVector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

double reachOf(const TriangleMesh& mesh) {
  double reach = 0.0;
  for (const Eigen::Vector3d& vertex : mesh.vertices) reach = std::max(reach, vertex.norm());
  return reach;
}

/// Moves the second mesh toward the first until their distance is `gap` [m].
Pose poseAt(double gap, const MeshPeer& meshes, double reach, Random& random) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(random.uniform(0, M_PI), randomVector(random).normalized()).toRotationMatrix();
  const Eigen::Vector3d direction = randomVector(random).normalized();
  double low = 0.0, high = reach + gap;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    pose.translation() = middle * direction;
    (meshes.distance(pose, kInfinity) < gap ? low : high) = middle;
  }
  pose.translation() = high * direction;
  return pose;
}

/// Returns the shortest of three durations of a call [us].
template <class Call>
double shortestOf(const Call& call) {
  double least = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const Clock::time_point begin = Clock::now();
    call();
    least = std::min(least, 1e3 * msSince(begin));
  }
  return least;
}

/// Sums of the times of one library over all poses [us], without a limit and with the limit that a PairMeter knows.
struct Times {
  double free = 0.0, limited = 0.0;
};

/// The poses of one pair of meshes at one distance, and what was measured there.
struct Walk {
  void add(const MeshPeer* meshes, const Pose& pose, double limit, Times& times, double& distance) const {
    if (!meshes) return;
    times.free += shortestOf([&] { distance = meshes->distance(pose, kInfinity); });
    if (limit < kInfinity) times.limited += shortestOf([&] { meshes->distance(pose, limit); });
  }

  /// Measures a mesh that moves in small steps. Each library measures each pose, in turn.
  void go(const MeshPeer& hgrid, const MeshPeer* fcl, Pose pose, double reach, Random& random) {
    double limit = kInfinity;
    for (int step = 0; step < kSteps; ++step) {
      double ours = 0.0, theirs = 0.0;
      add(&hgrid, pose, limit, hgrid_times, ours);
      add(fcl, pose, limit, fcl_times, theirs);
      if (fcl) difference = std::max(difference, std::abs(ours - theirs) / (1.0 + theirs));
      const Eigen::Vector3d way = kStep * randomVector(random);
      const Eigen::AngleAxisd turn(kTurn, randomVector(random).normalized());
      pose.linear() = Eigen::Quaterniond(turn * Eigen::Quaterniond(pose.linear())).normalized().toRotationMatrix();
      pose.translation() += way;
      limit = ours + way.norm() + kTurn * reach + 1e-6;
    }
  }

  Times hgrid_times, fcl_times;
  double difference = 0.0;  // largest difference of the distances: |ours - theirs| / (1 m + theirs)
};

void play(const MeshPair& pair, double gap, std::vector<Record>& records) {
  const auto hgrid = makeHgridMeshes(pair.first.mesh, pair.second.mesh),
             fcl = makeFclMeshes(pair.first.mesh, pair.second.mesh);
  const double reach = reachOf(pair.second.mesh);
  Random random(11);
  Walk walk;
  for (int i = 0; i < kWalks; ++i) {
    walk.go(*hgrid, fcl.get(), poseAt(gap, *hgrid, reachOf(pair.first.mesh) + reach, random), reach, random);
  }
  const double all = kWalks * kSteps, limited = kWalks * (kSteps - 1);
  const bool correct = fcl && walk.difference <= 1e-9;
  Record record("mesh");
  record.text("first", pair.first.name).text("second", pair.second.name).number("gap", gap);
  record.number("hgrid_us", walk.hgrid_times.free / all).number("fcl_us", walk.fcl_times.free / all);
  record.number("hgrid_limited_us", walk.hgrid_times.limited / limited);
  record.number("fcl_limited_us", walk.fcl_times.limited / limited);
  records.push_back(record.number("difference", walk.difference).flag("correct", correct).flag("fcl", fcl != nullptr));
  std::printf(
      "  %-14s %-14s %5.3f m   hgrid %7.1f us  FCL %7.1f us  %5.1f times   with a limit: %7.1f us  %7.1f us  "
      "%5.1f times   %s\n",
      pair.first.name.c_str(), pair.second.name.c_str(), gap, walk.hgrid_times.free / all, walk.fcl_times.free / all,
      walk.fcl_times.free / walk.hgrid_times.free, walk.hgrid_times.limited / limited, walk.fcl_times.limited / limited,
      walk.fcl_times.limited / walk.hgrid_times.limited,
      !fcl      ? "not compared: FCL was not found"
      : correct ? ""
                : "WRONG");
  std::fflush(stdout);
}

/// Measures how long it takes to decide whether a point is inside a closed mesh.
void playInside(std::size_t triangles, std::vector<Record>& records) {
  const TriangleMesh mesh = sphereOf(triangles);
  const WindingTree tree(mesh.vertices, mesh.triangles);
  Random random(12);
  double sum = 0.0;
  constexpr int kPoints = 200;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d point = 0.5 * randomVector(random);
    sum += shortestOf([&] { tree.windingNumber(point); });
  }
  records.push_back(Record("inside").number("triangles", double(mesh.triangles.size())).number("us", sum / kPoints));
  std::printf("  winding number in a sphere of %zu triangles: %.1f us\n", mesh.triangles.size(), sum / kPoints);
}

}  // namespace

void runMeshes(const Options& options, std::vector<Record>& records) {
  std::printf("\nmeshes: mean time per distance\n");
  std::vector<MeshPair> pairs = robotPairs();
  if (pairs.empty()) std::printf("  without robots: no example-robot-data in HGRID_TEST_DATA or ../shared/data\n");
  for (const MeshPair& pair : generatedPairs()) pairs.push_back(pair);
  for (const MeshPair& pair : pairs) {
    for (const double gap : {0.005, 0.05, 0.5}) play(pair, gap, records);
  }
  playInside(20000, records);
  if (!options.quick) playInside(1000000, records);
}

}  // namespace bench
}  // namespace hgrid
