// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/layer.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "broadphase/hgrid/array_room.h"
#include "geometry/infinity.h"

namespace hgrid {
namespace {

constexpr std::size_t kUsualLevels = 3;                              // most plans of one region have no more levels
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();  // every comparison with it is false

static_assert(sizeof(Aabb) == sizeof(kernels::Box), "kernels read a box as six floats");
static_assert(sizeof(ProxyPair) == sizeof(kernels::Pair), "kernels write a pair as two numbers");

/// Returns the index of the cell that contains the minimum corner of a box.
std::int32_t cellOf(const kernels::Grid& grid, const Aabb& box) {
  std::int32_t cell = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float number = box.min[axis] * grid.inverse[axis] - grid.origin[axis];
    cell += grid.steps[axis] * static_cast<std::int32_t>(std::min(number > 0.0f ? number : 0.0f, grid.last[axis]));
  }
  return cell;
}

}  // namespace

void Layer::setIds(const std::vector<ProxyId>& ids) { std::copy(ids.begin(), ids.end(), setIds(ids.size())); }

ProxyId* Layer::setIds(std::size_t count) {
  count_ = count;
  return ids_.data();
}

/// Moves the six arrays farther apart, so that each has room for `count` boxes.
void Layer::widen(std::size_t count) {
  std::size_t stride = (count + (bounds_.empty() ? 0 : count / 16) + 2 * kReadBeyond) / 16 * 16;
  // The distance of the arrays must not be near a multiple of a memory page, because then the six coordinates of a box
  // would compete for one set of the cache.
  if (stride >= 1024 && stride % 1024 < 64) stride += 160;
  std::vector<float> bounds(6 * stride);
  for (std::size_t i = 0; i < 6 && count_ > 0; ++i) {
    std::copy_n(bounds_.data() + i * stride_, count_, bounds.data() + i * stride);
  }
  bounds_.swap(bounds);
  stride_ = stride;
}

void Layer::reserve(std::size_t count, std::size_t ids, const Machine& machine) {
  if (count == 0 || (count <= kFew && stride_ > 0)) return;  // the first call makes room for kFew boxes
  count = std::max(count, kFew);
  SortScratch& scratch = *machine.scratch;
  const std::size_t threads = machine.threadsFor(count);
  if (ids >= kWorthCopying) growTo(scratch.copies, count);
  growTo(scratch.cells, count);
  growTo(scratch.counts, (threads - 1) * plan_.cells());
  scratch.sizes.reserve(threads * 4 * std::max(CellPlan::kMostLevels, plan_.levels()));
  if (plan_.isDivided()) scratch.corners.reserve(threads * 8 * plan_.levels());
  scratch.keyings.reserve(threads);
  scratch.sums.reserve(threads * threads);
  reservePlan(count, std::min(count, kUsualLevels), machine);
  box_bounds_.reserveBoxes(count);
  extendTo(other_ids_, count + kReadBeyond);
  if (extendTo(ids_, count + kReadBeyond)) point();
  if (count + kReadBeyond > stride_) {
    widen(count);
    point();
  }
}

/// Allocates the memory for a plan with one region and this number of levels.
void Layer::reservePlan(std::size_t count, std::size_t levels, const Machine& machine) {
  const std::size_t cells = CellPlan::mostCells(count, levels);
  plan_.reserve(levels);
  levels_.reserve(levels);
  level_bounds_.reserveLevels(levels);
  growTo(machine.scratch->counts, (machine.threadsFor(count) - 1) * cells);
  if (extendTo(start_, cells + 1)) point();
}

/// Sets the pointers of the levels to the arrays.
void Layer::point() {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    kernels::Level& level = levels_[i];
    level.bounds = bounds_.data();
    level.stride = stride_;
    level.id = ids_.data();
    level.start = start_.data() + plan_.firstCells()[i];
  }
}

void Layer::withdraw(std::uint32_t position) {
  ++withdrawn_;
  // The minimum corner remains, because pairsWithin() computes the row of the position from it. If the minimum corner
  // changed, pairsWithin() would search beyond that row.
  for (std::size_t axis = 3; axis < 6; ++axis) bounds_[axis * stride_ + position] = kNothing;
}

bool Layer::putBack(std::uint32_t position, const Aabb& box) {
  if (!isWithdrawn(position) || !fits(position, box)) return false;
  --withdrawn_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bounds_[axis * stride_ + position] = box.min[static_cast<int>(axis)];
    bounds_[(axis + 3) * stride_ + position] = box.max[static_cast<int>(axis)];
  }
  return true;
}

