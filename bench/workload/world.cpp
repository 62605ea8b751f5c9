// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/workload/world.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/workload/workloads.h"

namespace hgrid {
namespace bench {
namespace {

constexpr std::uint64_t kChoiceSeed = 2;

}  // namespace

const char* name(Movers movers) { return movers == Movers::same ? "same" : "changing"; }

World::World(const std::string& workload, std::size_t n, double moving, Movers movers)
    : n_(n),
      layout_(layoutOf(workload, n)),
      first_walkers_(layout_.walkers),
      first_bases_(layout_.bases),
      movers_(movers),
      choice_(kChoiceSeed) {
  groups_.resize(layout_.bases.empty() ? n : layout_.bases.size());
  moved_groups_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(moving * double(groups_.size()))));
  boxes_.resize(n);
  reset();
}

World::World(std::vector<Aabb> even, std::vector<Aabb> odd)
    : n_(even.size()), even_(std::move(even)), odd_(std::move(odd)), moved_(n_) {
  std::iota(moved_.begin(), moved_.end(), 0);
  reset();
}

void World::chooseMoved() {
  const std::size_t group = layout_.bases.empty() ? 1 : Layout::kLinks;
  for (std::size_t i = 0; i < moved_groups_; ++i) std::swap(groups_[i], groups_[i + choice_.below(groups_.size() - i)]);
  std::vector<ProxyId> chosen(groups_.begin(), groups_.begin() + static_cast<std::ptrdiff_t>(moved_groups_));
  std::sort(chosen.begin(), chosen.end());
  moved_.clear();
  for (const ProxyId number : chosen) {
    for (std::size_t i = number * group; i < std::min(n_, (number + 1) * group); ++i)
      moved_.push_back(static_cast<ProxyId>(i));
  }
  if (!layout_.bases.empty()) moved_bases_ = std::move(chosen);
}

void World::place(std::size_t i) {
  Eigen::Vector3f center = layout_.walkers[i].at();
  if (!layout_.bases.empty()) {
    center += layout_.bases[i / Layout::kLinks].at() + layout_.rests[i];
  } else if (!layout_.rests.empty()) {
    center += layout_.rests[i];
  }
  boxes_[i].min = center - layout_.halves[i];
  boxes_[i].max = center + layout_.halves[i];
}

void World::reset() {
  frame_ = 0;
  if (!even_.empty()) {
    boxes_ = even_;
    return;
  }
  layout_.walkers = first_walkers_;
  layout_.bases = first_bases_;
  choice_ = Random(kChoiceSeed);
  std::iota(groups_.begin(), groups_.end(), 0);
  chooseMoved();
  for (std::size_t i = 0; i < n_; ++i) place(i);
}

void World::step() {
  ++frame_;
  if (!even_.empty()) {
    boxes_ = moved_boxes_ = frame_ % 2 == 0 ? even_ : odd_;
    return;
  }
  if (movers_ == Movers::changing) chooseMoved();
  for (const ProxyId number : moved_bases_) layout_.bases[number].walk(frame_);
  moved_boxes_.clear();
  for (const ProxyId id : moved_) {
    layout_.walkers[id].walk(frame_);
    place(id);
    moved_boxes_.push_back(boxes_[id]);
  }
}

}  // namespace bench
}  // namespace hgrid
