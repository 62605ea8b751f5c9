// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Searches a StaticGrid along a segment.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "geometry/four_lanes.h"
#include "geometry/rounding.h"
#include "hgrid_proximity/maps/static_grid.h"
#include "maps/brick.h"
#include "maps/static_grid_bricks.h"

namespace hgrid {

/// For each slice of a brick: the cells of the slice that are in a range of coordinates along another axis.
///
/// A slice is one of the four layers of 4 x 4 cells perpendicular to the main axis. The set
/// sets[main][other][slice][5 * first + end] holds the cells of the slice whose cellAlong() is at least `first` and
/// less than `end`. `first` and `end` are 0 .. 4. cellAlong() is taken along the axis (main + 1 + other) % 3.
struct SliceRanges {
  using Slice = std::array<std::uint64_t, 25>;
  std::array<std::array<std::array<Slice, 4>, 2>, 3> sets{};

  constexpr SliceRanges() {
    for (std::size_t main = 0; main < 3; ++main) {
      for (std::size_t other = 0; other < 2; ++other) {
        for (std::size_t slice = 0; slice < 4; ++slice) {
          for (std::size_t range = 0; range < 25; ++range) {
            sets[main][other][slice][range] = kCellRanges.sets[main][slice][slice + 1] &
                                              kCellRanges.sets[(main + 1 + other) % 3][range / 5][range % 5];
          }
        }
      }
    }
  }
};
inline constexpr SliceRanges kSliceRanges;

/// The coordinates of each cell in its brick, counted in cells. `along` holds them per axis. `keys` holds them in one
/// number with 16 bits per axis, x lowest.
struct CellPlaces {
  std::array<std::array<float, 64>, 3> along{};
  std::array<std::uint64_t, 64> keys{};

  constexpr CellPlaces() {
    for (unsigned cell = 0; cell < 64; ++cell) {
      for (int axis = 0; axis < 3; ++axis) {
        along[static_cast<std::size_t>(axis)][cell] = static_cast<float>(cellAlong(cell, axis));
        keys[cell] |= static_cast<std::uint64_t>(cellAlong(cell, axis)) << 16 * axis;
      }
    }
  }
};
inline constexpr CellPlaces kCellPlaces;

/// Searches a grid along a segment.
///
/// The search visits the bricks in the order in which the segment passes them. In each brick it selects, in one step,
/// all cells that the segment passes. The main axis is the axis along which the segment is longest. A slice is a layer
/// of cells perpendicular to the main axis. In each slice, the search selects the cells between the points where the
/// segment enters and leaves the slice.
///
/// The coordinates of the segment in a brick are computed from its coordinates in the brick of the level above. They
/// are floats, because they only select cells, with a tolerance that is larger than their rounding error. The test
/// whether a voxel is touched uses doubles.
class LineSearch {
 public:
  /// @param segment  in keys (finest edges), relative to the origin of the map
  /// @param error    [keys] bound of the error of the segment
  LineSearch(const Bricks& bricks, const Segment& segment, double error)
      : bricks_(bricks), segment_(segment), error_(error) {
    const Eigen::Vector3d step = segment.to - segment.from;
    const double longest = step.cwiseAbs().maxCoeff(&main_);
    const double farthest = std::max(segment.from.cwiseAbs().maxCoeff(), segment.to.cwiseAbs().maxCoeff());
    around_ = segment.radius + 2.0 * roundingSlack(farthest + segment.radius) + error;  // more than FirstTouch allows
    length_ = step.norm();
    step_ = step[main_];
    const double per_step = longest > kLeastStep ? 1.0 / step_ : 0.0;
    const std::array<double, 2> slopes{step[axisOf(0)] * per_step, step[axisOf(1)] * per_step};
    begin(slopes);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto slope = static_cast<float>(slopes[i]);
      const Four slices = Four{0.0f, 1.0f, 2.0f, 3.0f} * slope;
      others_[i] = {slices + std::min(slope, 0.0f), slices + std::max(slope, 0.0f), Four{slope, slope, 0.0f, 0.0f},
                    &kCellPlaces.along[static_cast<std::size_t>(axisOf(i))]};
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t slice = step_ < 0.0 ? 3 - i : i;
      slices_[i] = kCellRanges.sets[static_cast<std::size_t>(main_)][slice][slice + 1];
    }
  }

