// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/time/freshness.h"

#include <algorithm>

#include "node/time/kept_pose.h"

namespace hgrid {
namespace {

constexpr double kPeriods = 1.5;  // data are FRESH up to this many periods, even if the limits are shorter

Freshness judgeByAge(const KeptPose& pose, const PoseCircumstances& circumstances, const AgeLimits& limits) {
  if (pose.settled()) return Freshness::fresh;
  if (pose.frozen()) return Freshness::frozen;
  const Freshness by_age =
      std::max(circumstances.chain, freshnessOf(pose.age(circumstances.reading), circumstances.period, limits));
  return pose.stamp() < circumstances.tick_time ? std::max(by_age, Freshness::late) : by_age;
}

}  // namespace

Freshness freshnessOf(double age, double period, const AgeLimits& limits) {
  const double usual = kPeriods * period;
  if (age > std::max(limits.lost_after, usual)) return Freshness::lost;
  if (age > std::max(limits.stale_after, usual)) return Freshness::stale;
  return age > std::max(limits.late_after, usual) ? Freshness::late : Freshness::fresh;
}

Freshness judgePose(const KeptPose& pose, const PoseCircumstances& circumstances, const AgeLimits& limits) {
  const Freshness by_age = judgeByAge(pose, circumstances, limits);
  if (by_age == Freshness::frozen || circumstances.clock_frozen) return Freshness::frozen;
  return circumstances.refused ? Freshness::invalid : by_age;
}

Freshness judgeCloud(double age, double period, bool clock_frozen, const AgeLimits& limits) {
  if (clock_frozen) return Freshness::frozen;
  return age > limits.lost_after ? Freshness::lost : freshnessOf(age, period, limits);
}

}  // namespace hgrid