/// Returns whether a position can hold a box with these coordinates: whether the box belongs to the cell and the region
/// of the position, and the bounds that were computed by the last sort contain it.
bool Layer::fits(std::uint32_t position, const Aabb& box) const {
  const auto begins_later = [](std::uint32_t place, const kernels::Level& level) { return place < level.begin; };
  const auto next = std::upper_bound(levels_.begin(), levels_.end(), position, begins_later);
  const auto number = static_cast<std::size_t>(next - levels_.begin()) - 1;
  const kernels::Level& level = levels_[number];
  // A side that was rounded to the reach may be longer.
  if (!((box.max - box.min).array() < Eigen::Map<const Eigen::Array3f>(level.reach)).all()) return false;
  if (!contains(level.around, box)) return false;
  if (isOneRow() && !isFew() && !contains(box_bounds_.leaf(position / BoundsTree::kPerLeaf), box)) return false;
  const std::int32_t cell = cellOf(level.grid, box);
  if (position < level.start[cell] || position >= level.start[cell + 1]) return false;
  if (!isDivided()) return true;
  const kernels::Region& region = regions().region(regions().regionOf(box.min.data()));
  return number >= region.first_level && number < region.first_level + region.levels;
}

std::size_t Layer::bytes() const {
  return (ids_.capacity() + other_ids_.capacity() + start_.capacity()) * sizeof(std::uint32_t) +
         bounds_.capacity() * sizeof(float) + levels_.capacity() * sizeof(kernels::Level) + level_bounds_.bytes() +
         box_bounds_.bytes() + occupancy_.bytes() + plan_.bytes();
}

void Layer::checkInvariants(const std::vector<Aabb>& boxes) const {
  const auto require = [](bool holds, const char* invariant) {
    if (!holds) throw std::logic_error(std::string("HGrid: this invariant is violated: ") + invariant);
  };
  std::uint32_t position = 0;
  for (const kernels::Level& level : levels_) {
    require(level.begin == position, "each level begins where the level before it ends");
    const auto slabs = static_cast<std::int32_t>(level.grid.last[level.grid.axes[2]]) + 1;
    const std::int32_t cells = level.grid.slab * slabs;
    for (std::int32_t cell = 0; cell < cells; ++cell) {
      require(level.start[cell] == position && level.start[cell + 1] >= position,
              "each cell begins where the one before it ends");
      for (; position < level.start[cell + 1]; ++position) {
        if (isWithdrawn(position)) continue;
        const Aabb& box = boxes[ids_[position]];
        for (int axis = 0; axis < 3; ++axis) {
          const auto i = static_cast<std::size_t>(axis);
          require(bounds_[i * stride_ + position] == box.min[axis] &&
                      bounds_[(i + 3) * stride_ + position] == box.max[axis],
                  "the layer holds the current coordinates of its boxes");
          require(box.max[axis] - box.min[axis] < level.reach[axis] || level.reach[axis] == kFloatInfinity,
                  "no box is longer than the reach of its level, even if its side was rounded down");
        }
        if (isDivided()) {
          const kernels::Region& region = regions().region(regions().regionOf(box.min.data()));
          const auto number_of_level = static_cast<std::size_t>(&level - levels_.data());
          require(number_of_level >= region.first_level && number_of_level < region.first_level + region.levels,
                  "a box is stored in the region that contains its minimum corner");
        }
        for (int axis = 0; axis < 3; ++axis) {
          require(level.around.min[axis] <= box.min[axis] && box.max[axis] <= level.around.max[axis],
                  "a box is within the bounds of its level");
        }
        require(cell == cellOf(level.grid, box), "a box is stored in the cell that contains its minimum corner");
      }
    }
    require(level.end == position, "a level ends where its last cell ends");
  }
  require(position == count_, "every box has a position");
  if (isOneRow()) checkBoxBounds();
}

/// Requires that each box is within the bounds of its leaf.
void Layer::checkBoxBounds() const {
  const auto check = [this](std::uint32_t leaf, const kernels::Box& bounds) {
    const std::uint32_t begin = leaf * BoundsTree::kPerLeaf, end = begin + BoundsTree::kPerLeaf;
    for (std::uint32_t i = begin; i < std::min(end, static_cast<std::uint32_t>(count_)); ++i) {
      const Aabb box = boxAt(i);
      if (!isWithdrawn(i) && !contains(bounds, box))
        throw std::logic_error("HGrid: this invariant is violated: a box is within the bounds of its leaf");
    }
  };
  bounds().visit([](const kernels::Box&) { return true; }, check);
}

}  // namespace hgrid
