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

/// How to treat unknown space, that is, space for which a map has no leaf. The whole range of the keys counts as space
/// of the map. The numbers are part of the interface: do not change them.
enum class UnknownSpace : std::uint8_t {
  ignore = 0,    ///< unknown space counts as free
  report = 1,    ///< unknown space is stored separately, so that answers can report it
  occupied = 2,  ///< unknown space counts as occupied
};

/// Options for reading an OctoMap: which leaves are kept, and limits for its size.
struct OctomapOptions {
  /// Leaves with at least this probability are occupied. It must be greater than 0 and less than 1. It is used only for
  /// maps with probabilities (`.ot`, octomap_full). Other maps store directly which leaves are occupied.
  double occupied_from = 0.5;
  bool nan_is_occupied = false;  ///< true: a leaf with NaN log-odds is occupied; false: the map is rejected
  UnknownSpace unknown = UnknownSpace::ignore;  ///< how to treat space without a leaf
  bool keep_free = false;                       ///< whether Octomap::free is filled
  bool allow_empty = false;  ///< true: data without nodes is a map that is wholly unknown; false: it is rejected
  /// Crop box [m, map frame]. Voxels that are wholly outside the box are dropped while reading. Voxels that touch the
  /// box are kept whole. The sides of the box may be infinite.
  std::optional<Eigen::AlignedBox3d> crop;

  std::size_t max_bytes = 256u << 20;     ///< largest size of a file or a message
  std::uint64_t max_nodes = 40'000'000;   ///< largest number of inner nodes and leaves, cropped leaves included
  std::uint64_t max_leaves = 20'000'000;  ///< largest number of kept leaves: occupied, free and unknown together
};

/// The leaves of an OctoMap, without the tree. The voxels of each list are disjoint and in Morton order.
struct Octomap {
  double resolution = 0.0;      ///< [m] edge of a voxel of level 0
  std::vector<Voxel> occupied;  ///< occupied leaves; with UnknownSpace::occupied also the unknown space
  std::vector<Voxel> free;      ///< empty unless OctomapOptions::keep_free is true
  std::vector<Voxel> unknown;   ///< empty unless OctomapOptions::unknown is report

  std::uint64_t nodes = 0;           ///< number of inner nodes and leaves, as in OctoMap's own size()
  std::uint64_t free_leaves = 0;     ///< number of free leaves in the data
  std::uint64_t nan_leaves = 0;      ///< number of leaves with NaN log-odds, which count as occupied
  std::uint64_t unknown_leaves = 0;  ///< number of unknown voxels; 0 if OctomapOptions::unknown is ignore
  std::uint64_t cropped = 0;         ///< number of voxels that were dropped only because they are outside the crop box
};

/// Encoding of the nodes of a map, as given in the header of a file or in the fields of an octomap_msgs/Octomap.
struct OctomapFormat {
  std::string id;           ///< "OcTree" or "ColorOcTree"; colors are ignored
  bool binary = true;       ///< true: free or occupied, as in `.bt` files; false: probabilities, as in `.ot` files
  double resolution = 0.0;  ///< [m] edge of the smallest leaves, within 0.001 .. 100
};

/// Reads the nodes of an OctoMap, such as the `data` of an octomap_msgs/Octomap, directly into a list of leaves.
///
/// It builds no tree, so the memory depends only on the leaves that are present, even if a header claims more. Several
/// threads may call this at the same time.
///
/// The bytes have the same meaning as for OctoMap's own readers. This includes `.bt` nodes without children, which
/// OctoMap never writes: such a root is an occupied leaf, any other such node is a free leaf. If an `.ot` node has
/// children, only the children count.
/// @param format  how the bytes are encoded
/// @param data    the nodes, without the header of a file
/// @param what    name of the map for the error sentence, such as "map 'room'"
/// @throws Refusal with one of these codes:
/// - truncated: the data ends before the tree is complete
/// - parse: there is no node, bytes follow the tree, the tree has more than 16 levels, or log-odds are NaN
/// - out_of_range: the resolution or occupied_from is out of range, or the crop box has min > max
/// - nonfinite: the crop box contains NaN
/// - unsupported: the id is neither OcTree nor ColorOcTree
/// - limit: the map exceeds a limit of the options, or memory runs out
Octomap readOctomapData(const OctomapFormat& format, std::string_view data, const std::string& what,
                        const OctomapOptions& options = {});

/// Reads the bytes of a complete `.bt` or `.ot` file. The first line of the file selects the format.
///
/// The header is checked more strictly than by OctoMap. `size` must be present and correct, because OctoMap reads a
/// `.bt` file without `size` as an empty map. Each of id, size and res may appear only once. Unknown keywords are
/// ignored, as OctoMap ignores them.
/// @throws Refusal in the same cases as readOctomapData()
/// @throws Refusal parse if the header is missing, broken or wrong
/// @throws Refusal unsupported for the binary header of OctoMap before 1.0
Octomap readOctomap(std::string_view file, const std::string& what, const OctomapOptions& options = {});

/// Reads a `.bt` or `.ot` file that openResource() has opened.
/// @throws Refusal in the same cases as readOctomap()
/// @throws Refusal truncated if the file became shorter after it was opened
/// @throws Refusal resource_missing if reading fails
Octomap readOctomapFile(const OpenResource& file, const OctomapOptions& options = {});

}  // namespace hgrid