  /// Returns the voxel that the segment touches first. VoxelTouch::along is a fraction of the segment, 0 .. 1. It is
  /// infinite if the segment touches no voxel.
  VoxelTouch first() {
    const int top = bricks_.start.level;
    Frame* frame = &frames_[static_cast<std::size_t>(top)];
    enter(*frame, top);
    for (int level = top;;) {
      while (frame->left == 0) {
        if (++level > top) return first_;
        ++frame;
      }
      const unsigned cell = firstCell(firstSlice(frame->left));
      if (frame->full >> cell & 1u) {
        touch(*frame, level, cell);
      } else {
        frame->left &= ~(std::uint64_t{1} << cell);
        goBelow(*frame, level, cell, *(frame - 1));
        --level;
        --frame;
      }
    }
  }

 private:
  /// [cells] Tolerance for rounding errors in the brick where the search starts. Each level below has a tolerance of
  /// four times as many of its own cells. All numbers that matter are less than 8. So the rounding error of a level is
  /// less than 2^-20 of the edge of its cells.
  static constexpr float kRoom = 1.0f / (1 << 18);

  /// The state of the search in one brick. Positions on the segment are measured in cells, from the minimum corner of
  /// the brick.
  struct Frame {
    std::uint64_t left;         // cells that the segment passes and that the search has not visited yet
    std::uint64_t cells, full;  // cells that are not empty; cells that are voxels
    std::uint64_t keys;         // keys of the brick's corner, 16 bits per axis
    std::uint32_t number;
    Four main;  // range of the segment along the main axis: from, to; the other two values are not used
    // For each other axis four values: the range (from, to) of the segment where its coordinate along the main axis is
    // 0, then the range (from, to) of the whole segment.
    std::array<Four, 2> others;
  };
  /// One of the two axes that are not the main axis.
  struct Other {
    Four from, to;  // for each slice: the range of the segment in it, relative to the first range in Frame::others
    Four slope;     // change of the ranges in Frame::others per cell along the main axis
    const std::array<float, 64>* along;  // CellPlaces::along for this axis
  };

  int axisOf(std::size_t other) const { return (main_ + 1 + static_cast<int>(other)) % 3; }
  static double edgeOf(int level) { return static_cast<double>(std::int64_t{1} << 2 * level); }

