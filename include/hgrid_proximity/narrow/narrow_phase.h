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
  not_measured = 0,         ///< no measurement was requested, or there was no time for it
  apart = 1,                ///< the shapes are apart; distance, points and normal are valid
  contact = 2,              ///< the shapes are in contact; the distance is 0
  contained = 3,            ///< one shape is inside the other shape, which is a closed mesh; counts as contact
  containment_unknown = 4,  ///< one shape may be inside the other, a mesh that is open or unclear; counts as contact
  failed = 5,               ///< the solver failed; counts as contact
};

/// Returns the status as a word, such as "CONTAINED".
const char* name(Measure status);

/// Whether the status is contact or counts as contact.
inline bool isContact(Measure status) { return status >= Measure::contact; }

/// Distance or contact of two padded shapes. Values that are not known are NaN.
struct Proximity {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  ///< stands for "not known"

  Measure status = Measure::not_measured;  ///< what the measurement found
  /// [m] Distance of the two nearest points; 0 in contact; infinite if larger than the `up_to` of measure().
  double distance = kUnknown;
  /// [m] The distance is at least this: a plane between the two shapes proves it. It is less than `distance` by the
  /// error of the measurement (doc/guarantees.md), and only where a solver ended early by more. If the distance may be
  /// on either side of `up_to`, it is infinite and this bound is not.
  double lower_bound = kUnknown;
  /// [m, world] Nearest point of the first shape; in contact its deepest point.
  Eigen::Vector3d on_first = Eigen::Vector3d::Constant(kUnknown);
  /// [m, world] Nearest point of the second shape; in contact its deepest point.
  Eigen::Vector3d on_second = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(kUnknown);  ///< unit vector from the first to the second shape
  /// [m] Upper bound of the penetration depth, in contact: moving the second shape this far along the normal separates
  /// the two. Unknown, as points and normal, if the shapes overlap without their padding and radius; measureContact()
  /// finds depth and normal then. Of a point inside a closed mesh: its distance from the surface. If parts of the mesh
  /// overlap, the point may then still be inside.
  double depth = kUnknown;
};

/// Where two solids, or a part of one and a part of another, are in contact. The parts of a mesh are its triangles; a
/// convex solid has one part. Values that are not known are NaN.
struct Contact {
  /// [m, world] A point that both padded solids have in common, to 1e-6 m.
  Eigen::Vector3d point = Eigen::Vector3d::Constant(Proximity::kUnknown);
  /// Unit vector from the first solid to the second: the direction of the move that `depth` describes.
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(Proximity::kUnknown);
  /// [m] Upper bound of the penetration depth, >= 0. Moving the second solid this far along the normal, and 1e-6 m
  /// farther, separates the two. A shorter move in this or another direction may separate them as well.
  double depth = Proximity::kUnknown;
  /// [m] Lower bound of the penetration depth, >= 0: no shorter move in any direction separates the two. For convex
  /// solids, it usually equals the upper bound, apart from the error of a measurement. 0 for other solids.
  double depth_at_least = 0.0;
};

/// Orders contacts for sorting: the deepest first, contacts of unknown depth last.
inline bool deeper(const Contact& a, const Contact& b) {
  return a.depth > b.depth || (std::isnan(b.depth) && !std::isnan(a.depth));
}

/// A shape that a NarrowPhase has prepared for measuring. It is immutable, and bodies with the same shape can share it.
class Solid {
 public:
  virtual ~Solid() = default;
};

/// A solid at a pose in the world, grown by its padding on all sides. The solid and the pose are not copied: they must
/// outlive this object.
struct PlacedSolid {
  const Solid& solid;            ///< not owned
  const Pose& world_from_shape;  ///< pose of the solid in the world; not owned
  double padding;                ///< [m] how much the solid is grown, >= 0
};

/// Measures the exact distance of two shapes.
///
/// Shapes are solid. A closed mesh consists of its surface and the space inside; an open mesh is only its surface. A
/// plane is a half-space. Two planes always count as in contact.
/// Several threads may call measure() at the same time.
class NarrowPhase {
 public:
  virtual ~NarrowPhase() = default;

  /// Prepares a shape for measuring. Any thread may call this.
  ///
  /// Solids of the same mesh share its data as long as one of these solids exists.
  /// @throws Refusal with code bad_geometry
  virtual std::shared_ptr<const Solid> solidOf(const Shape& shape) = 0;

  // Solids for queries. The padding of a PlacedSolid gives them a radius.
  /// Returns the half-space z <= 0.
  virtual std::shared_ptr<const Solid> plane() const = 0;
  /// Returns a point at the origin.
  virtual std::shared_ptr<const Solid> point() const = 0;
  /// Creates a segment along z, centered at the origin. @param length [m] > 0
  virtual std::shared_ptr<const Solid> needle(double length) const = 0;
  /// Creates a box centered at the origin. @param size [m] full side lengths, >= 0
  virtual std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const = 0;

  /// Measures two solids that this narrow phase created. Never throws: after an error the status is Measure::failed.
  ///
  /// If the caller exchanges the two solids, their points are exchanged as well and the normal changes its sign. All
  /// other values stay the same.
  /// @param up_to  [m] if the distance is larger than this, the result is `apart` with an infinite distance; a small
  /// value can be much faster
  virtual Proximity measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const = 0;

  /// Describes where two solids are in contact, and how far one must be moved until they are not. Never throws, and
  /// allocates no memory: after an error all values are NaN.
  ///
  /// The move separates the whole solids, also those of meshes. For convex solids it is the shortest. For other solids,
  /// its direction is the best of a few dozen, and it may be much longer than the shortest move. Exceptions:
  /// - Two planes have no point, normal and depth.
  /// - Measure::containment_unknown: the point is one of the solid that may be inside the other.
  /// If the caller exchanges the two solids, the normal changes its sign. All other values stay the same.
  /// @param first, second  solids for which measure() returned a status that counts as contact, except Measure::failed
  virtual Contact measureContact(const PlacedSolid& first, const PlacedSolid& second) const = 0;

  /// Lists the contacts of two solids that this narrow phase created, deepest first.
  ///
  /// Each pair of parts that meet is one contact. If one solid is wholly inside the other, there is one contact. The
  /// list is empty if the solids are apart.
  /// @param most  the search ends after this many contacts
  /// @throws std::exception if the solver failed, so that an empty list always means that there are no contacts
  virtual std::vector<Contact> contacts(const PlacedSolid& first, const PlacedSolid& second,
                                        std::size_t most) const = 0;
};

}  // namespace hgrid
