// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/partitions/partitions.h"

#include <stdexcept>
#include <string>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "partitions/array_grid.h"
#include "partitions/bit_grid.h"
#include "partitions/bucket_grid.h"
#include "partitions/hashed_grid.h"
#include "partitions/hashed_hgrid.h"
#include "partitions/kd_tree.h"
#include "partitions/loose_octree.h"
#include "partitions/mirtich_grid.h"
#include "partitions/sweep_array.h"
#include "partitions/sweep_lists.h"
#include "partitions/tree_grid.h"

namespace hgrid {
namespace {

std::unique_ptr<BroadPhase> makeHGrid(const BroadPhaseOptions& options) {
  GridScale scale;
  scale.finest_edge = options.finest_edge;
  auto grid = std::make_unique<HGrid>(scale);
  grid->setThreads(options.threads);
  return grid;
}

}  // namespace

std::unique_ptr<BroadPhase> makeBroadPhase(const BroadPhaseOptions& options) {
  switch (options.type) {
    case BroadPhaseType::hgrid:
      return makeHGrid(options);
    case BroadPhaseType::hashed_hgrid:
      return std::make_unique<book::HashedHGrid>();
    case BroadPhaseType::hashed_grid:
      return std::make_unique<book::HashedGrid>();
    case BroadPhaseType::bucket_grid:
      return std::make_unique<book::BucketGrid>();
    case BroadPhaseType::array_grid:
      return std::make_unique<book::ArrayGrid>();
    case BroadPhaseType::bit_grid:
      return std::make_unique<book::BitGrid>();
    case BroadPhaseType::mirtich_grid:
      return std::make_unique<book::MirtichGrid>();
    case BroadPhaseType::loose_octree:
      return std::make_unique<book::LooseOctree>();
    case BroadPhaseType::kd_tree:
      return std::make_unique<book::KdTree>();
    case BroadPhaseType::tree_grid:
      return std::make_unique<book::TreeGrid>();
    case BroadPhaseType::sweep_lists:
      return std::make_unique<book::SweepLists>();
    case BroadPhaseType::sweep_array:
      return std::make_unique<book::SweepArray>();
  }
  throw std::invalid_argument("the type of the broad phase is " + std::to_string(static_cast<int>(options.type)) +
                              "; it must be one of broadPhaseTypes()");
}

std::size_t storedBytes(const BroadPhase& broad_phase) {
  if (const auto* grid = dynamic_cast<const HGrid*>(&broad_phase)) return grid->bytes();
  const auto* partition = dynamic_cast<const book::Partition*>(&broad_phase);
  return partition != nullptr ? partition->bytes() : 0;
}

}  // namespace hgrid
