// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

/// The outcome of measuring how far two shapes are apart. The numbers are part of the interface: do not change them.
enum class Measure : std::uint8_t {
  not_measured = 0,         ///< not asked, or no time was left for it
  apart = 1,                ///< distance, points and normal hold
  contact = 2,              ///< in contact: distance 0
  contained = 3,            ///< one lies wholly inside the other, a closed mesh: in contact
  containment_unknown = 4,  ///< one may lie inside the other, an open mesh: to be taken as contact
  failed = 5,               ///< the solver failed: to be taken as contact
};

/// The status as a word, as in "CONTAINED".
const char* name(Measure status);

/// Whether it says contact, or is to be taken as contact.
inline bool isContact(Measure status) { return status >= Measure::contact; }

/// How two padded shapes lie to each other. NaN where nothing is known.
struct Proximity {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Measure status = Measure::not_measured;
  double distance = kUnknown;  ///< [m] 0 in contact; infinite if farther apart than was asked for
  Eigen::Vector3d on_first = Eigen::Vector3d::Constant(kUnknown);  ///< [m, world] nearest point; in contact the deepest
  Eigen::Vector3d on_second = Eigen::Vector3d::Constant(kUnknown);  ///< [m, world] the same of the second
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(kUnknown);     ///< unit vector from the first towards the second
  double depth = kUnknown;  ///< [m] in contact: the second moved this far along the normal is free of the first
};

/// A place where two solids are in contact, told of two of their parts: a mesh has its triangles, what is convex is one
/// part. NaN where nothing is known.
struct Contact {
  Eigen::Vector3d point = Eigen::Vector3d::Constant(Proximity::kUnknown);   ///< [m, world] of both padded parts
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(Proximity::kUnknown);  ///< unit vector from the first part on
  double depth = Proximity::kUnknown;  ///< [m] the second part moved this far along the normal is free of the first
};

/// An order of contacts: deepest first, those of unknown depth last.
inline bool deeper(const Contact& a, const Contact& b) {
  return a.depth > b.depth || (std::isnan(b.depth) && !std::isnan(a.depth));
}

/// A shape made ready to be measured: immutable, shared by all bodies that have it.
class Solid {
 public:
  virtual ~Solid() = default;
};

/// A solid somewhere in the world, grown by its padding on all sides.
struct PlacedSolid {
  const Solid& solid;
  const Pose& world_from_shape;
  double padding;  ///< [m] >= 0
};

/// Answers how far two shapes are apart, exactly.
///
/// A shape is solid; a mesh is its surface, and if closed what it encloses. measure() may run on several threads.
class NarrowPhase {
 public:
  virtual ~NarrowPhase() = default;

  /// Makes a shape ready to be measured. The narrow phase shares what it makes of a mesh as long as somebody holds it.
  /// Any thread may call this.
  /// @returns null if this narrow phase cannot measure shapes of this kind (see makeConvexNarrowPhase())
  /// @throws Refusal bad_geometry
  virtual std::shared_ptr<const Solid> solidOf(const Shape& shape) = 0;

  // Solids of which questions are made. Padding gives them a radius.
  /// A point at the origin.
  virtual std::shared_ptr<const Solid> point() const = 0;
  /// A segment along z, centered. @param length [m] > 0
  virtual std::shared_ptr<const Solid> needle(double length) const = 0;
  /// A box, centered. @param size [m] full lengths, >= 0
  virtual std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const = 0;

  /// Measures two solids that this narrow phase made. Never throws: an error gives Measure::failed. If the two solids
  /// are exchanged, so are their points, the normal changes its sign, and everything else stays the same.
  /// @param up_to  [m] if the distance is larger, the answer is `apart` with an infinite distance, which can be much
  /// faster
  virtual Proximity measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const = 0;

  /// Lists the contacts of two solids that this narrow phase made, deepest first: one for each two parts that meet, or
  /// one if a solid lies wholly inside the other. Empty if the two are apart or the solver failed. Never throws.
  /// @param most  the search ends after this many contacts
  virtual std::vector<Contact> contacts(const PlacedSolid& first, const PlacedSolid& second,
                                        std::size_t most) const = 0;
};

}  // namespace hgrid
