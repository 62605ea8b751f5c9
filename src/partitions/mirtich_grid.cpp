// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/mirtich_grid.h"

#include <cmath>
#include <set>

#include "partitions/stamps.h"

namespace hgrid {
namespace book {
namespace {

constexpr int kFinest = -20;  // exponent of the finest level: it has boxes up to 2^-20 m (about 1 um), and points

}  // namespace

/// The exponent of the smallest cell edge that is at least as long as the longest side of the box.
int MirtichGrid::exponentOf(const Aabb& box) {
  const double side = longestSideInDouble(box);
  if (!(side > std::ldexp(1.0, kFinest))) return kFinest;
  int exponent;
  const double fraction = std::frexp(side, &exponent);  // side = fraction * 2^exponent, 0.5 <= fraction < 1
  return fraction == 0.5 ? exponent - 1 : exponent;
}

/// Index of the first level that is at least as coarse as an exponent.
std::size_t MirtichGrid::firstLevelOf(int exponent) const {
  std::size_t index = 0;
  while (index < levels_.size() && levels_[index].exponent < exponent) ++index;
  return index;
}

// ---- counters

/// Changes the counters of a box and the other boxes of a cell by 1, because the box enters (`up`) or leaves the cell.
///
/// Two visitors of a cell are not counted: the level is coarser than both of theirs. They are counted on the coarser of
/// their own levels, where one of them is a resident.
void MirtichGrid::count(ProxyId id, const CellBoxes& cell, bool resident, bool up) {
  const auto count_with = [&](ProxyId other) {
    if (isFixed(id) && isFixed(other)) return;
    up ? close_.raise(id, other) : close_.lower(id, other);
  };
  for (const ProxyId other : cell.residents) count_with(other);
  if (!resident) return;
  for (const ProxyId other : cell.visitors) count_with(other);
}

/// Adds a box to a cell and counts its close pairs there.
void MirtichGrid::enter(Level& level, const Cell& cell, ProxyId id, bool resident) {
  CellBoxes& here = level.cells[cell];
  count(id, here, resident, true);
  (resident ? here.residents : here.visitors).push_back(id);
}

/// Removes a box from a cell and undoes what enter() counted. Drops the cell if it becomes empty.
void MirtichGrid::leave(Level& level, const Cell& cell, ProxyId id, bool resident) {
  const auto place = level.cells.find(cell);
  CellBoxes& here = place->second;
  eraseUnordered(resident ? here.residents : here.visitors, id);
  count(id, here, resident, false);
  if (here.residents.empty() && here.visitors.empty()) level.cells.erase(place);
}

// ---- changes

void MirtichGrid::build() {
  const std::vector<ProxyId> ids = storedIds();
  std::set<int> exponents;
  for (const ProxyId id : ids) exponents.insert(exponentOf(box(id)));
  levels_.clear();
  for (const int exponent : exponents) levels_.push_back({exponent, CellScale(std::ldexp(1.0, exponent)), {}, {}});
  close_.clear(mostTrackedPairs());
  for (const ProxyId id : ids) added(id);
}

Partition::Followed MirtichGrid::added(ProxyId id) {
  const int exponent = exponentOf(box(id));
  const std::size_t own = firstLevelOf(exponent);
  if (own == levels_.size() || levels_[own].exponent != exponent)
    return Followed::no;  // there is no such level; all boxes of finer levels would have to visit it
  levels_[own].residents.add(id);
  for (std::size_t index = own; index < levels_.size(); ++index) {
    Level& level = levels_[index];
    level.scale.cellsOf(box(id)).visit([&](const Cell& cell) { enter(level, cell, id, index == own); });
  }
  return Followed::yes;
}

Partition::Followed MirtichGrid::removed(ProxyId id, const Aabb& from) {
  const std::size_t own = firstLevelOf(exponentOf(from));
  levels_[own].residents.remove(id);
  for (std::size_t index = own; index < levels_.size(); ++index) {
    Level& level = levels_[index];
    level.scale.cellsOf(from).visit([&](const Cell& cell) { leave(level, cell, id, index == own); });
  }
  return Followed::yes;
}

Partition::Followed MirtichGrid::moved(ProxyId id, const Aabb& from) {
  const int exponent = exponentOf(from);
  if (exponent != exponentOf(box(id))) return Partition::moved(id, from);
  const std::size_t own = firstLevelOf(exponent);
  for (std::size_t index = own; index < levels_.size(); ++index) {
    Level& level = levels_[index];
    const CellRange before = level.scale.cellsOf(from), now = level.scale.cellsOf(box(id));
    if (before == now) continue;  // as in most moves on a coarse level
    before.visit([&](const Cell& cell) {
      if (!now.contains(cell)) leave(level, cell, id, index == own);
    });
    now.visit([&](const Cell& cell) {
      if (!before.contains(cell)) enter(level, cell, id, index == own);
    });
  }
  return Followed::yes;
}

// ---- searches

void MirtichGrid::findPairs(PairSink& sink) const {
  if (!close_.isComplete()) return findPairsByQueries(sink);
  close_.visit([&](ProxyId a, ProxyId b) { sink.tryPair(a, b); });
}

void MirtichGrid::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  thread_local Stamps seen;  // the boxes that this query has met
  seen.begin(idEnd());
  const auto consider = [&](ProxyId id) {
    if (overlap(shape.bounds(), box(id)) && seen.mark(id)) found.push_back(id);
  };
  for (const Level& level : levels_) {
    const auto limit = static_cast<double>(level.residents.size());
    // If the shape overlaps more cells than the level has residents, looking at all residents is faster.
    const bool all = level.scale.visitRanges(shape, CellScale::everywhere(), limit, [&](const CellRange& range) {
      range.visit([&](const Cell& cell) {
        const auto here = level.cells.find(cell);
        if (here == level.cells.end()) return;
        for (const ProxyId id : here->second.residents) consider(id);
      });
    });
    if (!all) {
      for (const ProxyId id : level.residents) consider(id);
    }
  }
}

void MirtichGrid::checkStructure() const {
  std::size_t residents = 0, entries = 0, expected = 0;
  PairCounts close;
  const auto countTogether = [&](ProxyId a, ProxyId b) {
    if (close_.isComplete() && !(isFixed(a) && isFixed(b))) close.raise(a, b);
  };
  for (const Level& level : levels_) {
    residents += level.residents.size();
    for (const auto& one : level.cells) {
      const std::vector<ProxyId>&mine = one.second.residents, &others = one.second.visitors;
      entries += mine.size() + others.size();
      require(!mine.empty() || !others.empty(), "an empty cell is not stored");
      for (std::size_t i = 0; i < mine.size(); ++i) {
        require(level.residents.contains(mine[i]), "a resident of a cell is a resident of the level");
        require(exponentOf(box(mine[i])) == level.exponent, "the size of a box selects its level");
        require(level.scale.cellsOf(box(mine[i])).contains(one.first), "a box overlaps the cell that holds it");
        for (std::size_t k = i + 1; k < mine.size(); ++k) countTogether(mine[i], mine[k]);
        for (const ProxyId other : others) countTogether(mine[i], other);
      }
    }
  }
  for (const ProxyId id : storedIds()) {
    for (std::size_t index = firstLevelOf(exponentOf(box(id))); index < levels_.size(); ++index)
      expected += static_cast<std::size_t>(levels_[index].scale.cellsOf(box(id)).count());
  }
  require(residents == size(), "each box is a resident of one level");
  require(entries == expected, "each box is in all cells that it overlaps on its own level and on coarser levels");
  require(close.size() == close_.size(), "exactly the close pairs have a counter");
  close_.visit([&](ProxyId a, ProxyId b) {
    require(close.of(a, b) == close_.of(a, b), "the counter of a pair is the number of cells that it shares");
  });
}

std::size_t MirtichGrid::structureBytes() const {
  std::size_t bytes = close_.bytes();
  for (const Level& level : levels_) {
    bytes += level.residents.bytes() + level.cells.bucket_count() * sizeof(void*);
    for (const auto& cell : level.cells) {
      bytes += sizeof(cell) + 2 * sizeof(void*);
      bytes += (cell.second.residents.capacity() + cell.second.visitors.capacity()) * sizeof(ProxyId);
    }
  }
  return bytes;
}

void MirtichGrid::draw(std::vector<Aabb>& regions) const {
  for (const Level& level : levels_) {
    for (const auto& one : level.cells) {
      if (!one.second.residents.empty()) regions.push_back(level.scale.regionOf(one.first));
    }
  }
}

}  // namespace book
}  // namespace hgrid
