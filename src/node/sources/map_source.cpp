// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/sources/map_source.h"

#include <algorithm>
#include <new>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/text/frame_names.h"
#include "node/time/ros_time.h"

namespace hgrid {
namespace {

constexpr std::size_t kLongestFileName = 64;  // [bytes]

/// Checks that `file` is a plain file name, so that a service request cannot read files outside the folder.
void checkFileName(const std::string& file) {
  const bool plain = !file.empty() && file.size() <= kLongestFileName && file.front() != '.' &&
                     std::all_of(file.begin(), file.end(), [](char c) {
                       return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                              c == '_' || c == '-';
                     });
  if (!plain) {
    throw Refusal(Code::bad_id,
                  "file is '" + printable(file) + "'; it must be the name of a file in ~map/folder, with at most " +
                      std::to_string(kLongestFileName) + " letters, digits and . _ -, and must not begin with a dot");
  }
}

}  // namespace

MapSource::MapSource(const Params& params, const SelfShapes& self_shapes,
                     std::shared_ptr<const NarrowPhase> narrow_phase, Ledger& ledger)
    : params_(params), self_shapes_(self_shapes), narrow_phase_(std::move(narrow_phase)), ledger_(ledger) {}

OctomapOptions MapSource::options() const {
  OctomapOptions options;
  options.occupied_from = params_.map_occupied_from;
  options.nan_is_occupied = params_.map_nan_is_occupied;
  options.allow_empty = params_.map_allow_empty;
  options.unknown = params_.map_unknown;
  options.crop = Eigen::AlignedBox3d(params_.map_crop_min, params_.map_crop_max);
  options.max_bytes = static_cast<std::size_t>(params_.map_max_bytes);
  options.max_leaves = static_cast<std::uint64_t>(params_.map_max_leaves);
  options.max_nodes = 2 * options.max_leaves;
  return options;
}

LoadedMap MapSource::finished(ReadMap map) const {
  try {
    return built(std::move(map));
  } catch (const std::bad_alloc&) {
    throw Refusal(Code::limit, "map '" + map.params.name +
                                   "' does not fit into the memory that is left; use a smaller or coarser map");
  }
}

LoadedMap MapSource::built(ReadMap&& map) const {
  Octomap& octomap = map.octomap;
  if (self_shapes_.wanted()) {
    self_shapes_.require();
    const Pose world_from_map = self_shapes_.worldFrom(map.params.frame, map.stamp) * map.params.frame_from_map;
    OthersCells others =
        withoutSelf(octomap.occupied, octomap.resolution, world_from_map, self_shapes_.at(map.stamp), *narrow_phase_);
    if (others.left_out > 0) ledger_.count("maps.own_cells", others.left_out);
    if (others.undecided > 0) ledger_.count("maps.cells_undecided", others.undecided);
    octomap.occupied = std::move(others.voxels);
  }
  std::shared_ptr<const UnmappedSpace> unmapped;
  if (params_.map_unknown == UnknownSpace::report) {
    const double begin = coordinateOf(0, octomap.resolution),
                 end = coordinateOf(1u << Voxel::kLevels, octomap.resolution);
    const Eigen::AlignedBox3d extent(params_.map_crop_min.cwiseMax(begin), params_.map_crop_max.cwiseMin(end));
    unmapped = std::make_shared<UnmappedSpace>(UnmappedSpace{StaticGrid(octomap.resolution, octomap.unknown), extent});
  }
  const auto grid = std::make_shared<StaticGrid>(octomap.resolution, octomap.occupied);
  return {map.params, makeMapCells(grid, *narrow_phase_, unmapped), map.stamp, map.received};
}

ReadMap MapSource::read(const MapParams& map, const OctomapMessage& message) const {
  const std::string what = "map '" + map.name + "' of " + map.topic;
  if (!message.flaw.empty()) throw Refusal(Code::truncated, what + ": " + printable(message.flaw, 200));
  ReadMap result{map, readOctomapData({message.id, message.binary, message.resolution}, message.data, what, options()),
                 fromRos(message.stamp), thisMoment()};
  result.params.frame = withoutSlash(message.frame);
  return result;
}

ReadMap MapSource::read(const MapParams& map) const {
  checkLocal(map.name, "the map's name");
  checkFileName(map.file);
  if (params_.map_folder.empty()) {
    throw Refusal(Code::resource_denied, "map '" + map.name + "': ~map/folder is not set, so no file may be read");
  }
  ResourcePolicy policy;
  policy.file_roots = {params_.map_folder};
  policy.max_bytes = static_cast<std::size_t>(params_.map_max_bytes);
  const OpenResource file = openResource("file://" + params_.map_folder + "/" + map.file, policy);
  return {map, readOctomapFile(file, options()), Time(0), thisMoment()};
}

}  // namespace hgrid
