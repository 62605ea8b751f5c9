// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/hgrid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hgrid {
namespace {

constexpr std::int32_t kFarthestCell = std::int32_t{1} << 30;  // so that a neighbour's number cannot overflow

/// Number of the cell that holds a coordinate, clamped to ±kFarthestCell. The one function for boxes and
/// queries alike. Edges are powers of two, so the quotient is exact; floor and clamp are monotone, so
/// intervals that overlap have cell ranges that overlap.
std::int32_t cellOf(double coordinate, double edge) {
  const double cell = std::floor(coordinate / edge);  // not a cast: -0.1 m lies in cell -1
  const double limit = kFarthestCell;
  return static_cast<std::int32_t>(std::clamp(cell, -limit, limit));
}

std::uint64_t mixed(std::uint64_t value) {  // finaliser of SplitMix64 (Steele, Lea, Flood 2014)
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ull;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebull;
  return value ^ (value >> 31);
}

void requireValid(const Aabb& box) {
  if (!isValid(box)) throw std::invalid_argument("HGrid: a box is not finite or has min > max");
}

}  // namespace

GridScale GridScale::fitting(const std::vector<Aabb>& boxes) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Aabb& box : boxes) {
    const double side = (box.max.cast<double>() - box.min.cast<double>()).maxCoeff();
    if (side > 0.0) smallest = std::min(smallest, side);
  }
  GridScale scale;
  scale.finest_edge = std::isfinite(smallest) ? std::clamp(2.0 * smallest, 0x1p-20, 0x1p10) : 1.0;
  return scale;
}

std::size_t HGrid::CellHash::operator()(const Cell& cell) const {
  std::uint64_t hash = seed;
  for (const std::int32_t number : cell)
    hash = mixed(hash + 0x9e3779b97f4a7c15ull + static_cast<std::uint32_t>(number));
  return static_cast<std::size_t>(hash);
}

HGrid::HGrid(const GridScale& scale, std::uint64_t seed) {
  if (!(scale.finest_edge >= 0x1p-30 && scale.finest_edge <= 0x1p30)) {
    throw std::invalid_argument("HGrid: the finest edge is " + std::to_string(scale.finest_edge) +
                                " m; it must be within 2^-30 .. 2^30");
  }
  double edge = std::ldexp(1.0, std::ilogb(scale.finest_edge));
  for (Level& level : levels_) {
    level.edge = edge;
    level.cells = CellMap(0, CellHash{seed});
    edge *= GridScale::kRatio;
  }
}

int HGrid::levelFor(const Aabb& box) const {
  const double side = (box.max.cast<double>() - box.min.cast<double>()).maxCoeff();
  for (int number = 0; number < GridScale::kLevels; ++number) {
    const double edge = levels_[static_cast<std::size_t>(number)].edge;
    if (side > edge) continue;
    bool fits = true;
    for (int axis = 0; axis < 3 && fits; ++axis) {
      const std::int32_t low = cellOf(box.min[axis], edge), high = cellOf(box.max[axis], edge);
      // Counted in cells, since the side may have been rounded; the outermost cells are the clamped ones.
      fits = high - low <= 1 && low > -kFarthestCell && high < kFarthestCell;
    }
    if (fits) return number;
  }
  return kOversize;
}

HGrid::Members& HGrid::membersOf(const Entry& entry) {
  if (entry.level == kOversize) return oversize_;
  return levels_[static_cast<std::size_t>(entry.level)].cells[entry.cell];
}

const HGrid::Members& HGrid::membersOf(const Entry& entry) const {
  if (entry.level == kOversize) return oversize_;
  return levels_[static_cast<std::size_t>(entry.level)].cells.at(entry.cell);
}

