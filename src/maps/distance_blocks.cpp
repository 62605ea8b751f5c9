// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "maps/distance_blocks.h"

#include <algorithm>
#include <cmath>

#include "geometry/near_cells.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostPlaces = std::size_t{1} << 20;  // a map that needs more blocks gets none
constexpr std::uint16_t kMostSquared = 169;                // (2 * kFarthest)^2

}  // namespace

/// Squared distances [half edges^2] from the centers of cells to the nearest voxel, at most kMostSquared.
struct DistanceBlocks::Block {
  std::array<std::uint8_t, std::size_t{kEdge} * kEdge * kEdge> squared;
};

namespace {

/// Squared distances in a box of cells around a block. For each cell, a pass finds the minimum of value + squared gap
/// along one axis. kEdge results need kEdge + 2 * kMargin values.
template <std::int32_t kEdge, std::int32_t kMargin>
struct Window {
  static constexpr std::int32_t kAll = kEdge + 2 * kMargin;
  std::uint16_t start[kAll][kAll][kAll];  // by z, y, x: 0 for an occupied cell, otherwise kMostSquared
  std::uint16_t along_x[kAll][kAll][kEdge];
  std::uint16_t along_y[kAll][kEdge][kEdge];

  Window() { std::fill_n(&start[0][0][0], kAll * kAll * kAll, kMostSquared); }

  /// Lowers kEdge values of `to` to those of `from` plus `gap`.
  static void lower(const std::uint16_t* from, std::uint16_t gap, std::uint16_t* to) {
    for (std::int32_t i = 0; i < kEdge; ++i) {
      to[i] = std::min(to[i], static_cast<std::uint16_t>(from[i] + gap));
    }
  }
  void spreadX() {
    for (std::int32_t row = 0; row < kAll * kAll; ++row) {
      std::uint16_t* const to = &along_x[0][0][0] + row * kEdge;
      std::fill_n(to, kEdge, kMostSquared);
      for (std::int32_t step = -kMargin; step <= kMargin; ++step) {
        lower(&start[0][0][0] + row * kAll + kMargin + step, gapSquared(step), to);
      }
    }
  }
  void spreadY() {
    for (std::int32_t z = 0; z < kAll; ++z) {
      for (std::int32_t y = 0; y < kEdge; ++y) {
        std::fill_n(along_y[z][y], kEdge, kMostSquared);
        for (std::int32_t step = -kMargin; step <= kMargin; ++step) {
          lower(along_x[z][y + kMargin + step], gapSquared(step), along_y[z][y]);
        }
      }
    }
  }
  void spreadZ(std::uint8_t* squared) const {
    for (std::int32_t z = 0; z < kEdge; ++z) {
      for (std::int32_t y = 0; y < kEdge; ++y, squared += kEdge) {
        std::uint16_t least[kEdge];
        std::fill_n(least, kEdge, kMostSquared);
        for (std::int32_t step = -kMargin; step <= kMargin; ++step) {
          lower(along_y[z + kMargin + step][y], gapSquared(step), least);
        }
        for (std::int32_t x = 0; x < kEdge; ++x) squared[x] = static_cast<std::uint8_t>(least[x]);
      }
    }
  }
};

}  // namespace

DistanceBlocks::DistanceBlocks(const StaticGrid& grid) : grid_(grid) {
  if (grid.size() == 0) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto keyOf = [&](double at) { return static_cast<std::int32_t>(std::lround(at / grid.finestEdge())); };
    const auto k = static_cast<Eigen::Index>(axis);
    first_cell_[axis] = keyOf(grid.bounds().min()[k]) - kMargin;
    block_counts_[axis] = (keyOf(grid.bounds().max()[k]) + kMargin - first_cell_[axis] + kEdge - 1) / kEdge;
    corner_[k] = first_cell_[axis] * grid.finestEdge();
    cell_counts_[axis] = static_cast<float>(block_counts_[axis] * kEdge);
  }
  if (places() > kMostPlaces) block_counts_ = {};
}

DistanceBlocks::~DistanceBlocks() = default;

