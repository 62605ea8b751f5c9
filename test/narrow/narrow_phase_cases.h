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
/// The kinds that narrowPhase() measures: all seven, or all but meshes.
std::vector<ShapeKind> measuredKinds();
bool measuresMeshes();
/// Their pairs: 28 of seven kinds.
std::vector<KindPair> allKindPairs();
/// As in "box_mesh", for names of tests.
std::string nameOf(const KindPair& kinds);

/// Two shapes in the world and their paddings.
struct Case {
  Shape first_shape, second_shape;
  Pose world_from_first, world_from_second;
  double first_padding, second_padding;

  SolidOracle first() const { return SolidOracle(first_shape, world_from_first, first_padding); }
  SolidOracle second() const { return SolidOracle(second_shape, world_from_second, second_padding); }
  /// Measures and shapes, to read in a message of failure.
  std::string text() const;
};

/// Cases of a pair of kinds: new shapes every few cases, poses apart, near contact and in contact.
class Cases {
 public:
  Cases(unsigned seed, const KindPair& kinds, const Proportions& proportions = {})
      : random_(seed), kinds_(kinds), proportions_(proportions) {}

  /// @param from_origin  [m] how far off the pair lies
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

/// Moves the second along the line of nearest points until the padded shapes are `gap` [m] apart; if negative, they
/// overlap by at most that much. Nothing if they overlap to begin with.
void bringTo(double gap, Case& placed);

/// The product on trial, with solids made once for each case.
class Trial {
 public:
  explicit Trial(const Case& placed);
  Proximity measure(double up_to = std::numeric_limits<double>::infinity()) const;
  /// With the order of the two exchanged.
  Proximity measureSwapped(double up_to = std::numeric_limits<double>::infinity()) const;

 private:
  const Case& placed_;
  std::shared_ptr<const Solid> first_, second_;
};

/// The narrow phase that is tested. The same tests are linked with test/narrow/tested_convex.cpp and with
/// test/adapters/tested_fcl.cpp, which define this function.
NarrowPhase& narrowPhase();

/// The answer with first and second exchanged.
Proximity swapped(Proximity answer);

/// The same bit for bit; NaN is the same as NaN.
bool isSame(const Proximity& a, const Proximity& b);

/// Whether `answer` to a case is `other`, to the case in the other order, with the order exchanged. Of two equal shapes
/// at one pose nobody can tell which is the first: there any normal and its points may be said of either.
bool isSameInOtherOrder(const Case& placed, const Proximity& answer, const Proximity& other);

}  // namespace test
}  // namespace hgrid
