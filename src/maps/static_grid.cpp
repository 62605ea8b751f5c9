// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/maps/static_grid.h"

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/refusal.h"
#include "maps/brick.h"
#include "maps/static_grid_bricks.h"

namespace hgrid {
namespace {

/// Builds bricks from voxels in Morton order. The bricks that contain the last voxel stay open: later voxels may add
/// cells to them. All other bricks are complete.
class Builder {
 public:
  explicit Builder(Bricks& bricks) : bricks_(bricks) {}

  void add(const Voxel& voxel, std::size_t number) {
    const std::uint64_t code = mortonOf(voxel), after = code + (std::uint64_t{1} << 3 * voxel.level);
    const bool sound = voxel.level <= Voxel::kLevels && code % (std::uint64_t{1} << 3 * voxel.level) == 0;
    if (!sound || code < end_) refuse(voxel, number, sound);
    // Close the open bricks that end before this voxel.
    const int level = std::min(voxel.level / 2, kBrickLevels - 1);
    for (int open = 0; open < kBrickLevels - 1; ++open) {
      if (open >= level && (code ^ last_) >> 6 * (open + 1) == 0) break;  // this and all larger bricks contain `voxel`
      close(open);
    }
    last_ = code;
    end_ = after;
    set(voxel, code, level);
  }

  void finish() {
    for (int open = 0; open < kBrickLevels; ++open) close(open);
    BrickLevel& top = bricks_.levels.back();
    if (!top.cells.empty()) return;
    top.cells.push_back(0);  // there are no voxels: store an empty root brick
    top.full.push_back(0);
    top.first_below.push_back(0);
    top.blocks.push_back(0);
  }

 private:
  struct Open {
    std::uint64_t cells = 0, full = 0;
    std::uint32_t first_below = 0;
    std::uint8_t blocks = 0;
  };

  [[noreturn]] static void refuse(const Voxel& voxel, std::size_t number, bool sound) {
    throw Refusal(Code::bad_geometry,
                  "voxel " + std::to_string(number) + " (keys " + std::to_string(voxel.x) + ", " +
                      std::to_string(voxel.y) + ", " + std::to_string(voxel.z) + ", level " +
                      std::to_string(voxel.level) +
                      (sound ? ") begins before the previous voxel ends; voxels must be "
                               "disjoint and in Morton order"
                             : ") is not valid; keys must be multiples of the edge, and the level at most 16"));
  }

  void set(const Voxel& voxel, std::uint64_t code, int level) {
    Open& brick = open_[static_cast<std::size_t>(level)];
    const unsigned cell = static_cast<unsigned>(code >> 6 * level) & 63u;
    std::uint64_t cells = std::uint64_t{1} << cell;
    if (voxel.level == Voxel::kLevels) {
      cells = ~std::uint64_t{0};
      brick.blocks = 0xff;
      bricks_.is_whole = true;
    } else if (voxel.level % 2 == 1) {
      cells = std::uint64_t{0xff} << cell;
      brick.blocks = static_cast<std::uint8_t>(brick.blocks | 1u << cell / 8);
    }
    if (brick.cells == 0) begin(level);
    brick.cells |= cells;
    brick.full |= cells;
    for (int above = level + 1; above < kBrickLevels; ++above) {
      Open& outer = open_[static_cast<std::size_t>(above)];
      const std::uint64_t part = std::uint64_t{1} << (code >> 6 * above & 63u);
      if ((outer.cells & part) != 0) break;  // then the bits in all larger bricks are already set, too
      if (outer.cells == 0) begin(above);
      outer.cells |= part;
    }
  }

  /// Opens the brick of a level and notes the index of the first brick below it. All bricks of the level below that
  /// are added until close() are inside this brick.
  void begin(int level) {
    if (level == 0) return;
    const std::size_t below = bricks_.levels[static_cast<std::size_t>(level) - 1].cells.size();
    open_[static_cast<std::size_t>(level)].first_below = static_cast<std::uint32_t>(below);
  }

  /// Stores the open brick of a level, if it is not empty.
  void close(int number) {
    Open& brick = open_[static_cast<std::size_t>(number)];
    if (brick.cells == 0) return;
    BrickLevel& level = bricks_.levels[static_cast<std::size_t>(number)];
    level.cells.push_back(brick.cells);
    level.blocks.push_back(brick.blocks);
    if (number > 0) {
      level.full.push_back(brick.full);
      level.first_below.push_back(brick.first_below);
    }
    brick = Open{};
  }

  Bricks& bricks_;
  std::array<Open, kBrickLevels> open_;
  std::uint64_t last_ = 0, end_ = 0;
};

}  // namespace

StaticGrid::StaticGrid(double finest_edge, const std::vector<Voxel>& voxels)
    : finest_edge_(finest_edge), size_(voxels.size()) {
  if (!(finest_edge > 0.0 && std::isfinite(finest_edge))) {
    throw Refusal(Code::out_of_range, "the finest edge is " + text(finest_edge) + " m; it must be greater than 0");
  }
  auto bricks = std::make_shared<Bricks>();
  Builder builder(*bricks);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    builder.add(voxels[i], i);
    bounds_.extend(minCorner(voxels[i], finest_edge));
    bounds_.extend(maxCorner(voxels[i], finest_edge));
  }
  builder.finish();
  Brick& start = bricks->start;
  while (start.level > 0 && bitCount(bricks->cellsOf(start)) == 1 && bricks->fullOf(start) == 0) {
    start = bricks->below(start, firstCell(bricks->cellsOf(start)));
  }
  for (BrickLevel& level : bricks->levels) {
    level.cells.shrink_to_fit();
    level.full.shrink_to_fit();
    level.first_below.shrink_to_fit();
    level.blocks.shrink_to_fit();
  }
  bricks_ = std::move(bricks);
}

std::size_t StaticGrid::bytes() const {
  std::size_t bytes = sizeof(*this) + sizeof(Bricks);
  for (const BrickLevel& level : bricks_->levels) {
    bytes += 8 * (level.cells.capacity() + level.full.capacity()) + 4 * level.first_below.capacity() +
             level.blocks.capacity();
  }
  return bytes;
}

}  // namespace hgrid
