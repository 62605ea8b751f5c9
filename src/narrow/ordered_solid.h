// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"
#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// A solid that can be sorted: a core and a radius around it.
class OrderedSolid : public Solid {
 public:
  explicit OrderedSolid(const Shape& shape);

  ShapeKind kind() const { return kind_; }
  double radius() const { return radius_; }  ///< [m] around the core
  double reach() const { return reach_; }    ///< [m] of the shape from its origin, at most

  /// Compares two solids by kind, measures and vertices. Meshes come first.
  bool before(const OrderedSolid& other) const;

 protected:
  /// What a question is made of, which sorts like a box of these measures.
  OrderedSolid(const std::vector<double>& size, double reach) : kind_(ShapeKind::box), size_(size), reach_(reach) {}

 private:
  ShapeKind kind_;
  std::vector<double> size_;
  std::shared_ptr<const TriangleMesh> source_;  // of a hull or a mesh; kept alive, so that its address stays unique
  double reach_ = 0.0, radius_ = 0.0;
};

/// One of two solids that are measured, at its pose.
struct Side {
  explicit Side(const PlacedSolid& placed)
      : solid(static_cast<const OrderedSolid&>(placed.solid)),
        world_from_shape(placed.world_from_shape),
        around(solid.radius() + placed.padding) {}
  const OrderedSolid& solid;
  const Pose& world_from_shape;
  double around;  ///< [m] radius and padding
};

/// A narrow phase that measures two solids in one order, whatever the order of the question.
///
/// It sorts the two by OrderedSolid::before(), then by what is around them and by their poses. Answers are found in the
/// frame of the first and brought to the world. All its solids are OrderedSolids.
class OrderedNarrowPhase : public NarrowPhase {
 public:
  Proximity measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const final;
  std::vector<Contact> contacts(const PlacedSolid& first, const PlacedSolid& second, std::size_t most) const final;

 protected:
  /// Answers measure() for a pair in order, in the frame of `a`. May throw std::exception.
  virtual Proximity measureInOrder(const Side& a, const Side& b, double up_to) const = 0;
  /// Answers contacts() for a pair in order, in the frame of `a`, in any order. May throw std::exception.
  virtual std::vector<Contact> contactsInOrder(const Side& a, const Side& b, std::size_t most) const = 0;
};

}  // namespace hgrid
