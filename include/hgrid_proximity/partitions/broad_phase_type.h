// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

namespace hgrid {

/// The kinds of broad phase. All of them give the same answers; they differ in time and memory.
///
/// `hgrid` is HGrid, which found the pairs fastest in all measured worlds. The others follow chapter 7 of Ericson,
/// Real-Time Collision Detection, 2005, and each name is the name of a file in src/partitions. doc/partitions.md
/// describes and compares them.
enum class BroadPhaseType {
  hgrid,         ///< HGrid: hierarchical grid with SIMD instructions and threads
  hashed_hgrid,  ///< the book's hierarchical grid: all levels in one hash table (section 7.2.1)
  hashed_grid,   ///< uniform grid in a hash table with open addressing (section 7.1.3)
  bucket_grid,   ///< uniform grid in hash buckets without keys (section 7.1.3)
  array_grid,    ///< uniform grid of static boxes in one array (section 7.1.4); a change builds it again
  bit_grid,      ///< implicit grid of bit arrays (section 7.1.5)
  mirtich_grid,  ///< hierarchical grid with a counter per close pair (section 7.2.2)
  loose_octree,  ///< loose, linear octree (sections 7.3.3 to 7.3.6)
  kd_tree,       ///< k-d tree of static boxes (section 7.3.7); a change builds it again
  tree_grid,     ///< grid of k-d trees (section 7.3.8); a change builds the trees of the touched cells again
  sweep_lists,   ///< sort and sweep with linked lists (section 7.5.1)
  sweep_array,   ///< sort and sweep with an array (section 7.5.2)
};

/// Returns the name of a kind, such as "kd_tree".
const char* name(BroadPhaseType type);
/// Returns all kinds, in the order of the enumeration.
const std::vector<BroadPhaseType>& broadPhaseTypes();
/// Finds the kind with this name. @returns whether there is one
bool find(const std::string& name, BroadPhaseType& type);

}  // namespace hgrid
