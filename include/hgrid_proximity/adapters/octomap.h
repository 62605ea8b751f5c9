// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hgrid_proximity/adapters/resource.h"
#include "hgrid_proximity/geometry/voxel.h"

namespace hgrid {

/// How space is treated for which a map has no leaf, out to the ends of the keys. The numbers are part of the
/// interface: do not change them.
enum class UnknownSpace : std::uint8_t {
  ignore = 0,    ///< it counts as free
  report = 1,    ///< it is kept apart, so that answers can say that nothing is known of it
  occupied = 2,  ///< it counts as occupied
};

/// What is taken of an OctoMap, and how much of one is read at most.
struct OctomapOptions {
  /// Leaves of at least this probability, within (0, 1), are occupied. Only for maps with probabilities (`.ot`,
  /// octomap_full): the others say themselves what is occupied.
  double occupied_from = 0.5;
  bool nan_is_occupied = false;  ///< a leaf whose log-odds are NaN is occupied and counted; false: refused
  UnknownSpace unknown = UnknownSpace::ignore;
  bool keep_free = false;    ///< Octomap::free is filled
  bool allow_empty = false;  ///< no nodes at all are a map, all of it unknown; false: refused
  /// Voxels that lie wholly outside this box [m] in the map's frame are dropped while reading; touching is not
  /// outside, and none is cut. Sides may be infinite.
  std::optional<Eigen::AlignedBox3d> crop;

  std::size_t max_bytes = 256u << 20;     ///< of a file or a message
  std::uint64_t max_nodes = 40'000'000;   ///< inner nodes and leaves, the cropped ones included
  std::uint64_t max_leaves = 20'000'000;  ///< kept: occupied, free and unknown together
};

/// The leaves of an OctoMap, without the tree. The lists are each disjoint and in Morton order.
struct Octomap {
  double resolution = 0.0;  ///< [m] edge of a voxel of level 0
  std::vector<Voxel> occupied;
  std::vector<Voxel> free;     ///< empty unless OctomapOptions::keep_free
  std::vector<Voxel> unknown;  ///< empty unless OctomapOptions::unknown says report

  std::uint64_t nodes = 0;           ///< read: inner nodes and leaves, as OctoMap's own size()
  std::uint64_t free_leaves = 0;     ///< read
  std::uint64_t nan_leaves = 0;      ///< read, and taken as occupied
  std::uint64_t unknown_leaves = 0;  ///< parts without a leaf that OctomapOptions::unknown asked for
  std::uint64_t cropped = 0;         ///< voxels that would have been kept, but lie outside the crop
};

/// How a map's nodes are written: what a file says in its header, and octomap_msgs/Octomap in its fields.
struct OctomapFormat {
  std::string id;           ///< "OcTree" or "ColorOcTree", whose colours are passed over
  bool binary = true;       ///< free or occupied, as in a `.bt` file; false: with probabilities, as in an `.ot` file
  double resolution = 0.0;  ///< [m] edge of the smallest leaves, within 0.001 .. 100
};

/// Reads the nodes of an OctoMap, such as the `data` of an octomap_msgs/Octomap, straight into a list of leaves: no
/// tree is built, memory is bounded by the leaves that are there, whatever the input claims.
///
/// Means what OctoMap's own readers mean by the same bytes, also of `.bt` nodes without children (OctoMap writes none):
/// such a root is an occupied leaf, any other a free one. Of `.ot` nodes with children only the children count.
/// May run in several threads at once; on failure nothing is kept.
/// @param what  names the map in a refusal, as in "map 'room'"
/// @throws Refusal truncated if the data end before the tree does; parse for data without a node, after the end of
/// the tree, deeper than 16 levels, or with NaN log-odds; out_of_range (resolution, occupied_from, a crop whose
/// corners are swapped), nonfinite (a crop with NaN), unsupported (another id); limit, also when memory runs out.
Octomap readOctomapData(const OctomapFormat& format, std::string_view data, const std::string& what,
                        const OctomapOptions& options = {});

/// Reads the bytes of a whole `.bt` or `.ot` file; its first line says which.
///
/// Stricter than OctoMap in the header: `size` must be there and true (OctoMap takes a `.bt` without it for an empty
/// map), none of id, size and res may stand twice; unknown keywords are passed over, as OctoMap does.
/// @throws Refusal as readOctomapData(); parse for a header that is none or lies; unsupported for the binary header of
/// OctoMap before 1.0
Octomap readOctomap(std::string_view file, const std::string& what, const OctomapOptions& options = {});

/// Reads a `.bt` or `.ot` file that openResource() has let pass.
/// @throws Refusal as readOctomap(); truncated if the file has become shorter since; resource_missing if reading fails
Octomap readOctomapFile(const OpenResource& file, const OctomapOptions& options = {});

}  // namespace hgrid
