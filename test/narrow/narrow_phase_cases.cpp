// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/narrow/narrow_phase_cases.h"

#include <cmath>
#include <utility>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace test {
namespace {

constexpr int kCasesPerShape = 8;

std::string textOf(const Shape& shape, const Pose& pose, double padding) {
  std::string result = name(shape.kind());
  for (const double measure : shape.dimensions()) result += " " + text(measure);
  if (shape.mesh()) {
    result += " of " + std::to_string(shape.mesh()->vertices.size()) + " vertices and " +
              std::to_string(shape.mesh()->triangles.size()) + " triangles";
  }
  result += ", padding " + text(padding) + ", rotation row by row";
  for (int i = 0; i < 9; ++i) result += " " + text(pose.linear()(i / 3, i % 3));
  result += ", position";
  for (int i = 0; i < 3; ++i) result += " " + text(pose.translation()[i]);
  return result;
}

bool sameBits(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool sameBits(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return sameBits(a.x(), b.x()) && sameBits(a.y(), b.y()) && sameBits(a.z(), b.z());
}

}  // namespace

NarrowPhase& narrowPhase() {
  static const std::shared_ptr<NarrowPhase> shared = makeCoreNarrowPhase();
  return *shared;
}

std::vector<ShapeKind> testedKinds() {
  std::vector<ShapeKind> kinds;
  for (int kind = 1; kind <= 7; ++kind) kinds.push_back(ShapeKind(kind));
  return kinds;
}

std::vector<KindPair> allKindPairs() {
  std::vector<KindPair> pairs;
  const std::vector<ShapeKind> kinds = testedKinds();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = i; j < kinds.size(); ++j) pairs.push_back({kinds[i], kinds[j]});
  }
  return pairs;
}

std::string nameOf(const KindPair& kinds) { return std::string(name(kinds.first)) + "_" + name(kinds.second); }

std::string Case::text() const {
  return textOf(first_shape, world_from_first, first_padding) + "; " +
         textOf(second_shape, world_from_second, second_padding);
}

Case Cases::next(double from_origin) {
  if (used_++ % kCasesPerShape == 0) {
    shapes_ = {randomSolid(random_, kinds_.first, proportions_), randomSolid(random_, kinds_.second, proportions_)};
  }
  const double reach = shapes_[0].reach() + shapes_[1].reach();
  const auto padding = [&] { return random_.chance(0.5) ? 0.0 : random_.logUniform(1e-4, 0.05); };
  Case placed{shapes_[0], shapes_[1], randomPose(random_, reach), randomPose(random_, reach), padding(), padding()};
  if (!random_.chance(0.15)) {  // the other 15 % keep their random poses; most of them overlap deeply
    const Eigen::Vector3d way = randomPose(random_, 1.0).linear().col(0);
    placed.world_from_second.translation() = placed.world_from_first.translation() + 1.5 * reach * way;
    bringTo(randomGap(), placed);
  }
  if (from_origin > 0.0) {
    const Eigen::Vector3d off = from_origin * randomPose(random_, 1.0).linear().col(0);
    placed.world_from_first.translation() += off;
    placed.world_from_second.translation() += off;
  }
  return placed;
}

double Cases::randomGap() {
  if (random_.chance(0.35)) return random_.logUniform(1e-9, 1e-3);
  if (random_.chance(0.25)) return -random_.logUniform(1e-7, 1e-1);
  return random_.logUniform(1e-3, 3.0);
}

void bringTo(double gap, Case& placed) {
  const SolidOracle first = placed.first(), second = placed.second();
  const SolidDistance apart = distanceOf(first, second);
  const Vector3r way = apart.on_second - apart.on_first;
  const Real length = way.norm();
  if (!(length > 1e-9L) || apart.enclosed) return;
  const Real step = gap + first.radius() + second.radius() - length;
  placed.world_from_second.translation() += (step / length * way).cast<double>();
}

Trial::Trial(const Case& placed)
    : placed_(placed),
      first_(narrowPhase().solidOf(placed.first_shape)),
      second_(narrowPhase().solidOf(placed.second_shape)) {}

Proximity Trial::measure(double up_to) const {
  return narrowPhase().measure({*first_, placed_.world_from_first, placed_.first_padding},
                               {*second_, placed_.world_from_second, placed_.second_padding}, up_to);
}

Contact Trial::contact() const {
  return narrowPhase().measureContact({*first_, placed_.world_from_first, placed_.first_padding},
                                      {*second_, placed_.world_from_second, placed_.second_padding});
}

Contact Trial::contactSwapped() const {
  return narrowPhase().measureContact({*second_, placed_.world_from_second, placed_.second_padding},
                                      {*first_, placed_.world_from_first, placed_.first_padding});
}

Proximity Trial::measureSwapped(double up_to) const {
  return narrowPhase().measure({*second_, placed_.world_from_second, placed_.second_padding},
                               {*first_, placed_.world_from_first, placed_.first_padding}, up_to);
}

Proximity swapped(Proximity answer) {
  std::swap(answer.on_first, answer.on_second);
  answer.normal = -answer.normal;
  return answer;
}

bool isSame(const Proximity& a, const Proximity& b) {
  return a.status == b.status && sameBits(a.distance, b.distance) && sameBits(a.on_first, b.on_first) &&
         sameBits(a.on_second, b.on_second) && sameBits(a.normal, b.normal) && sameBits(a.depth, b.depth);
}

bool isSameInOtherOrder(const Case& placed, const Proximity& answer, const Proximity& other) {
  const Shape &a = placed.first_shape, &b = placed.second_shape;
  const bool are_one = a.kind() == b.kind() && a.dimensions() == b.dimensions() && a.mesh() == b.mesh() &&
                       placed.first_padding == placed.second_padding &&
                       placed.world_from_first.matrix() == placed.world_from_second.matrix();
  if (are_one) return isSame(answer, other);
  return isSame(answer, swapped(other));
}

}  // namespace test
}  // namespace hgrid
