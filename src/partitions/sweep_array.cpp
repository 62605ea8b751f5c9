// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/sweep_array.h"

namespace hgrid {
namespace book {

/// The axis on which the centers have the largest variance. If it is equal on two axes, the present one stays.
int SweepArray::axisOfLargestVariance() const {
  const Eigen::Vector3d middle = 0.5 * (world().min.cast<double>() + world().max.cast<double>());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), sum_of_squares = sum;
  for (const Entry& entry : entries_) {
    const Aabb& here = box(entry.id);
    const Eigen::Vector3d center = 0.5 * (here.min.cast<double>() + here.max.cast<double>()) - middle;
    sum += center;
    sum_of_squares += center.cwiseProduct(center);
  }
  const double count = std::max(1.0, static_cast<double>(entries_.size()));
  const Eigen::Vector3d variance = sum_of_squares / count - (sum / count).cwiseProduct(sum / count);
  int axis = axis_;
  for (int other = 0; other < 3; ++other) {
    if (variance[other] > variance[axis]) axis = other;
  }
  return axis;
}

// ---- changes

void SweepArray::build() {
  entries_.clear();
  for (const ProxyId id : storedIds()) entries_.push_back({0.0f, 0.0f, id});
  settle();
}

Partition::Followed SweepArray::added(ProxyId id) {
  if (id >= place_.size()) place_.resize(idEnd());
  place_[id] = static_cast<std::uint32_t>(entries_.size());
  entries_.push_back({0.0f, 0.0f, id});
  return Followed::settle;
}

Partition::Followed SweepArray::removed(ProxyId id, const Aabb&) {
  const std::uint32_t gap = place_[id];
  entries_[gap] = entries_.back();
  place_[entries_[gap].id] = gap;
  entries_.pop_back();
  return Followed::settle;
}

/// Chooses the axis, sorts the entries, and computes what depends on their order.
void SweepArray::settle() {
  axis_ = axisOfLargestVariance();
  for (Entry& entry : entries_) {
    entry.min = box(entry.id).min[axis_];
    entry.max = box(entry.id).max[axis_];
  }
  sort();
  place_.resize(idEnd());
  end_so_far_.resize(entries_.size());
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    place_[entries_[i].id] = i;
    end_so_far_[i] = i == 0 ? entries_[i].max : std::max(end_so_far_[i - 1], entries_[i].max);
  }
}

/// Sorts the entries by insertion. After too many steps, std::sort takes over.
void SweepArray::sort() {
  const auto less = [](const Entry& a, const Entry& b) { return a.min != b.min ? a.min < b.min : a.id < b.id; };
  std::size_t steps = 0;
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    const Entry entry = entries_[i];
    std::size_t place = i;
    for (; place > 0 && less(entry, entries_[place - 1]); --place, ++steps) entries_[place] = entries_[place - 1];
    entries_[place] = entry;
    if (steps > 16 * entries_.size()) return std::sort(entries_.begin(), entries_.end(), less);
  }
}

// ---- searches

void SweepArray::findPairs(PairSink& sink) const {
  std::vector<Entry> movable, fixed;
  for (const Entry& entry : entries_) (isFixed(entry.id) ? fixed : movable).push_back(entry);
  std::size_t next_fixed = 0, next_movable = 0;
  for (std::size_t i = 0; i < movable.size(); ++i) {
    if (sink.isFull()) return;
    const Entry& one = movable[i];
    for (std::size_t k = i + 1; k < movable.size() && movable[k].min <= one.max; ++k)
      sink.tryPair(one.id, movable[k].id);
    // The fixed boxes that begin at the beginning of this box or behind it.
    while (next_fixed < fixed.size() && fixed[next_fixed].min < one.min) ++next_fixed;
    for (std::size_t k = next_fixed; k < fixed.size() && fixed[k].min <= one.max; ++k)
      sink.tryPair(one.id, fixed[k].id);
  }
  for (const Entry& one : fixed) {  // the movable boxes that begin behind the beginning of a fixed box
    if (sink.isFull()) return;
    while (next_movable < movable.size() && movable[next_movable].min <= one.min) ++next_movable;
    for (std::size_t k = next_movable; k < movable.size() && movable[k].min <= one.max; ++k)
      sink.tryPair(one.id, movable[k].id);
  }
}

void SweepArray::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  const Aabb& around = shape.bounds();
  const float begin = around.min[axis_], end = around.max[axis_];
  const auto first = std::lower_bound(end_so_far_.begin(), end_so_far_.end(), begin) - end_so_far_.begin();
  for (auto i = static_cast<std::size_t>(first); i < entries_.size() && entries_[i].min <= end; ++i) {
    if (entries_[i].max >= begin && shape.mayTouch(box(entries_[i].id))) found.push_back(entries_[i].id);
  }
}

void SweepArray::checkStructure() const {
  require(entries_.size() == size(), "each box has one entry");
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    require(isStored(entry.id) && place_[entry.id] == i, "the back pointer of a box leads to its entry");
    require(entry.min == box(entry.id).min[axis_] && entry.max == box(entry.id).max[axis_],
            "an entry has its box's ends");
    require(i == 0 || entries_[i - 1].min <= entry.min, "the entries are sorted");
    require(i == 0 || end_so_far_[i - 1] <= end_so_far_[i], "the largest ends never decrease");
  }
}

std::size_t SweepArray::structureBytes() const {
  return entries_.capacity() * sizeof(Entry) + place_.capacity() * sizeof(std::uint32_t) +
         end_so_far_.capacity() * sizeof(float);
}

/// Draws the boxes as intervals on the sorted axis, in their order, one above the other.
void SweepArray::draw(std::vector<Aabb>& regions) const {
  const int across = axis_ == 0 ? 1 : 0;
  const float height = (world().max[across] - world().min[across]) / static_cast<float>(entries_.size() + 1);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Aabb interval = world();
    interval.min[axis_] = entries_[i].min;
    interval.max[axis_] = entries_[i].max;
    interval.min[across] = world().min[across] + height * static_cast<float>(i);
    interval.max[across] = interval.min[across] + 0.6f * height;
    regions.push_back(interval);
  }
}

}  // namespace book
}  // namespace hgrid
