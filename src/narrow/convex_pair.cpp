// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/convex_pair.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/infinity.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

// [m] Largest accepted difference between the gap and the distance of the two nearest points, besides rounding.
constexpr double kDisagreement = 1e-6;
// Bounds of a gap count as equal if they differ by at most 1e-6 m, the promised precision of distances, plus this part
// of the size of the solids and of their distance. Among shapes of kilometers, searches end before their bounds are
// equal.
constexpr double kUnsettled = 1e-7;

const ConvexSolid& convex(const Side& side) { return static_cast<const ConvexSolid&>(side.solid); }

/// Returns the gap of two cores; it is infinite if it is larger than `up_to` [m].
CoreGap gapOfCores(const Side& a, const Side& b, const Pose& a_from_b, double up_to) {
  CoreGap gap = gapOf(convex(a).core(), convex(b).core(), a_from_b, up_to);
  if (gap.lower > up_to) gap.lower = gap.upper = kInfinity;
  return gap;
}

/// Returns an overlap of depth 0 if the cores only touch. It moves them apart by kHair and then takes their nearest
/// points.
std::optional<Overlap> touchOf(const ConvexSolid& a, const ConvexSolid& b, const Pose& a_from_b) {
  const double distance = a_from_b.translation().norm();
  if (!(distance > 0.0)) return std::nullopt;
  Pose apart = a_from_b;
  apart.translation() += kHair / distance * a_from_b.translation();
  const CoreGap gap = gapOf(a.core(), b.core(), apart, kHair);
  if (!(gap.lower > 0.0)) return std::nullopt;
  const Vector between = gap.on_second - gap.on_first;
  return Overlap{0.0, between.normalized(), gap.on_first + 0.5 * between};
}

/// Sets depth, normal and points of `result` for two cores that meet. Sets nothing if moving the solids apart by this
/// depth does not separate them.
void describeContact(const Side& a, const Side& b, const Pose& a_from_b, FindOverlap findOverlap, Proximity& result) {
  if (!convex(a).isShape() || !convex(b).isShape()) return;
  const double around = a.around + b.around;
  for (const FindOverlap find : {findOverlap, FindOverlap{touchOf}}) {
    const std::optional<Overlap> overlap = find(convex(a), convex(b), a_from_b);
    if (!overlap) continue;
    const double depth = overlap->depth;
    const Vector& normal = overlap->normal;
    Pose apart = a_from_b;
    apart.translation() += (depth + around + kHair) * normal;
    if (!(gapOf(convex(a).core(), convex(b).core(), apart, around).lower > around)) continue;
    result.normal = normal;
    result.depth = depth + around;
    result.on_first = overlap->point + (0.5 * depth + a.around) * normal;
    result.on_second = overlap->point - (0.5 * depth + b.around) * normal;
    return;
  }
}

}  // namespace

Proximity answerOf(Measure status, double distance) {
  Proximity result;
  result.status = status;
  result.distance = distance;
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
  if (a_from_b.translation().norm() - (a.solid.reach() + b.solid.reach()) - around > up_to) {
    return answerOf(Measure::apart, kInfinity);
  }
  return std::nullopt;
}

Proximity answerByGap(const Side& a, const Side& b, const Pose& a_from_b, const CoreGap& gap, double up_to) {
  const double around = a.around + b.around;
  const double size = a.solid.reach() + b.solid.reach() + a_from_b.translation().norm(), rounding = 1e-12 * size;
  // If the search ended before the two bounds were equal, only the lower bound is certain.
  const double proved = gap.upper - gap.lower > kDisagreement + kUnsettled * size ? gap.lower : gap.upper;
  Proximity result = answerOf(Measure::apart, std::max(0.0, proved - around));
  if (result.distance > up_to) return answerOf(Measure::apart, kInfinity);
  const Vector between = gap.on_second - gap.on_first;
  const double length = between.norm();
  if (!(std::abs(length - gap.upper) <= kDisagreement + rounding)) return answerOf(Measure::failed, 0.0);
  if (!(std::min(gap.lower, gap.upper) > around)) {  // rounding can make lower greater than upper
    result.status = Measure::contact;
    result.distance = 0.0;
  }
  if (length > 0.0) {
    result.normal = between / length;
    result.on_first = gap.on_first + a.around * result.normal;
    result.on_second = gap.on_second - b.around * result.normal;
  }
  return result;
}

Contact contactByGap(const Side& a, const Side& b, const CoreGap& gap) {
  const double around = a.around + b.around;
  const Vector between = gap.on_second - gap.on_first;
  const double length = between.norm();
  Contact contact;
  // Otherwise, the search could not prove that they are apart, or it found nothing.
  if (length <= around + kDisagreement && gap.upper < kInfinity) {
    contact.point = gap.on_first + (around > 0.0 ? a.around / around : 0.5) * between;
  }
  if (gap.lower > 0.0) {
    contact.normal = between / length;
    contact.depth = std::max(0.0, around - gap.upper);
  }
  return contact;
}

Proximity measureConvex(const Side& a, const Side& b, double up_to, FindOverlap findOverlap) {
  const Pose a_from_b = a.world_from_shape.inverse() * b.world_from_shape;
  if (const auto answer = answerByReach(a, b, a_from_b, up_to)) return *answer;
  const double around = a.around + b.around;
  const CoreGap gap = gapOfCores(a, b, a_from_b, std::max(0.0, up_to) + around + kTouchingGap);
  if (std::isnan(gap.lower) || std::isnan(gap.upper)) return answerOf(Measure::failed, 0.0);
  if (gap.lower <= 0.0) {
    Proximity result = answerOf(Measure::contact, 0.0);
    describeContact(a, b, a_from_b, findOverlap, result);
    return result;
  }
  Proximity result = answerByGap(a, b, a_from_b, gap, up_to);
  if (result.status == Measure::contact) result.depth = std::max(0.0, around - gap.upper);
  return result;
}

Contact contactOfConvex(const Side& a, const Side& b, FindOverlap findOverlap) {
  const Pose a_from_b = a.world_from_shape.inverse() * b.world_from_shape;
  const CoreGap gap = gapOf(convex(a).core(), convex(b).core(), a_from_b, a.around + b.around + kTouchingGap);
  Contact contact = contactByGap(a, b, gap);
  if (gap.lower <= 0.0) {
    Proximity described;
    describeContact(a, b, a_from_b, findOverlap, described);
    contact.normal = described.normal;
    contact.depth = described.depth;
  }
  return contact;
}

std::vector<Contact> contactsOfConvex(const Side& a, const Side& b, std::size_t most, FindOverlap findOverlap) {
  const Measure status = most > 0 ? measureConvex(a, b, 0.0, findOverlap).status : Measure::not_measured;
  if (!hasContacts(status)) return {};
  return {contactOfConvex(a, b, findOverlap)};
}

}  // namespace hgrid
