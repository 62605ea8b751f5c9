// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "simulated_world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/query.h"
#include "test/node/support/settings.h"
#include "test/node/support/transform_views.h"
#include "test/support/bodies.h"

namespace hgrid {
namespace test {
namespace {

Time atStart(double time) { return Time(std::llround(1e9 * (SimulatedWorld::kStart + time))); }

Params withFrames(Params params, const std::vector<std::string>& frames) {
  params.world_frame = "base";
  for (const std::string& frame : frames) {
    ObstacleParams obstacle;
    obstacle.body.name = "obstacle/" + frame;
    obstacle.body.frame = frame;
    obstacle.body.shapes.push_back(shapeOf(Shape::sphere(0.1)));
    params.obstacles.push_back(obstacle);
  }
  return params;
}

std::shared_ptr<NarrowPhase> narrowPhase() {
  static const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  return narrow_phase;
}

}  // namespace

SimulatedWorld::SimulatedWorld(const std::vector<std::string>& frames, Clock clock, Params params)
    : SimulatedWorld(frames, clock, std::move(params), own_ledger_) {}

SimulatedWorld::SimulatedWorld(const std::vector<std::string>& frames, Clock clock, Params params, Ledger& ledger)
    : params_(withFrames(std::move(params), frames)),
      ledger_(ledger),
      world_(std::make_unique<World>(settingsOf(params_), clock == Clock::simulated, 1, ledger_, narrowPhase())) {}

void SimulatedWorld::wait(double duration) {
  now_ += duration;
  steady_ += duration;
}

Moment SimulatedWorld::moment() const {
  Moment moment;
  moment.ros = atStart(now_);
  moment.steady =
      std::chrono::steady_clock::time_point(std::chrono::nanoseconds(std::llround(1e9 * (500.0 + steady_))));
  return moment;
}

geometry_msgs::TransformStamped SimulatedWorld::stamped(const std::string& parent, const std::string& child, double x,
                                                        double y, double stamp) const {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.header.stamp.fromNSec(static_cast<std::uint64_t>(atStart(stamp).count()));
  transform.child_frame_id = child;
  transform.transform.translation.x = x;
  transform.transform.translation.y = y;
  transform.transform.rotation.w = 1.0;
  return transform;
}

void SimulatedWorld::take(const geometry_msgs::TransformStamped& transform, bool is_static,
                          const std::string& publisher) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  world_->transforms().take(viewsOf(message), is_static, publisher, moment());
}

void SimulatedWorld::send(const std::string& publisher, const std::string& parent, const std::string& child, double x,
                          double stamp, double y) {
  take(stamped(parent, child, x, y, stamp), false, publisher);
}

void SimulatedWorld::fix(const std::string& publisher, const std::string& parent, const std::string& child, double x,
                         double stamp, double y) {
  take(stamped(parent, child, x, y, stamp), true, publisher);
}

const Tick& SimulatedWorld::tick() {
  tick_ = world_->tick(moment());
  return *tick_;
}

const BodyPose& SimulatedWorld::pose(const std::string& frame) const {
  const std::uint32_t body = snapshot().structure().find("obstacle/" + frame);
  if (body == Structure::kNone) throw std::runtime_error("no body follows frame " + frame);
  return snapshot().poses()[body];
}

double SimulatedWorld::stamp(const std::string& frame) const { return seconds(pose(frame).stamp - atStart(0.0)); }

double SimulatedWorld::tickTime() const { return seconds(snapshot().stamp() - atStart(0.0)); }

const BodyTrouble* SimulatedWorld::trouble(const std::string& frame) const {
  for (const BodyTrouble& trouble : tick_->troubles) {
    if (trouble.name == "obstacle/" + frame) return &trouble;
  }
  return nullptr;
}

bool SimulatedWorld::near(const std::string& first, const std::string& second) const {
  const Structure& structure = snapshot().structure();
  const std::uint32_t a = structure.find("obstacle/" + first), b = structure.find("obstacle/" + second);
  return std::any_of(snapshot().pairs().begin(), snapshot().pairs().end(), [&](const NearPair& pair) {
    return pair.first == std::min(a, b) && pair.second == std::max(a, b);
  });
}

Verdict SimulatedWorld::sphere(double x, double radius) const {
  return query(snapshot(), Sphere{Eigen::Vector3d(x, 0.0, 0.0), radius}, QueryScope{}).verdict;
}

std::uint64_t SimulatedWorld::counter(const std::string& name) const {
  const auto counters = ledger_.counters();
  const auto found = counters.find(name);
  return found == counters.end() ? 0 : found->second;
}

}  // namespace test
}  // namespace hgrid
