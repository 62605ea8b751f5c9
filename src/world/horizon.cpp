// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "world/horizon.h"

#include <algorithm>
#include <cmath>

namespace hgrid {
namespace {

constexpr Time kNever{-1};  // stamp of a body that had no pose

/// Returns the largest distance [m] by which a face of the box moved. A face of the box around a body never moves
/// farther than the fastest point of the body.
double shiftOf(const Aabb& before, const Aabb& now) {
  return std::max((now.min - before.min).cast<double>().cwiseAbs().maxCoeff(),
                  (now.max - before.max).cast<double>().cwiseAbs().maxCoeff());
}

/// Returns the largest error [m] that the rounding of boxes can add to shiftOf().
double roundingOf(const Aabb& box) {
  return 4e-7 * std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()) + 1e-9;
}

}  // namespace

double Horizon::reachOf(const Body& body, const BodyPose& pose) const {
  if (body.mobility == Mobility::fixed) return 0.0;
  if (!std::isfinite(body.max_speed)) return cap_;
  return body.max_speed * seconds_ + std::min(body.max_speed * pose.age, cap_);
}

void Horizon::step(const std::shared_ptr<const Structure>& structure, const std::vector<BodyPose>& poses,
                   const std::vector<Aabb>& boxes) {
  if (!on()) return;
  const std::size_t count = structure->bodies.size();
  const bool renumbered = structure != last_.structure;
  now_.structure = structure;
  now_.boxes = swept_ = boxes;
  now_.stamps.assign(count, kNever);
  teleported_.assign(count, false);
  was_placed_.assign(count, false);
  reach_.resize(count);
  for (std::uint32_t body = 0; body < count; ++body) {
    const BodyPose& pose = poses[body];
    reach_[body] = reachOf(structure->bodies[body], pose);
    if (pose.state == Freshness::unplaced) continue;
    now_.stamps[body] = pose.stamp;
    const Time before = renumbered ? kNever : last_.stamps[body];
    if (before == kNever) continue;
    was_placed_[body] = true;
    const double may = structure->bodies[body].max_speed * std::max(0.0, seconds(pose.stamp - before));
    for (ProxyId proxy = structure->first_proxy[body]; proxy < structure->first_proxy[body + 1]; ++proxy) {
      const Aabb &from = last_.boxes[proxy], &to = boxes[proxy];
      if (from == to) continue;
      swept_[proxy] = {from.min.cwiseMin(to.min), from.max.cwiseMax(to.max)};
      if (shiftOf(from, to) > may + roundingOf(to)) teleported_[body] = true;
    }
  }
}

void Horizon::accept() { std::swap(last_, now_); }

bool Horizon::canMeet(const Structure& structure, ProxyId first, ProxyId second, double gap, double margin) const {
  const double reach = reachOf(structure.body_of_proxy[first]) + reachOf(structure.body_of_proxy[second]);
  return gap <= reach || withinDistance(swept_[first], swept_[second], margin);
}

}  // namespace hgrid