void HGrid::place(ProxyId id, const Aabb& box) {
  if (id >= entries_.size()) entries_.resize(id + std::size_t{1});
  Entry& entry = entries_[id];
  entry.box = box;
  entry.level = levelFor(box);
  if (entry.level != kOversize) {
    Level& level = levels_[static_cast<std::size_t>(entry.level)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      entry.cell[axis] = cellOf(box.min[static_cast<Eigen::Index>(axis)], level.edge);
    }
    if (level.count++ == 0) occupied_ |= 1u << entry.level;
  }
  Members& members = membersOf(entry);
  entry.position = static_cast<std::uint32_t>(members.size());
  members.push_back(id);
  ++size_;
}

void HGrid::withdraw(ProxyId id) {
  Entry& entry = entries_[id];
  Members& members = membersOf(entry);
  members[entry.position] = members.back();
  entries_[members.back()].position = entry.position;
  members.pop_back();
  if (entry.level != kOversize) {
    Level& level = levels_[static_cast<std::size_t>(entry.level)];
    if (members.empty()) level.cells.erase(entry.cell);
    if (--level.count == 0) occupied_ &= ~(1u << entry.level);
  }
  entry.level = kAbsent;
  --size_;
}

void HGrid::insert(ProxyId id, const Aabb& box) {
  requireValid(box);
  if (isStored(id)) throw std::invalid_argument("HGrid: box " + std::to_string(id) + " is stored already");
  place(id, box);
}

void HGrid::update(ProxyId id, const Aabb& box) {
  requireValid(box);
  if (!isStored(id)) throw std::invalid_argument("HGrid: box " + std::to_string(id) + " is not stored");
  if (entries_[id].box == box) return;  // bit by bit the same: never a tolerance
  withdraw(id);
  place(id, box);
}

void HGrid::remove(ProxyId id) {
  if (!isStored(id)) throw std::invalid_argument("HGrid: box " + std::to_string(id) + " is not stored");
  withdraw(id);
}

void HGrid::clear() {
  for (Level& level : levels_) {
    level.cells.clear();
    level.count = 0;
  }
  entries_.clear();
  oversize_.clear();
  occupied_ = 0;
  size_ = 0;
}

void HGrid::update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  if (ids.size() != boxes.size()) throw std::invalid_argument("HGrid: as many ids as boxes are needed");
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (i > 0 && ids[i] <= ids[i - 1]) throw std::invalid_argument("HGrid: ids must ascend");
    requireValid(boxes[i]);
  }
  std::size_t next = 0;
  for (ProxyId id = 0; id < entries_.size(); ++id) {  // what is not listed goes
    if (next < ids.size() && ids[next] == id) {
      ++next;
    } else if (isStored(id)) {
      withdraw(id);
    }
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (isStored(ids[i])) {
      update(ids[i], boxes[i]);
    } else {
      place(ids[i], boxes[i]);
    }
  }
}

/// Cells of a level whose members may overlap the box from `min` to `max`: members reach at most into the
/// cell after their own, so those one before the box's first cell count too.
HGrid::Range HGrid::reachOf(const Level& level, const Eigen::Vector3d& min, const Eigen::Vector3d& max) const {
  Range range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    range.low[axis] = cellOf(min[static_cast<Eigen::Index>(axis)], level.edge) - 1;
    range.high[axis] = cellOf(max[static_cast<Eigen::Index>(axis)], level.edge);
  }
  return range;
}

template <class Visit>
void HGrid::visitAll(const Level& level, Visit&& visit) const {
  for (const auto& cell : level.cells) {
    for (const ProxyId id : cell.second) visit(id);
  }
}

template <class Visit>
void HGrid::visitRange(const Level& level, const Range& range, Visit&& visit) const {
  double cells = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) cells *= 1.0 + (static_cast<double>(range.high[axis]) - range.low[axis]);
  if (cells > static_cast<double>(level.cells.size())) return visitAll(level, visit);  // fewer to look at
  Cell cell;
  for (cell[0] = range.low[0]; cell[0] <= range.high[0]; ++cell[0]) {
    for (cell[1] = range.low[1]; cell[1] <= range.high[1]; ++cell[1]) {
      for (cell[2] = range.low[2]; cell[2] <= range.high[2]; ++cell[2]) {
        const auto found = level.cells.find(cell);
        if (found == level.cells.end()) continue;
        for (const ProxyId id : found->second) visit(id);
      }
    }
  }
}