/// Computes a block. @returns false if it is far from all voxels
bool DistanceBlocks::fill(const std::array<std::int32_t, 3>& first, Block& block) const {
  using Around = Window<kEdge, kMargin>;
  Eigen::AlignedBox3d box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    box.min()[k] = (first[axis] - kMargin) * edge();
    box.max()[k] = (first[axis] + kEdge + kMargin) * edge();
  }
  std::vector<Voxel> voxels;
  grid_.overlapping(box, grid_.size(), voxels);
  if (voxels.empty()) return false;
  const auto window = std::make_unique<Around>();
  for (const Voxel& voxel : voxels) {
    const std::int32_t along = keysAlong(voxel), keys[]{voxel.x, voxel.y, voxel.z};
    std::int32_t low[3], high[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = keys[axis] - Voxel::kOriginKey - (first[axis] - kMargin);
      high[axis] = std::min(low[axis] + along, Around::kAll);
      low[axis] = std::max(low[axis], 0);
    }
    for (std::int32_t z = low[2]; z < high[2]; ++z) {
      for (std::int32_t y = low[1]; y < high[1]; ++y) {
        for (std::int32_t x = low[0]; x < high[0]; ++x) window->start[z][y][x] = 0;
      }
    }
  }
  window->spreadX();
  window->spreadY();
  window->spreadZ(block.squared.data());
  return true;
}

/// Returns the number of blocks in the box around the voxels.
std::size_t DistanceBlocks::places() const {
  std::size_t places = 1;
  for (const std::int32_t count : block_counts_) places *= static_cast<std::size_t>(count);
  return places;
}

/// Returns the blocks, and allocates the array if it is missing.
std::atomic<const DistanceBlocks::Block*>* DistanceBlocks::table() const {
  std::atomic<const Block*>* known = table_.load(std::memory_order_acquire);
  if (known != nullptr) return known;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!blocks_) blocks_.reset(new std::atomic<const Block*>[places()]());
  table_.store(blocks_.get(), std::memory_order_release);
  return blocks_.get();
}

/// Returns a block, and computes it if it is missing. @returns null if kMostBlocks blocks are kept
const DistanceBlocks::Block* DistanceBlocks::made(std::size_t number) const {
  static const Block kFar = [] {
    Block block{};
    block.squared.fill(kMostSquared);
    return block;
  }();
  const std::lock_guard<std::mutex> lock(mutex_);
  const Block* known = blocks_[number].load(std::memory_order_relaxed);
  if (known != nullptr || full_) return known;
  std::array<std::int32_t, 3> first;
  std::size_t rest = number;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<std::size_t>(block_counts_[axis]);
    first[axis] = first_cell_[axis] + kEdge * static_cast<std::int32_t>(rest % count);
    rest /= count;
  }
  auto block = std::make_unique<Block>();
  if (fill(first, *block)) {
    made_.push_back(std::move(block));
    known = made_.back().get();
    full_ = made_.size() == kMostBlocks;
  } else {
    known = &kFar;
  }
  blocks_[number].store(known, std::memory_order_release);
  return known;
}

Four DistanceBlocks::lowerBounds(const Four (&points)[3]) const {
  if (block_counts_[0] == 0) return allFour(isKnown() ? kFarthest : 0.0f);
  std::atomic<const Block*>* const blocks = table();
  const NearCells cells(points, cell_counts_);
  Four squared;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const std::int32_t x = cells.along(0)[lane], y = cells.along(1)[lane], z = cells.along(2)[lane];
    const auto number =
        static_cast<std::size_t>(((z / kEdge) * block_counts_[1] + y / kEdge) * block_counts_[0] + x / kEdge);
    const Block* block = blocks[number].load(std::memory_order_acquire);
    if (block == nullptr && !full_.load(std::memory_order_relaxed)) block = made(number);
    const auto cell = static_cast<std::size_t>((z % kEdge * kEdge + y % kEdge) * kEdge + x % kEdge);
    squared[lane] = block == nullptr ? 0.0f : static_cast<float>(block->squared[cell]);
  }
  return cells.lowerBounds(squareRoot(squared) * 0.5f);
}

}  // namespace hgrid
