// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/octomap.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <new>
#include <utility>

#include "adapters/octomap/octomap_header.h"
#include "adapters/octomap/octomap_tree.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr double kLeastResolution = 1e-3, kGreatestResolution = 100.0;  // [m] accepted range

/// An interval along one axis, in keys.
struct KeyRange {
  int first = 0;  // least key that is not below the interval
  int last = 0;   // greatest key that is not above the interval

  /// Whether a voxel touches the interval. The voxel begins at `key` and is `along` keys long.
  bool touches(int key, int along) const { return key + along >= first && key <= last; }
};

/// Returns how many of the keys 0 .. 65536 have a coordinate for which `holds` is true. If `holds` is true for a
/// coordinate, it must be true for all smaller coordinates.
template <class Holds>
int keysWith(double resolution, Holds&& holds) {
  int low = 0, high = (1 << Voxel::kLevels) + 1;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (holds(coordinateOf(static_cast<std::uint32_t>(middle), resolution))) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Converts the interval min .. max [m] to keys. Searches the keys instead of dividing by the resolution. So the keys
/// are rounded exactly like the corners of voxels.
KeyRange keysTouching(double min, double max, double resolution) {
  return {keysWith(resolution, [&](double coordinate) { return coordinate < min; }),
          keysWith(resolution, [&](double coordinate) { return coordinate <= max; }) - 1};
}

/// Receives the nodes and leaves of a tree. Counts both and stores the leaves that the options select.
class Leaves {
 public:
  Leaves(const OctomapOptions& options, double resolution, const std::string& what) : options_(options), what_(what) {
    map_.resolution = resolution;
    if (!options.crop) return;
    for (int axis = 0; axis < 3; ++axis) {
      crop_[axis] = keysTouching(options.crop->min()[axis], options.crop->max()[axis], resolution);
    }
  }

  bool wantsFree() const { return options_.keep_free; }
  bool wantsUnknown() const { return options_.unknown != UnknownSpace::ignore; }

  void count(std::uint64_t nodes, std::uint64_t free) {
    map_.nodes += nodes;
    map_.free_leaves += free;
    if (map_.nodes > options_.max_nodes) refuse("nodes", options_.max_nodes);
  }

  void add(const Voxel& cube, Octant octant) {
    if (octant == Octant::free) return keep(cube, map_.free);
    if (octant == Octant::nan) countNan();
    if (octant == Octant::unknown) ++map_.unknown_leaves;
    const bool apart = octant == Octant::unknown && options_.unknown == UnknownSpace::report;
    keep(cube, apart ? map_.unknown : map_.occupied);
  }

  Octomap take() { return std::move(map_); }

 private:
  void countNan() {
    if (!options_.nan_is_occupied) {
      throw Refusal(Code::parse, what_ + " has a leaf whose log-odds are nan; they must be a number");
    }
    ++map_.nan_leaves;
  }

  void keep(const Voxel& cube, std::vector<Voxel>& voxels) {
    const int along = static_cast<int>(keysAlong(cube));
    if (options_.crop &&
        !(crop_[0].touches(cube.x, along) && crop_[1].touches(cube.y, along) && crop_[2].touches(cube.z, along))) {
      ++map_.cropped;
      return;
    }
    const std::size_t kept = map_.occupied.size() + map_.free.size() + map_.unknown.size();
    if (kept >= options_.max_leaves) refuse("leaves to keep", options_.max_leaves);
    voxels.push_back(cube);
  }

  [[noreturn]] void refuse(const char* things, std::uint64_t most) const {
    throw Refusal(Code::limit,
                  what_ + " has too many " + things + "; at most " + std::to_string(most) + " are allowed");
  }

  const OctomapOptions& options_;
  const std::string& what_;
  Octomap map_;
  std::array<KeyRange, 3> crop_;
};

void checkOptions(const OctomapOptions& options, const std::string& what) {
  if (!(options.occupied_from > 0.0 && options.occupied_from < 1.0)) {
    throw Refusal(Code::out_of_range, what + ": the probability from which a leaf is occupied is " +
                                          text(options.occupied_from) + "; it must be greater than 0 and less than 1");
  }
  if (!options.crop) return;
  for (int axis = 0; axis < 3; ++axis) {
    const double min = options.crop->min()[axis], max = options.crop->max()[axis];
    if (min <= max) continue;
    throw Refusal(std::isnan(min) || std::isnan(max) ? Code::nonfinite : Code::out_of_range,
                  what + ": its crop box has " + "xyz"[axis] + " from " + text(min) + " to " + text(max) +
                      " m; the first value must be at most the second");
  }
}

void checkFormat(const OctomapFormat& format, const std::string& what) {
  if (format.id != "OcTree" && format.id != "ColorOcTree") {
    throw Refusal(Code::unsupported,
                  what + " is of kind '" + printable(format.id) + "'; it must be OcTree or ColorOcTree");
  }
  if (!(format.resolution >= kLeastResolution && format.resolution <= kGreatestResolution)) {
    throw Refusal(Code::out_of_range, what + " has a resolution of " + text(format.resolution) +
                                          " m; it must be within " + text(kLeastResolution) + " .. " +
                                          text(kGreatestResolution) + " m");
  }
}

void checkBytes(std::size_t bytes, const OctomapOptions& options, const std::string& what) {
  if (bytes <= options.max_bytes) return;
  throw Refusal(Code::limit, what + " has " + std::to_string(bytes) + " bytes; at most " +
                                 std::to_string(options.max_bytes) + " are allowed");
}

/// Calls `read` and returns its result. @throws Refusal with code limit if memory runs out
template <class Read>
auto withinMemory(const std::string& what, Read&& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw Refusal(Code::limit, what + " does not fit into the memory that is left; use a smaller or coarser map");
  }
}

