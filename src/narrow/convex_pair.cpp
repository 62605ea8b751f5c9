// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/convex_pair.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/infinity.h"
#include "narrow/overlap.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

// [m] Up to this length, the middle between two nearest points counts as a point of both solids.
constexpr double kSamePoint = 1e-6;

const ConvexSolid& convex(const Side& side) { return static_cast<const ConvexSolid&>(side.solid); }

}  // namespace

Pose relativePose(const Side& a, const Side& b) {
  const auto back = a.world_from_shape.linear().transpose();
  Pose a_from_b = Pose::Identity();
  a_from_b.linear() = back * b.world_from_shape.linear();
  a_from_b.translation() = back * (b.world_from_shape.translation() - a.world_from_shape.translation());
  return a_from_b;
}

Proximity answerOf(Measure status, double distance) {
  Proximity result;
  result.status = status;
  result.distance = result.lower_bound = distance;
  return result;
}

bool hasContacts(Measure status) {
  if (status == Measure::failed) {
    throw std::runtime_error("the contacts are not known, because the distance of two shapes could not be computed");
  }
  return isContact(status);
}

std::optional<Proximity> answerByReach(const Side& a, const Side& b, const Pose& a_from_b, double up_to) {
  const double around = a.around + b.around;
  if (!a_from_b.matrix().allFinite() || !(around >= 0.0)) return answerOf(Measure::failed, 0.0);
  const double way = a_from_b.translation().norm(), reach = a.solid.reach() + b.solid.reach() + around;
  if (way - reach - gapRounding(way + reach) > up_to) {
    return answerOf(Measure::apart, kInfinity);
  }
  return std::nullopt;
}

GapLimits limitsOf(const Side& a, const Side& b, double up_to) {
  const double around = a.around + b.around;
  return {around, std::max(0.0, up_to) + around + kTouchingGap};
}

Proximity answerByGap(const Side& a, const Side& b, const Pose& a_from_b, const CoreGap& gap, double up_to) {
  const double around = a.around + b.around;
  if (gap.lower > up_to + around) return answerOf(Measure::apart, kInfinity);
  const Vector between = gap.on_second - gap.on_first;
  const double size = a.solid.reach() + b.solid.reach() + a_from_b.translation().norm();
  if (!(std::abs(between.norm() - gap.upper) <= gapRounding(size))) return answerOf(Measure::failed, 0.0);
  Proximity result;
  if (gap.lower > around) {
    result.status = Measure::apart;
    result.distance = gap.upper - around;
    result.lower_bound = gap.lower - around;
    if (result.distance > up_to) {  // by less than the error of the measurement
      result.distance = kInfinity;
      return result;
    }
  } else {
    result = answerOf(Measure::contact, 0.0);
  }
  if (gap.normal.isZero()) return result;  // not known
  result.normal = result.status == Measure::contact ? gap.apart_along : gap.normal;
  result.on_first = gap.on_first + a.around * result.normal;
  result.on_second = gap.on_second - b.around * result.normal;
  return result;
}

Contact contactByGap(const Side& a, const Side& b, const CoreGap& gap) {
  const double around = a.around + b.around;
  const Vector between = gap.on_second - gap.on_first;
  Contact contact;
  // Otherwise, the search could not prove that they are apart, or it found nothing.
  if (gap.upper <= around + kSamePoint) {
    contact.point = gap.on_first + (around > 0.0 ? a.around / around : 0.5) * between;
  }
  if (gap.lower > 0.0) {
    contact.normal = gap.apart_along;
    contact.depth = std::max(0.0, around - gap.lower);
  }
  return contact;
}

Proximity measureConvex(const Side& a, const Side& b, double up_to) {
  const Pose a_from_b = relativePose(a, b);
  if (const auto answer = answerByReach(a, b, a_from_b, up_to)) return *answer;
  const CoreGap gap = gapOf(convex(a).core(), convex(b).core(), a_from_b, limitsOf(a, b, up_to));
  if (std::isnan(gap.lower) || std::isnan(gap.upper)) return answerOf(Measure::failed, 0.0);
  if (gap.lower <= 0.0) return answerOf(Measure::contact, 0.0);
  Proximity result = answerByGap(a, b, a_from_b, gap, up_to);
  if (result.status == Measure::contact && !result.normal.hasNaN()) {
    result.depth = std::max(0.0, a.around + b.around - gap.lower);
  }
  return result;
}

Contact contactOfConvex(const Side& a, const Side& b) {
  const Pose a_from_b = relativePose(a, b);
  const CoreGap gap = gapOf(convex(a).core(), convex(b).core(), a_from_b, {0.0, limitsOf(a, b, 0.0).enough});
  Contact contact = contactByGap(a, b, gap);
  if (gap.lower > 0.0) {
    contact.depth_at_least = std::max(0.0, a.around + b.around - gap.upper);
    return contact;
  }
  const Overlap overlap = overlapOf(convex(a).core(), convex(b).core(), a_from_b);
  contact.normal = overlap.normal;
  contact.depth = overlap.depth + a.around + b.around;
  contact.depth_at_least = overlap.at_least + a.around + b.around;
  return contact;
}

std::vector<Contact> contactsOfConvex(const Side& a, const Side& b, std::size_t most) {
  const Measure status = most > 0 ? measureConvex(a, b, 0.0).status : Measure::not_measured;
  if (!hasContacts(status)) return {};
  return {contactOfConvex(a, b)};
}

}  // namespace hgrid
