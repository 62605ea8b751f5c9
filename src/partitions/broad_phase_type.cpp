// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/partitions/broad_phase_type.h"

#include <cstddef>
#include <iterator>

namespace hgrid {
namespace {

/// In the order of the enumeration.
constexpr const char* kNames[] = {"hgrid",      "hashed_hgrid", "hashed_grid",  "bucket_grid",
                                  "array_grid", "bit_grid",     "mirtich_grid", "loose_octree",
                                  "kd_tree",    "tree_grid",    "sweep_lists",  "sweep_array"};

}  // namespace

const char* name(BroadPhaseType type) { return kNames[static_cast<std::size_t>(type)]; }

const std::vector<BroadPhaseType>& broadPhaseTypes() {
  static const std::vector<BroadPhaseType> types = [] {
    std::vector<BroadPhaseType> all;
    for (std::size_t i = 0; i < std::size(kNames); ++i) all.push_back(static_cast<BroadPhaseType>(i));
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

}  // namespace hgrid
