// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/geometry/voxel.h"

namespace hgrid {

/// Stores the cells in which a sensor has seen points. Each cell is kept for a lifetime after it was last seen.
///
/// The cells form a fixed lattice in the world frame, and cell (0, 0, 0) begins at the world's origin. So an object
/// fills the same cells wherever the sensor is. Keys have only 16 bits, so they describe a limited space around
/// corner(). corner() follows the sensor in rare, large steps, then the cells get new keys. Only one thread may use
/// this object at a time.
class CloudCells {
 public:
  /// Number of cells. Points that are this far or farther away from the sensor along an axis are ignored.
  static constexpr int kReach = 1 << 14;

  /// @param edge      [m] edge of a cell, 0.001 .. 100
  /// @param lifetime  how long a cell is kept after it was last seen
  /// @param most      largest number of cells
  CloudCells(double edge, Time lifetime, std::size_t most);

  /// Returns the edge [m] of a cell.
  double edge() const { return edge_; }
  /// Returns the minimum corner [m, world] of the cell whose three keys are Voxel::kOriginKey.
  Eigen::Vector3d corner() const;

  /// Moves corner() to the sensor [m, world] if the sensor is kReach cells or more away from it. Removes the cells that
  /// no longer have valid keys.
  /// @returns the number of cells removed
  std::size_t follow(const Eigen::Vector3d& sensor);
  /// Returns the cells that contain the points [m, world], each cell once, in Morton order.
  /// @param sensor    [m, world] position of the sensor
  /// @param left_out  receives the number of points that were ignored because they are too far from the sensor
  std::vector<Voxel> cellsOf(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& sensor,
                             std::size_t& left_out) const;
  /// Adds cells that were seen at time `stamp`. They must be disjoint, of level 0 and in Morton order.
  /// @throws Refusal with code limit if there would be too many cells; then nothing has changed
  void see(const std::vector<Voxel>& cells, Time stamp);
  /// Removes cells that were last seen more than the lifetime before `now`. Also removes cells whose stamp is more than
  /// the lifetime after `now`, which happens when the clock is set back.
  /// @returns the number of cells removed
  std::size_t forget(Time now);
  /// Returns all cells in Morton order.
  std::vector<Voxel> cells() const;
  /// Returns the number of cells.
  std::size_t size() const { return seen_.size(); }

 private:
  using Keys = std::array<std::int64_t, 3>;  // index of a cell along x, y and z in the lattice of the world
  struct Seen {
    std::uint64_t code;  // Morton code of the cell, a voxel of level 0
    Time stamp;          // when the cell was last seen
  };

  Keys keysOf(const Eigen::Vector3d& point) const;

  double edge_, per_edge_;  // [m], and its reciprocal [1/m], as OctoMap computes it
  Time lifetime_;
  std::size_t most_;
  Keys middle_{};           // the cell that has Voxel::kOriginKey as its x, y and z in a Voxel
  std::vector<Seen> seen_;  // sorted by Seen::code
};

}  // namespace hgrid
