// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "map_source.h"

#include <algorithm>

#include "frames.h"
#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/scene/name.h"

namespace hgrid {
namespace {

constexpr std::size_t kLongestFileName = 64;  // bytes

/// A name and no path: whoever may call a service may not choose what is read.
void checkFileName(const std::string& file) {
  const bool plain = !file.empty() && file.size() <= kLongestFileName && file.front() != '.' &&
                     std::all_of(file.begin(), file.end(), [](char c) {
                       return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                              c == '_' || c == '-';
                     });
  if (!plain) {
    throw Refusal(Code::bad_id, "file is '" + printable(file) +
                                    "'; it must be the name of a file in ~map/folder, of at most " +
                                    std::to_string(kLongestFileName) + " letters, digits and . _ -");
  }
}

}  // namespace

MapSource::MapSource(const Params& params, std::shared_ptr<const NarrowPhase> narrow_phase)
    : params_(params), narrow_phase_(std::move(narrow_phase)) {}

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

std::shared_ptr<const MapCells> MapSource::cellsOf(const Octomap& octomap) const {
  std::shared_ptr<const UnmappedSpace> unmapped;
  if (params_.map_unknown == UnknownSpace::report) {
    const auto end = [&](std::uint32_t key) {
      return Eigen::Vector3d::Constant(coordinateOf(key, octomap.resolution)).eval();
    };
    const Eigen::AlignedBox3d extent(params_.map_crop_min.cwiseMax(end(0)),
                                     params_.map_crop_max.cwiseMin(end(1u << Voxel::kLevels)));
    unmapped = std::make_shared<UnmappedSpace>(UnmappedSpace{StaticGrid(octomap.resolution, octomap.unknown), extent});
  }
  return makeMapCells(std::make_shared<StaticGrid>(octomap.resolution, octomap.occupied), *narrow_phase_, unmapped);
}

LoadedMap MapSource::load(const MapParams& map, const OctomapMessage& message) const {
  const std::string what = "map '" + map.name + "' of " + map.topic;
  if (!message.flaw.empty()) throw Refusal(Code::truncated, what + ": " + printable(message.flaw, 200));
  const Octomap octomap =
      readOctomapData({message.id, message.binary, message.resolution}, message.data, what, options());
  LoadedMap loaded{map, cellsOf(octomap)};
  loaded.params.frame = withoutSlash(message.frame);
  return loaded;
}

LoadedMap MapSource::load(const MapParams& map) const {
  checkLocal(map.name, "the map's name");
  checkFileName(map.file);
  if (params_.map_folder.empty()) {
    throw Refusal(Code::resource_denied, "map '" + map.name + "': ~map/folder is not set, so no file may be read");
  }
  ResourcePolicy policy;
  policy.file_roots = {params_.map_folder};
  policy.max_bytes = static_cast<std::size_t>(params_.map_max_bytes);
  const OpenResource file = openResource("file://" + params_.map_folder + "/" + map.file, policy);
  return {map, cellsOf(readOctomapFile(file, options()))};
}

}  // namespace hgrid
