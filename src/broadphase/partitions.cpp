// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/partitions.h"

#include "broadphase/book/array_grid.h"
#include "broadphase/book/bit_grid.h"
#include "broadphase/book/bucket_grid.h"
#include "broadphase/book/hashed_grid.h"
#include "broadphase/book/kd_tree.h"
#include "broadphase/book/loose_octree.h"
#include "broadphase/book/mirtich_grid.h"
#include "broadphase/book/sweep_array.h"
#include "broadphase/book/sweep_lists.h"
#include "broadphase/book/tree_grid.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {
namespace {

std::unique_ptr<BroadPhase> makeHGrid(const BroadPhaseOptions& options) {
  GridScale scale;
  scale.finest_edge = options.finest_edge;
  auto grid = std::make_unique<HGrid>(scale);
  grid->setThreads(options.threads);
  return grid;
}

template <class Kind>
std::unique_ptr<BroadPhase> makeOf(const BroadPhaseOptions&) {
  return std::make_unique<Kind>();
}

struct KindRow {
  const char* name;
  std::unique_ptr<BroadPhase> (*make)(const BroadPhaseOptions&);
};

/// One row per kind, in the order of the enumeration.
constexpr KindRow kKinds[] = {
    {"hgrid", makeHGrid},
    {"hashed_grid", makeOf<book::HashedGrid>},
    {"bucket_grid", makeOf<book::BucketGrid>},
    {"array_grid", makeOf<book::ArrayGrid>},
    {"bit_grid", makeOf<book::BitGrid>},
    {"mirtich_grid", makeOf<book::MirtichGrid>},
    {"loose_octree", makeOf<book::LooseOctree>},
    {"kd_tree", makeOf<book::KdTree>},
    {"tree_grid", makeOf<book::TreeGrid>},
    {"sweep_lists", makeOf<book::SweepLists>},
    {"sweep_array", makeOf<book::SweepArray>},
};

}  // namespace

const char* name(BroadPhaseType type) { return kKinds[static_cast<std::size_t>(type)].name; }

const std::vector<BroadPhaseType>& broadPhaseTypes() {
  static const std::vector<BroadPhaseType> types = [] {
    std::vector<BroadPhaseType> all;
    for (std::size_t i = 0; i < std::size(kKinds); ++i) all.push_back(static_cast<BroadPhaseType>(i));
    return all;
  }();
  return types;
}

bool find(const std::string& name, BroadPhaseType& type) {
  for (const BroadPhaseType candidate : broadPhaseTypes()) {
    if (name != hgrid::name(candidate)) continue;
    type = candidate;
    return true;
  }
  return false;
}

std::unique_ptr<BroadPhase> makeBroadPhase(const BroadPhaseOptions& options) {
  return kKinds[static_cast<std::size_t>(options.type)].make(options);
}

std::size_t storedBytes(const BroadPhase& broad_phase) {
  if (const auto* grid = dynamic_cast<const HGrid*>(&broad_phase)) return grid->bytes();
  const auto* partition = dynamic_cast<const book::Partition*>(&broad_phase);
  return partition != nullptr ? partition->bytes() : 0;
}

}  // namespace hgrid
