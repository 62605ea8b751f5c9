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

/// The cells that a sensor saw points in, each kept for a while after it was seen last.
///
/// Cells lie on the lattice of the world: cell (0, 0, 0) begins at the world's origin, so that the same thing seen from
/// elsewhere fills the same cells. Their keys count from corner(), which follows the sensor in rare great steps, so
/// that they reach from it as far as those of a map. One thread at a time.
class CloudCells {
 public:
  /// Points farther from the sensor than this many cells along an axis are left out.
  static constexpr int kReach = 1 << 14;

  /// @param edge      [m] of a cell, 0.001 .. 100
  /// @param lifetime  how long a cell stays after it was seen
  /// @param most      cells
  CloudCells(double edge, Time lifetime, std::size_t most);

  double edge() const { return edge_; }
  /// [m, world] where the cell with the keys of a map's origin (Voxel::kOriginKey) begins.
  Eigen::Vector3d corner() const;

  /// Moves the keys to the sensor [m, world] if it is far from their middle. What lies out of reach then is forgotten.
  /// @returns cells forgotten
  std::size_t follow(const Eigen::Vector3d& sensor);
  /// The cells that points [m, world] lie in, each once, in Morton order. @param left_out  points out of reach
  std::vector<Voxel> cellsOf(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& sensor,
                             std::size_t& left_out) const;
  /// Takes in cells, which are disjoint, of level 0 and in Morton order, as seen at a time.
  /// @throws Refusal limit if there would be too many; then nothing has changed
  void see(const std::vector<Voxel>& cells, Time stamp);
  /// Forgets what was seen longer ago than the lifetime, or, since the clock was set back, is to be seen only so much
  /// later. @returns cells forgotten
  std::size_t forget(Time now);
  /// All cells in Morton order.
  std::vector<Voxel> cells() const;
  std::size_t size() const { return seen_.size(); }

 private:
  using Keys = std::array<std::int64_t, 3>;  // of the lattice of the world
  struct Seen {
    std::uint64_t code;  // Morton code of a voxel of level 0
    Time stamp;          // when it was seen last
  };

  Keys keysOf(const Eigen::Vector3d& point) const;

  double edge_;
  Time lifetime_;
  std::size_t most_;
  Keys middle_{};           // the cell of Voxel::kOriginKey
  std::vector<Seen> seen_;  // by code
};

}  // namespace hgrid
