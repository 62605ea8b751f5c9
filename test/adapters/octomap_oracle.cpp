// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/adapters/octomap_oracle.h"

#include <algorithm>
#include <iterator>

namespace hgrid {
namespace test {
namespace {

using Place = std::vector<Voxel>::const_iterator;

bool inMortonOrder(const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); }

/// Returns the number of Morton codes of the finest cells in a cube of this level.
std::uint64_t codesOf(int level) { return std::uint64_t{1} << 3 * level; }

std::string shown(const Voxel& voxel) {
  return "(" + std::to_string(voxel.x) + " " + std::to_string(voxel.y) + " " + std::to_string(voxel.z) + "; " +
         std::to_string(voxel.level) + ")";
}

bool isAligned(const Voxel& voxel) {
  return voxel.level <= Voxel::kLevels && ((voxel.x | voxel.y | voxel.z) & (keysAlong(voxel) - 1)) == 0;
}

std::string flawOf(const std::vector<Voxel>& voxels) {
  std::uint64_t end = 0;
  for (const Voxel& voxel : voxels) {
    if (!isAligned(voxel)) return shown(voxel) + " is not aligned to the grid of its level";
    if (mortonOf(voxel) < end) return shown(voxel) + " overlaps the previous voxel, or is not in Morton order";
    end = mortonOf(voxel) + codesOf(voxel.level);
  }
  return {};
}

/// Appends the node of this level whose Morton codes start at `begin`, and all nodes below it. The leaves of the node
/// are the voxels first .. last. All of them are smaller than the node.
void write(std::uint64_t begin, int level, Place first, Place last, std::string& bytes) {
  const std::uint64_t part = codesOf(level - 1);
  std::vector<Place> bounds{first};
  unsigned word = 0;
  for (unsigned child = 0; child < 8; ++child) {
    const std::uint64_t end = begin + (child + 1) * part;
    bounds.push_back(std::find_if(bounds.back(), last, [&](const Voxel& voxel) { return mortonOf(voxel) >= end; }));
    if (bounds[child] == bounds[child + 1]) continue;
    word |= (bounds[child]->level == level - 1 ? 2u : 3u) << 2 * child;
  }
  bytes += {static_cast<char>(word & 0xff), static_cast<char>(word >> 8)};
  for (unsigned child = 0; child < 8; ++child) {
    if ((word >> 2 * child & 3u) == 3u) write(begin + child * part, level - 1, bounds[child], bounds[child + 1], bytes);
  }
}

}  // namespace

std::string flawOf(const Octomap& map, const OctomapOptions& options) {
  std::vector<Voxel> all;
  std::merge(map.occupied.begin(), map.occupied.end(), map.free.begin(), map.free.end(), std::back_inserter(all),
             inMortonOrder);
  const auto middle = all.insert(all.end(), map.unknown.begin(), map.unknown.end());
  std::inplace_merge(all.begin(), middle, all.end(), inMortonOrder);
  const std::string flaw = flawOf(all);  // merging keeps the order of each list, even if the order is wrong
  if (!flaw.empty()) return flaw;
  if (all.size() > options.max_leaves) return std::to_string(all.size()) + " leaves exceed the limit";
  if (map.nodes > options.max_nodes) return std::to_string(map.nodes) + " nodes exceed the limit";
  OctomapOptions again;
  again.allow_empty = true;
  const auto read = readOctomapData({"OcTree", true, map.resolution}, binaryNodesOf(map.occupied), "again", again);
  return read.occupied == map.occupied ? "" : "after writing and reading it again, the map has other occupied voxels";
}

std::string binaryNodesOf(const std::vector<Voxel>& voxels) {
  if (voxels.empty()) return {};
  if (voxels.front().level == Voxel::kLevels) return std::string(2, '\0');
  std::string bytes;
  write(0, Voxel::kLevels, voxels.begin(), voxels.end(), bytes);
  return bytes;
}

}  // namespace test
}  // namespace hgrid