/// Visits every box on the levels of the mask that may overlap the box from `min` to `max`, and the oversize ones.
template <class Visit>
void HGrid::visitNear(const Eigen::Vector3d& min, const Eigen::Vector3d& max, std::uint32_t levels,
                      Visit&& visit) const {
  for (std::size_t number = 0; number < levels_.size(); ++number) {
    if ((occupied_ & levels) >> number & 1u) visitRange(levels_[number], reachOf(levels_[number], min, max), visit);
  }
  for (const ProxyId id : oversize_) visit(id);
}

void HGrid::overlappingPairs(std::vector<ProxyPair>& pairs) const {
  pairs.clear();
  for (ProxyId id = 0; id < entries_.size(); ++id) {
    const Entry& entry = entries_[id];
    if (entry.level == kAbsent) continue;
    // Each box looks from its own level up, so that a pair on two levels is met once, from the finer side;
    // two on one level meet each other twice, and the smaller id counts.
    const std::uint32_t own_and_coarser = entry.level == kOversize ? 0u : ~0u << entry.level;
    visitNear(entry.box.min.cast<double>(), entry.box.max.cast<double>(), own_and_coarser, [&](ProxyId other) {
      if (entries_[other].level == entry.level && other <= id) return;
      if (!overlap(entry.box, entries_[other].box)) return;
      pairs.push_back({std::min(id, other), std::max(id, other)});
    });
  }
}

void HGrid::overlapping(const Aabb& box, std::vector<ProxyId>& found) const {
  found.clear();
  visitNear(box.min.cast<double>(), box.max.cast<double>(), ~0u, [&](ProxyId id) {
    if (overlap(box, entries_[id].box)) found.push_back(id);
  });
  std::sort(found.begin(), found.end());
}

void HGrid::overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const {
  found.clear();
  const double reach = sphere.center.cwiseAbs().maxCoeff() + sphere.radius;
  const Eigen::Array3d half = Eigen::Array3d::Constant(sphere.radius + 2.0 * roundingSlack(reach));
  visitNear(sphere.center.array() - half, sphere.center.array() + half, ~0u, [&](ProxyId id) {
    if (touches(sphere, entries_[id].box)) found.push_back(id);
  });
  std::sort(found.begin(), found.end());
}

/// Ranges of cells whose members the segment may meet, one per slab of cells across its longest axis
/// (after Ericson 2005, section 7.4.2, but from each slab's exact interval with outward rounding instead of
/// accumulated steps, so that errors do not add up). False if they are more than the occupied cells.
bool HGrid::slabsAlong(const Level& level, const Segment& segment, std::vector<Range>& slabs) const {
  slabs.clear();
  const Eigen::Vector3d step = segment.to - segment.from;
  Eigen::Index major = 0;
  step.cwiseAbs().maxCoeff(&major);
  const double reach = std::max(segment.from.cwiseAbs().maxCoeff(), segment.to.cwiseAbs().maxCoeff()) + segment.radius;
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(segment.radius + 4.0 * roundingSlack(reach));
  const Range whole =
      reachOf(level, segment.from.cwiseMin(segment.to) - around, segment.from.cwiseMax(segment.to) + around);
  const auto axis = static_cast<std::size_t>(major);

  double budget = static_cast<double>(level.cells.size());
  if (static_cast<double>(whole.high[axis]) - whole.low[axis] + 1.0 > budget) return false;
  for (std::int32_t slab = whole.low[axis]; slab <= whole.high[axis]; ++slab) {
    // Members of this slab lie between its lower face and the upper face of the next one.
    double enter = 0.0, leave = 1.0;
    if (step[major] != 0.0) {
      const double a = (slab * level.edge - around[major] - segment.from[major]) / step[major];
      const double b = ((slab + 2.0) * level.edge + around[major] - segment.from[major]) / step[major];
      enter = std::clamp(std::min(a, b), 0.0, 1.0);
      leave = std::clamp(std::max(a, b), 0.0, 1.0);
    }
    const Eigen::Vector3d p = segment.from + enter * step, q = segment.from + leave * step;
    Range range = reachOf(level, p.cwiseMin(q) - around, p.cwiseMax(q) + around);
    range.low[axis] = range.high[axis] = slab;
    double cells = 1.0;
    for (std::size_t i = 0; i < 3; ++i) cells *= 1.0 + (static_cast<double>(range.high[i]) - range.low[i]);
    if ((budget -= cells) < 0.0) return false;
    slabs.push_back(range);
  }
  return true;
}