  /// Computes the Frame of the brick where the search starts.
  void begin(const std::array<double, 2>& slopes) {
    const Brick& start = bricks_.start;
    Frame& frame = frames_[static_cast<std::size_t>(start.level)];
    frame.number = start.number;
    frame.keys = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      frame.keys |= static_cast<std::uint64_t>(start.corner[axis] + Voxel::kOriginKey) << 16 * axis;
    }
    const double per_edge = 1.0 / edgeOf(start.level);
    const auto least = [&](int axis, double key) {
      return static_cast<float>((key - start.corner[static_cast<std::size_t>(axis)]) * per_edge) - kRoom;
    };
    const auto greatest = [&](int axis, double key) { return least(axis, key) + 2.0f * kRoom; };
    const Eigen::Vector3d min = segment_.from.cwiseMin(segment_.to), max = segment_.from.cwiseMax(segment_.to);
    frame.main = Four{least(main_, min[main_] - around_), greatest(main_, max[main_] + around_), 0.0f, 0.0f};
    const double to_corner = start.corner[static_cast<std::size_t>(main_)] - segment_.from[main_];
    for (std::size_t i = 0; i < 2; ++i) {
      const int axis = axisOf(i);
      const double at = segment_.from[axis] + to_corner * slopes[i], around = around_ * (1.0 + std::abs(slopes[i]));
      frame.others[i] = Four{least(axis, at - around), greatest(axis, at + around), least(axis, min[axis] - around_),
                             greatest(axis, max[axis] + around_)};
    }
  }

  /// Computes the Frame `below` of the brick that fills `cell` of the brick of `frame`.
  void goBelow(const Frame& frame, int level, unsigned cell, Frame& below) const {
    const std::uint64_t before = frame.cells & ~frame.full & ((std::uint64_t{1} << cell) - 1);
    below.number = bricks_.levels[static_cast<std::size_t>(level)].first_below[frame.number] +
                   static_cast<std::uint32_t>(bitCount(before));
    below.keys = frame.keys + (kCellPlaces.keys[cell] << 2 * level);
    const float main = kCellPlaces.along[static_cast<std::size_t>(main_)][cell];
    below.main = (frame.main - main) * 4.0f;
    for (std::size_t i = 0; i < 2; ++i) {
      below.others[i] = (frame.others[i] - (*others_[i].along)[cell] + others_[i].slope * main) * 4.0f;
    }
    enter(below, level - 1);
  }

  /// Loads the cells of the brick of `frame` and selects the cells that the segment passes.
  void enter(Frame& frame, int level) const {
    const BrickLevel& here = bricks_.levels[static_cast<std::size_t>(level)];
    frame.cells = here.cells[frame.number];
    frame.full = level == 0 ? frame.cells : here.full[frame.number];
    frame.left = frame.cells & alongMain(frame) & alongOther(frame, 0) & alongOther(frame, 1);
  }

  std::uint64_t alongMain(const Frame& frame) const {
    const FourCounts range = countsOf(frame.main + Four{0.0f, 1.0f, 0.0f, 0.0f});
    return kCellRanges.sets[static_cast<std::size_t>(main_)][range[0]][range[1]];
  }

  std::uint64_t alongOther(const Frame& frame, std::size_t i) const {
    const Four line = frame.others[i];
    const Four from = greatest(others_[i].from + line[0], allFour(line[2]));
    const Four to = least(others_[i].to + line[1], allFour(line[3]));
    const FourCounts first = countsOf(from), range = first * 4 + first + countsOf(to + 1.0f);
    const auto& sets = kSliceRanges.sets[static_cast<std::size_t>(main_)][i];
    return sets[0][range[0]] | sets[1][range[1]] | sets[2][range[2]] | sets[3][range[3]];
  }

  /// Finds the first slice along the segment that contains any of the given cells. Returns the given cells in it.
  std::uint64_t firstSlice(std::uint64_t cells) const {
    std::uint64_t first = cells;
    for (const std::size_t i : {2u, 1u, 0u}) {
      const std::uint64_t here = cells & slices_[i];
      first = here != 0 ? here : first;
    }
    return first;
  }

  /// Checks whether the segment touches the voxel of a cell, and keeps the first voxel along the segment.
  void touch(Frame& frame, int level, unsigned cell) {
    const Brick brick = brickOf(frame, level);
    frame.left &= ~bricks_.cellsOfVoxel(brick, cell);
    const Voxel voxel = bricks_.voxelAt(brick, cell);
    const auto along = FirstTouch(segment_, error_)(keysOf(voxel));
    if (!along) return;
    const double share = length_ > 0.0 ? *along / length_ : 0.0;
    if (!(share < first_.along)) return;
    first_ = {voxel, share};
    endAt(segment_.from + share * (segment_.to - segment_.from), level);
  }

  /// Shortens the search: removes the cells that the segment passes only beyond `end` [keys], in this brick and in all
  /// bricks that contain it.
  void endAt(const Eigen::Vector3d& end, int level) {
    for (; level <= bricks_.start.level; ++level) {
      Frame& frame = frames_[static_cast<std::size_t>(level)];
      if (frame.left == 0) continue;
      const Brick brick = brickOf(frame, level);
      const auto shorten = [&](int axis, float& from, float& to) {
        const double at = end[axis] - brick.corner[static_cast<std::size_t>(axis)];
        const bool falls = segment_.to[axis] < segment_.from[axis];
        const auto last = static_cast<float>((falls ? at - around_ : at + around_) / edgeOf(level));
        falls ? from = std::max(from, last - kRoom) : to = std::min(to, last + kRoom);
      };
      float from = frame.main[0], to = frame.main[1];
      shorten(main_, from, to);
      frame.main = Four{from, to, 0.0f, 0.0f};
      frame.left &= alongMain(frame);
      for (std::size_t i = 0; i < 2 && frame.left != 0; ++i) {
        from = frame.others[i][2], to = frame.others[i][3];
        shorten(axisOf(i), from, to);
        frame.others[i] = Four{frame.others[i][0], frame.others[i][1], from, to};
        frame.left &= alongOther(frame, i);
      }
    }
  }

  static Brick brickOf(const Frame& frame, int level) {
    const auto corner = [&](int axis) {
      return static_cast<std::uint16_t>(frame.keys >> 16 * axis) - Voxel::kOriginKey;
    };
    return {level, frame.number, {corner(0), corner(1), corner(2)}};
  }

  const Bricks& bricks_;
  const Segment segment_;
  const double error_;
  int main_ = 0;
  double around_;  // [keys] radius of the segment plus a tolerance
  double length_;  // [keys] length of the segment
  double step_;    // [keys] change along the main axis from the start of the segment to its end
  std::array<Other, 2> others_;
  // The slices perpendicular to the main axis, in the order in which the segment passes them.
  std::array<std::uint64_t, 4> slices_;
  std::array<Frame, kBrickLevels> frames_;
  VoxelTouch first_{{}, std::numeric_limits<double>::infinity()};
};

}  // namespace hgrid
