// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/workload/world.h"

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace hgrid {
namespace bench {
namespace {

using Eigen::Vector3f;

constexpr double kSmallest = 0.01, kLargest = 10.0;  // [m] edges of the mixed workload

/// Expectation of s^power for s log-uniform over kSmallest .. kLargest.
double logUniformMoment(int power) {
  return (std::pow(kLargest, power) - std::pow(kSmallest, power)) / (power * std::log(kLargest / kSmallest));
}

double sideOf(const std::string& workload, double n) {
  if (workload == "uniform") return std::cbrt(4.0 * n);
  if (workload == "floor") return std::sqrt(2.0 * n);
  if (workload == "robots") return 1.5 * std::sqrt(n / 30.0);
  if (workload != "mixed") throw std::invalid_argument("there is no workload " + workload);
  return std::cbrt(n * (2.0 * logUniformMoment(3) + 6.0 * logUniformMoment(1) * logUniformMoment(2)) / 2.0);
}

Vector3f randomPoint(Random& random, const Region& region) {
  Vector3f point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = static_cast<float>(random.uniform(double(region.low[axis]), double(region.high[axis])));
  return point;
}

}  // namespace

const std::vector<std::string>& workloads() {
  static const std::vector<std::string> names{"uniform", "mixed", "floor", "robots"};
  return names;
}

World::World(const std::string& workload, std::size_t n, double moving)
    : n_(n), side_(sideOf(workload, double(n))), regions_(new Region[2]) {
  workload == "robots" ? makeRobots() : makeCubes(workload);
  chooseMoving(moving);
  first_walkers_ = walkers_;
  first_bases_ = bases_;
  boxes_.resize(n);
  moved_boxes_.reserve(moved_.size());
  reset();
}

void World::makeCubes(const std::string& workload) {
  const auto side = static_cast<float>(side_);
  const bool floor = workload == "floor", mixed = workload == "mixed";
  regions_[0] = {Vector3f::Zero(), Vector3f(side, side, floor ? 0.1f : side)};
  regions_[1] = {Vector3f::Zero(), Vector3f(side, side, 20.f)};
  Random random(1);
  for (std::size_t i = 0; i < n_; ++i) {
    const Region& region = regions_[floor && random.below(10) == 0 ? 1 : 0];
    const double edge =
        mixed ? std::exp(random.uniform(std::log(kSmallest), std::log(kLargest))) : random.uniform(0.8, 1.2);
    half_.push_back(Vector3f::Constant(static_cast<float>(0.5 * edge)));
    walkers_.emplace_back(i, randomPoint(random, region), static_cast<float>(edge), region);
  }
}

void World::makeRobots() {
  const auto side = static_cast<float>(side_);
  regions_[0] = {Vector3f::Zero(), Vector3f(side, side, 0.f)};
  regions_[1] = {Vector3f::Constant(-0.05f), Vector3f::Constant(0.05f)};  // how far a link sways
  Random random(1);
  Vector3f rest = Vector3f::Zero();
  for (std::size_t i = 0; i < n_; ++i) {
    if (i % kLinks == 0) {
      bases_.emplace_back(n_ + i, randomPoint(random, regions_[0]), 0.15f, regions_[0]);
      rest.setZero();
    } else {
      Vector3f direction;
      for (int axis = 0; axis < 3; ++axis) direction[axis] = static_cast<float>(random.uniform(-1.0, 1.0));
      direction.z() += 0.5f;  // upward
      rest += static_cast<float>(random.uniform(0.10, 0.14)) * direction.normalized();
    }
    rest_.push_back(rest);
    Vector3f half;
    for (int axis = 0; axis < 3; ++axis) half[axis] = static_cast<float>(random.uniform(0.05, 0.10));
    half_.push_back(half);
    walkers_.emplace_back(i, Vector3f::Zero(), 0.15f, regions_[1]);
  }
}

void World::chooseMoving(double fraction) {
  const std::size_t group = bases_.empty() ? 1 : kLinks, groups = (n_ + group - 1) / group;
  std::vector<ProxyId> order(groups);
  std::iota(order.begin(), order.end(), 0);
  Random random(2);
  for (std::size_t i = 0; i < groups; ++i) std::swap(order[i], order[i + random.below(groups - i)]);
  order.resize(std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(fraction * double(groups)))));
  std::sort(order.begin(), order.end());
  for (const ProxyId number : order) {
    for (std::size_t i = number * group; i < std::min(n_, (number + 1) * group); ++i)
      moved_.push_back(static_cast<ProxyId>(i));
  }
  if (!bases_.empty()) moved_bases_ = order;
}

void World::place(std::size_t i) {
  Vector3f center = walkers_[i].at();
  if (!bases_.empty()) center += bases_[i / kLinks].at() + rest_[i];
  boxes_[i].min = center - half_[i];
  boxes_[i].max = center + half_[i];
}

void World::reset() {
  frame_ = 0;
  walkers_ = first_walkers_;
  bases_ = first_bases_;
  for (std::size_t i = 0; i < n_; ++i) place(i);
}

void World::step() {
  ++frame_;
  for (const ProxyId number : moved_bases_) bases_[number].walk(frame_);
  moved_boxes_.clear();
  for (const ProxyId id : moved_) {
    walkers_[id].walk(frame_);
    place(id);
    moved_boxes_.push_back(boxes_[id]);
  }
}

}  // namespace bench
}  // namespace hgrid