void HGrid::along(const Segment& segment, std::vector<SegmentHit>& found) const {
  found.clear();
  const auto visit = [&](ProxyId id) {
    if (const auto meeting = meet(segment, entries_[id].box)) found.push_back({id, meeting->along});
  };
  std::vector<Range> slabs;
  for (std::size_t number = 0; number < levels_.size(); ++number) {
    if (!(occupied_ >> number & 1u)) continue;
    const Level& level = levels_[number];
    if (slabsAlong(level, segment, slabs)) {
      for (const Range& slab : slabs) visitRange(level, slab, visit);
    } else {
      visitAll(level, visit);
    }
  }
  for (const ProxyId id : oversize_) visit(id);
  std::sort(found.begin(), found.end(), [](const SegmentHit& a, const SegmentHit& b) {
    return a.along != b.along ? a.along < b.along : a.id < b.id;
  });
}

std::size_t HGrid::count(int level) const {
  return level == kOversize ? oversize_.size() : levels_.at(static_cast<std::size_t>(level)).count;
}

void HGrid::checkInvariants() const {
  const auto require = [](bool holds, const char* promise) {
    if (!holds) throw std::logic_error(std::string("HGrid: ") + promise);
  };
  std::size_t stored = 0;
  std::array<std::size_t, GridScale::kLevels + 1> counts{};
  for (ProxyId id = 0; id < entries_.size(); ++id) {
    const Entry& entry = entries_[id];
    if (entry.level == kAbsent) continue;
    ++stored;
    ++counts[static_cast<std::size_t>(entry.level)];
    require(isValid(entry.box), "a stored box is valid");
    require(entry.level == levelFor(entry.box), "a box lives on the level that fits it");
    if (entry.level != kOversize) {
      const Level& level = levels_[static_cast<std::size_t>(entry.level)];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        require(entry.cell[axis] == cellOf(entry.box.min[static_cast<Eigen::Index>(axis)], level.edge),
                "a box lives in the cell of its minimum corner");
      }
      require(level.cells.count(entry.cell) == 1, "the cell of a stored box exists");
    }
    const Members& members = membersOf(entry);
    require(entry.position < members.size() && members[entry.position] == id, "a box knows its place in its cell");
  }
  require(stored == size_, "size() counts the stored boxes");
  require(oversize_.size() == counts[kOversize], "the oversize list holds the oversize boxes only");
  for (std::size_t number = 0; number < levels_.size(); ++number) {
    const Level& level = levels_[number];
    std::size_t members = 0;
    for (const auto& cell : level.cells) {
      require(!cell.second.empty(), "no cell is empty");
      members += cell.second.size();
    }
    require(level.count == counts[number] && members == counts[number], "a level counts its boxes");
    require((occupied_ >> number & 1u) == (counts[number] > 0 ? 1u : 0u), "the mask says which levels are occupied");
  }
}

}  // namespace hgrid
