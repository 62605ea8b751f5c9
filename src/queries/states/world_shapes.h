// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <deque>
#include <vector>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "queries/placed_map.h"
#include "queries/placed_plane.h"
#include "queries/states/four_spheres.h"
#include "queries/states/map_clearance.h"
#include "queries/states/robot_shapes.h"

namespace hgrid {

/// A shape of a body that the joints of the robot do not move.
struct WorldShape {
  std::uint32_t body, shape;  ///< index of the body, and index of the shape among the shapes of the body
  TiltedBox<float> box;       ///< box around the padded shape, relative to the origin of the snapshot
  std::uint32_t spheres = 0;  ///< number of spheres of this and all former shapes
};

/// The shapes, maps and planes around a robot, as one snapshot has them. Bodies without a pose are left out.
class WorldShapes {
 public:
  WorldShapes(const Snapshot& snapshot, const RobotShapes& robot, const QueryScope& scope);

  const std::vector<WorldShape>& shapes() const { return shapes_; }
  /// Returns the first of the spheres inside a shape, relative to the origin of the snapshot. @param shape  index of
  /// the shape, or the number of shapes for the end
  const SmallSphere* spheresOf(std::size_t shape) const {
    return spheres_.data() + (shape == 0 ? 0 : shapes_[shape - 1].spheres);
  }
  const std::deque<PlacedMap>& maps() const { return maps_; }
  /// Returns the MapClearance of each of maps().
  const std::vector<MapClearance>& clearances() const { return clearances_; }
  const std::vector<PlacedPlane>& planes() const { return planes_; }

  /// Returns whether a search should test the few shapes() one by one, instead of calling overlapping().
  bool isSmall() const { return shapes_.size() <= kFew; }
  /// Replaces `found` with the indices of the shapes whose axis-aligned boxes overlap `box`, in ascending order.
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) const { grid_.overlapping(box, found); }
  /// Returns the axis-aligned box of a shape, relative to the origin of the snapshot.
  const Aabb& boundsOf(std::size_t shape) const { return bounds_[shape]; }

 private:
  static constexpr std::size_t kFew = 24;
  void addSpheres(const BodyShape& shape, const Pose& local_from_shape);

  std::vector<WorldShape> shapes_;
  std::vector<Aabb> bounds_;          // for each shape
  std::vector<SmallSphere> spheres_;  // of all shapes
  // The grid of the snapshot has the boxes grown by their margins, and those of the robot. This one has neither, which
  // makes a search several times faster.
  HGrid grid_;
  std::deque<PlacedMap> maps_;
  std::vector<MapClearance> clearances_;
  std::vector<PlacedPlane> planes_;
};

}  // namespace hgrid
