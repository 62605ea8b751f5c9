// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hgrid {

/// The frame that an obstacle names if messages of ~poses move it.
inline constexpr const char* kPosesFrame = "~poses";

/// Returns the name of the tf frame that such an obstacle follows: "~poses/part" for the obstacle "obstacle/part".
std::string posesFrameOf(const std::string& obstacle);

/// Converts messages of ~poses into messages of /tf. So the rules for transforms hold for these poses as well: checks,
/// freshness, interpolation, several publishers and the record of the audit.
///
/// Only one thread at a time may use this object.
class PosesConverter {
 public:
  /// Number of lists of names that are stored. A further one replaces the one that was not used for longest.
  static constexpr std::size_t kMostLists = 100;

  /// @param most_names  largest number of names in one message, and a quarter of the number of all stored names
  /// @param most_bytes  largest size of the result
  PosesConverter(std::size_t most_names, std::size_t most_bytes) : most_names_(most_names), most_bytes_(most_bytes) {}

  /// Returns the bytes of a tf2_msgs/TFMessage with a transform for each pose.
  /// @param bytes      a serialized hgrid_proximity/Poses
  /// @param publisher  name of the node that sent it; each publisher has its own lists of names, one for each version
  /// @throws Refusal truncated; limit; bad_id for a name; unknown_id if the message has no names and those of its
  /// version are not stored; out_of_range for an index; bad_geometry if the lists have different lengths
  std::string toTransforms(const std::string& bytes, const std::string& publisher);

 private:
  using Key = std::pair<std::string, std::uint32_t>;  // publisher and version
  struct Names {
    std::vector<std::string> frames;  // names of the tf frames
    std::uint64_t used = 0;           // number of the newest message that used the names
  };
  void store(const Key& key, std::vector<std::string> frames);

  const std::size_t most_names_, most_bytes_;
  std::map<Key, Names> lists_;
  std::size_t stored_ = 0;  // number of all stored names
  std::uint64_t messages_ = 0;
};

}  // namespace hgrid
