// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/occupancy.h"

#include <algorithm>
#include <cmath>

#include "geometry/infinity.h"
#include "geometry/rounding.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {
namespace {

/// A coordinate in coarse cells, as a fixed-point number with 16 binary digits after the point.
using Fixed = std::int32_t;
constexpr double kOne = 65536.0;

}  // namespace

void Occupancy::set(const std::vector<kernels::Level>& levels) {
  constexpr std::size_t kMostMarks = kRows * kAcross / 2;  // if more cells are occupied, the bits are of no use
  kernels::Box all = {{kFloatInfinity, kFloatInfinity, kFloatInfinity},
                      {-kFloatInfinity, -kFloatInfinity, -kFloatInfinity}};
  for (const kernels::Level& level : levels) {
    for (int axis = 0; axis < 3; ++axis) {
      all.min[axis] = std::min(all.min[axis], level.around.min[axis]);
      all.max[axis] = std::max(all.max[axis], level.around.max[axis]);
    }
  }
  constexpr double kLeastSlack = 1e-6;  // [cells] allows for the rounding within the bounds of all boxes
  slack_ = kLeastSlack;
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, static_cast<double>(all.max[axis]) - static_cast<double>(all.min[axis]));
  }
  // The cells are cubes. If they were as flat as the bounds, a line would pass many of them.
  inverse_ = longest > kLeastLength && longest < 1e30 ? (kLast + 1.0) / longest : 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    origin_[axis] = inverse_ > 0.0 ? static_cast<double>(all.min[axis]) * inverse_ : 0.0;
    slack_ += roundingSlack(std::abs(origin_[axis]));
  }
  rows_.assign(kRows, 0);
  std::size_t marks = 0;
  for (const kernels::Level& level : levels) {
    if (level.begin == level.end) continue;
    std::uint32_t low[3], high[3];
    std::size_t cells_of_level = 1;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = cellAt(cells(static_cast<double>(level.around.min[axis]), axis));
      high[axis] = cellAt(cells(static_cast<double>(level.around.max[axis]), axis));
      cells_of_level *= high[axis] - low[axis] + 1;
    }
    marks += cells_of_level;
    if (marks > kMostMarks) return clear();
    const std::uint32_t bits = (~std::uint32_t{0} << low[0]) & (~std::uint32_t{0} >> (31 - high[0]));
    for (std::uint32_t z = low[2]; z <= high[2]; ++z) {
      for (std::uint32_t y = low[1]; y <= high[1]; ++y) rows_[z * kAcross + y] |= bits;
    }
  }
  near_rows_.resize(kRows);
  for (std::uint32_t z = 0; z < kAcross; ++z) {
    const std::uint32_t next_z = (z + 1) % kAcross;
    for (std::uint32_t y = 0; y < kAcross; ++y) {
      const std::uint32_t next_y = (y + 1) % kAcross;
      const std::uint32_t bits = rows_[z * kAcross + y] | rows_[z * kAcross + next_y] | rows_[next_z * kAcross + y] |
                                 rows_[next_z * kAcross + next_y];
      near_rows_[z * kAcross + y] = bits | bits >> 1 | bits << (kAcross - 1);
    }
  }
}

// Divides the line into pieces that are so short that the bounds of a piece, grown by the radius, cover at most two
// cells per axis. From one piece to the next, the bounds move by the same step. The loop has no branches, because they
// would be mispredicted. Outside the bounds of all boxes, the indices of the cells wrap around. There the search may
// only find too much.
bool Occupancy::isOnLine(const kernels::Line& line) const {
  constexpr double kFarthest = 16384.0;  // [cells] largest coordinate of a fixed-point number
  constexpr double kFewPieces = 4.0,
                   kMostPieces = 16.0;     // of a longer line, a part may be beyond the bounds of all boxes
  constexpr double kMargin = 1.0 / 256.0;  // [cells] allows for the rounding to Fixed
  const double widest = line.around * inverse_ + slack_ + kMargin;
  const double longest_piece = 1.0 - 2.0 * kMargin - 2.0 * widest;  // [cells]
  double from[3], step[3], longest = 0.0, farthest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    from[axis] = cells(line.from[axis], axis);
    step[axis] = line.step[axis] * inverse_;
    const double length = std::abs(step[axis]);
    longest = longest < length ? length : longest;
    farthest += std::abs(from[axis]) + length;
  }
  // False if a value is NaN.
  const bool fits = (farthest < kFarthest) & (widest < 0.4) & (longest < kMostPieces * longest_piece);
  if (!fits) return true;
  // There are only two different numbers of pieces: the processor mispredicts the end of the loop when the number
  // differs from that of the query before.
  const bool many = longest > kFewPieces * longest_piece;
  const double part = many ? 0.5 / kMostPieces : 0.5 / kFewPieces;
  const int pieces = many ? static_cast<int>(kMostPieces) : static_cast<int>(kFewPieces);
  Fixed low[3], move[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double half = step[axis] * part;
    move[axis] = static_cast<Fixed>(half * (2.0 * kOne));
    low[axis] = static_cast<Fixed>((from[axis] + half - std::abs(half) - widest) * kOne);
  }
  const std::uint32_t* const rows = near_rows_.data();
  std::uint32_t found = 0;
  for (int i = 0; i < pieces; ++i) {
    const auto y = static_cast<std::uint32_t>(low[1] >> 16) & 31u, z = static_cast<std::uint32_t>(low[2] >> 11) & 992u;
    found |= rows[z | y] >> (static_cast<std::uint32_t>(low[0] >> 16) & 31u);
    for (int axis = 0; axis < 3; ++axis) low[axis] += move[axis];
  }
  return (found & 1) != 0;
}

}  // namespace hgrid
