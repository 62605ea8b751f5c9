// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "test/support/shapes.h"
#include "test/support/solid_oracle.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {

struct KindPair {
  ShapeKind first, second;
};
/// Returns the shape kinds that are tested: all seven, without the plane.
std::vector<ShapeKind> testedKinds();
/// Returns all pairs of testedKinds(), also of a kind with itself: 28 pairs for seven kinds.
std::vector<KindPair> allKindPairs();
/// Returns a name for tests, for example "box_mesh".
std::string nameOf(const KindPair& kinds);

/// A test case: two shapes, their poses in the world frame, and their paddings [m].
struct Case {
  Shape first_shape, second_shape;
  Pose world_from_first, world_from_second;
  double first_padding, second_padding;

  SolidOracle first() const { return SolidOracle(first_shape, world_from_first, first_padding); }
  SolidOracle second() const { return SolidOracle(second_shape, world_from_second, second_padding); }
  /// Returns a description of shapes, paddings and poses for failure messages.
  std::string text() const;
};

/// Generates random test cases for a pair of shape kinds. Every few cases it creates new shapes. In some cases the
/// shapes are apart, in others they almost touch or overlap.
class Cases {
 public:
  Cases(unsigned seed, const KindPair& kinds, const Proportions& proportions = {})
      : random_(seed), kinds_(kinds), proportions_(proportions) {}

  /// @param from_origin  [m] distance by which both shapes are moved away from the world origin
  Case next(double from_origin = 0.0);
  Random& random() { return random_; }

 private:
  double randomGap();

  Random random_;
  KindPair kinds_;
  Proportions proportions_;
  std::vector<Shape> shapes_;
  int used_ = 0;
};

/// Moves the second shape along the line between the nearest points, until the padded shapes are `gap` [m] apart.
/// With a negative gap the shapes overlap by at most that much. Does nothing if the shapes already overlap.
void bringTo(double gap, Case& placed);

/// Measures one test case with the narrow phase under test. Creates the solids once, in the constructor.
class Trial {
 public:
  explicit Trial(const Case& placed);
  Proximity measure(double up_to = std::numeric_limits<double>::infinity()) const;
  /// Measures with the two shapes exchanged.
  Proximity measureSwapped(double up_to = std::numeric_limits<double>::infinity()) const;
  Contact contact() const;
  /// Describes the contact with the two shapes exchanged.
  Contact contactSwapped() const;

 private:
  const Case& placed_;
  std::shared_ptr<const Solid> first_, second_;
};

/// Returns the narrow phase under test.
NarrowPhase& narrowPhase();

/// Returns the answer with its first and second point exchanged and its normal reversed.
Proximity swapped(Proximity answer);

/// Returns whether all fields of two answers are exactly equal. NaN counts as equal to NaN.
bool isSame(const Proximity& a, const Proximity& b);

/// Returns whether `answer` agrees with `other`, the answer for the exchanged shapes: `answer` must equal
/// swapped(other). If both shapes are equal and at the same pose, nothing tells which one is first. Then `answer` must
/// equal `other` itself.
bool isSameInOtherOrder(const Case& placed, const Proximity& answer, const Proximity& other);

}  // namespace test
}  // namespace hgrid