/// Returns the log-odds of a probability in the same way as OctoMap: computed in double, rounded to float.
float logOdds(double probability) { return static_cast<float>(std::log(probability / (1.0 - probability))); }

Octomap readNodes(const OctomapFormat& format, std::string_view data, const std::string& what,
                  const OctomapOptions& options) {
  Leaves leaves(options, format.resolution, what);
  if (data.empty()) {
    if (!options.allow_empty) throw Refusal(Code::parse, what + " is empty; it must have at least one node");
    if (leaves.wantsUnknown()) leaves.add(kWhole, Octant::unknown);
    return leaves.take();
  }
  if (format.binary) {
    BinaryNodes nodes(data, what);
    readTree(nodes, leaves, what);
  } else {
    FullNodes nodes(data, what, format.id == "ColorOcTree", logOdds(options.occupied_from));
    readTree(nodes, leaves, what);
  }
  return leaves.take();
}

std::string bytesOf(const OpenResource& file, const std::string& what) {
  std::string bytes(file.bytes(), '\0');
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t got = ::pread(file.fd(), &bytes[at], bytes.size() - at, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Refusal(Code::resource_missing, what + " cannot be read: " + std::strerror(errno));
    if (got == 0) {
      throw Refusal(Code::truncated, what + " ends after " + std::to_string(at) + " bytes; it had " +
                                         std::to_string(bytes.size()) + " when it was opened");
    }
    at += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace

Octomap readOctomapData(const OctomapFormat& format, std::string_view data, const std::string& what,
                        const OctomapOptions& options) {
  checkOptions(options, what);
  checkFormat(format, what);
  checkBytes(data.size(), options, what);
  return withinMemory(what, [&] { return readNodes(format, data, what, options); });
}

Octomap readOctomap(std::string_view file, const std::string& what, const OctomapOptions& options) {
  checkBytes(file.size(), options, what);
  const OctomapHeader header = readOctomapHeader(file, what);
  const std::string_view data = file.substr(header.data_offset);
  if (data.empty() && header.nodes > 0) {
    throw Refusal(Code::truncated,
                  what + " has no nodes after its header, but its header has size " + std::to_string(header.nodes));
  }
  Octomap map = readOctomapData(header.format, data, what, options);
  if (map.nodes != header.nodes) {
    throw Refusal(Code::parse, what + " has " + std::to_string(map.nodes) + " nodes, but its header has size " +
                                   std::to_string(header.nodes) + "; both must be the same");
  }
  return map;
}

Octomap readOctomapFile(const OpenResource& file, const OctomapOptions& options) {
  const std::string what = "map '" + printable(file.path()) + "'";
  checkBytes(file.bytes(), options, what);
  const std::string bytes = withinMemory(what, [&] { return bytesOf(file, what); });
  return readOctomap(bytes, what, options);
}

}  // namespace hgrid
