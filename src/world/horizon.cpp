// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "world/horizon.h"

#include <algorithm>
#include <cmath>

#include "geometry/rounding.h"

namespace hgrid {
namespace {

constexpr Time kNever{-1};  // stamp of a body that had no pose

/// Returns the largest distance [m] by which a face of the box moved. A face of the box around a body never moves
/// farther than the fastest point of the body.
double shiftOf(const Aabb& before, const Aabb& now) {
  return std::max((now.min - before.min).cast<double>().cwiseAbs().maxCoeff(),
                  (now.max - before.max).cast<double>().cwiseAbs().maxCoeff());
}

/// Returns a box that contains a box at each time while it went from `from` to `to`, if no face went a way longer than
/// `way` [m]. A face that goes from a to b on such a way is never beyond (a + b + way) / 2.
Aabb sweptBox(const Aabb& from, const Aabb& to, double way) {
  Aabb swept;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = 0.5 * (double(from.min[axis]) + double(to.min[axis]) - way);
    const double high = 0.5 * (double(from.max[axis]) + double(to.max[axis]) + way);
    swept.min[axis] = std::min({from.min[axis], to.min[axis], roundedDown(low)});
    swept.max[axis] = std::max({from.max[axis], to.max[axis], roundedUp(high)});
  }
  return swept;
}

/// Returns the largest error [m] that the rounding of boxes and times can add to shiftOf().
double roundingOf(const Aabb& box) {
  constexpr double kOfTime = 1e-9;  // [m] that a body goes at 1 m/s in a nanosecond, to which times are rounded
  return kFloatRounding * static_cast<double>(std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff())) +
         kOfTime;
}

}  // namespace

double Horizon::reachOf(const Body& body, const BodyPose& pose, double drift) const {
  if (body.mobility == Mobility::fixed) return 0.0;
  if (!std::isfinite(body.max_speed)) return cap_;
  return body.max_speed * seconds_ + std::max(drift, std::min(body.max_speed * pose.age, cap_));
}

double Horizon::driftOf(const Body& body, const BodyPose& pose, Time stamp) const {
  if (body.mobility == Mobility::fixed || pose.stamp >= stamp) return 0.0;
  return std::min(body.max_speed * seconds(stamp - pose.stamp), cap_);
}

/// Finds the index that each body had in the last accepted tick. Bodies keep their handles when other bodies come and
/// go, but not their indices.
void Horizon::matchBodies(const Structure& structure) {
  last_body_.assign(structure.ids.size(), Structure::kNone);
  if (!last_.structure) return;
  const std::vector<BodyId>& old = last_.structure->ids;
  std::uint32_t slots = 0;
  for (const BodyId id : old) slots = std::max(slots, id.slot + 1);
  last_slots_.assign(slots, Structure::kNone);
  for (std::uint32_t body = 0; body < old.size(); ++body) last_slots_[old[body].slot] = body;
  for (std::size_t body = 0; body < structure.ids.size(); ++body) {
    const BodyId id = structure.ids[body];
    const std::uint32_t known = id.slot < slots ? last_slots_[id.slot] : Structure::kNone;
    if (known != Structure::kNone && old[known].generation == id.generation) last_body_[body] = known;
  }
}

/// Sets the swept boxes of a body, and whether it teleported.
void Horizon::sweep(const Structure& structure, std::uint32_t body, const BodyPose& pose) {
  const std::uint32_t known = last_body_[body];
  if (known == Structure::kNone || last_.stamps[known] == kNever) return;
  const Body& what = structure.bodies[body];
  const double time = std::max(0.0, seconds(pose.stamp - last_.stamps[known]));
  const double may = what.max_speed * time;
  if (what.mobility != Mobility::fixed && time > 0.0) way_[body] = std::min(may, cap_);
  const ProxyId first = structure.first_proxy[body], last_first = last_.structure->first_proxy[known];
  for (ProxyId proxy = first; proxy < structure.first_proxy[body + 1]; ++proxy) {
    const Aabb &from = last_.boxes[last_first + (proxy - first)], &to = now_.boxes[proxy];
    if (from == to && way_[body] == 0.0) continue;
    before_[proxy] = from;
    swept_[proxy] = sweptBox(from, to, way_[body]);
    if (shiftOf(from, to) > may + roundingOf(to)) teleported_[body] = true;
  }
}

void Horizon::step(const std::shared_ptr<const Structure>& structure, const std::vector<BodyPose>& poses,
                   const std::vector<Aabb>& boxes, Time stamp) {
  if (!on()) return;
  const std::size_t count = structure->bodies.size();
  if (now_.structure != structure || last_.structure != structure || last_body_.size() != count)
    matchBodies(*structure);
  now_.structure = structure;
  now_.boxes = before_ = swept_ = boxes;
  now_.stamps.assign(count, kNever);
  teleported_.assign(count, false);
  reach_.resize(count);
  drift_.resize(count);
  way_.assign(count, 0.0);
  for (std::uint32_t body = 0; body < count; ++body) {
    const BodyPose& pose = poses[body];
    drift_[body] = driftOf(structure->bodies[body], pose, stamp);
    reach_[body] = reachOf(structure->bodies[body], pose, drift_[body]);
    if (pose.state == Freshness::unplaced) continue;
    now_.stamps[body] = pose.stamp;
    sweep(*structure, body, pose);
  }
}

void Horizon::accept() { std::swap(last_, now_); }

bool Horizon::canMeet(const Structure& structure, ProxyId first, ProxyId second, double gap, double margin) const {
  const std::uint32_t a = structure.body_of_proxy[first], b = structure.body_of_proxy[second];
  return gap <= reach_[a] + reach_[b] || withinDistance(swept_[first], swept_[second], margin + drift_[a] + drift_[b]);
}

}  // namespace hgrid
