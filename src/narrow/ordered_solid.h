// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"
#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// A solid that consists of a core and a radius around it. Solids can be sorted, so that two solids are always measured
/// in the same order.
class OrderedSolid : public Solid {
 public:
  explicit OrderedSolid(const Shape& shape);

  ShapeKind kind() const { return kind_; }
  double radius() const { return radius_; }  ///< [m] radius around the core
  /// Returns an upper bound [m] of the distance from the origin to the shape's points; infinite for a plane.
  double reach() const { return reach_; }

  /// Whether this solid comes before the other. Compares kind, dimensions and vertices. Planes come first, then meshes.
  bool before(const OrderedSolid& other) const;

 protected:
  /// Creates a solid for queries. It is sorted like a box with these dimensions.
  OrderedSolid(const std::vector<double>& size, double reach) : kind_(ShapeKind::box), size_(size), reach_(reach) {}

 private:
  ShapeKind kind_;
  std::vector<double> size_;
  std::shared_ptr<const TriangleMesh> source_;  // of a hull or a mesh; kept, so that no other mesh gets its address
  double reach_ = 0.0, radius_ = 0.0;
};

/// One of the two solids of a measurement, at its pose.
struct Side {
  explicit Side(const PlacedSolid& placed)
      : solid(static_cast<const OrderedSolid&>(placed.solid)),
        world_from_shape(placed.world_from_shape),
        around(solid.radius() + placed.padding) {}
  const OrderedSolid& solid;
  const Pose& world_from_shape;
  double around;  ///< [m] sum of radius and padding
};

/// A narrow phase that always measures two solids in the same order, for any order of the arguments.
///
/// It sorts the two solids by OrderedSolid::before(), then by Side::around, then by their poses. It computes results in
/// the frame of the first solid and converts them to the world frame. All its solids are OrderedSolids.
class OrderedNarrowPhase : public NarrowPhase {
 public:
  Proximity measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const final;
  Contact measureContact(const PlacedSolid& first, const PlacedSolid& second) const final;
  std::vector<Contact> contacts(const PlacedSolid& first, const PlacedSolid& second, std::size_t most) const final;

 protected:
  /// Implements measure() for a sorted pair, in the frame of `a`. May throw std::exception.
  virtual Proximity measureInOrder(const Side& a, const Side& b, double up_to) const = 0;
  /// Implements measureContact() for a sorted pair, in the frame of `a`. May throw std::exception.
  virtual Contact measureContactInOrder(const Side& a, const Side& b) const = 0;
  /// Implements contacts() for a sorted pair, in the frame of `a`. The contacts may have any order.
  virtual std::vector<Contact> contactsInOrder(const Side& a, const Side& b, std::size_t most) const = 0;
};

}  // namespace hgrid
