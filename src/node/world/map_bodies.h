// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "node/params/params.h"
#include "node/sources/loaded_map.h"
#include "node/sources/map_news.h"
#include "node/sources/source_id.h"

namespace hgrid {

/// Returns the body of a map, without its cells.
/// @throws Refusal nonfinite or out_of_range if the map's position in its frame is beyond ~limits/world_limit
Body mapBodyOf(const LoadedMap& map, const std::string& world_frame, const Params& params);

/// Stores which maps are in the world, their poses in their frames, and whether their cells can be trusted.
///
/// Copies are cheap. To make a change, modify a copy and then swap() it with the original.
class MapBodies {
 public:
  /// @param simulated  whether /clock drives ROS time
  explicit MapBodies(bool simulated) : news_(simulated) {}

  bool has(const SourceId& map) const { return seats_.count(map) != 0; }
  std::size_t size() const { return seats_.size(); }
  /// Whether the map is already in the world at the same pose in the same frame, so that only its cells change.
  bool hasSame(const SourceId& map, const Body& body) const;
  /// Notes that the map is now in the world.
  void set(const SourceId& map, const Body& body, const LoadedMap& loaded);
  /// Removes the maps for which `chosen` returns true, because they are no longer in the world.
  template <class Chosen>
  void eraseIf(const Chosen& chosen) {
    for (auto one = seats_.begin(); one != seats_.end();) {
      if (chosen(one->first)) news_.forget(one->first.name);
      one = chosen(one->first) ? seats_.erase(one) : std::next(one);
    }
  }
  /// Notes that the newest message of the map could not be used. @returns false if the map is not in the world
  bool noteRefused(const SourceId& map, const std::string& sentence);
  /// Returns a SourceGap for each map whose cells cannot be trusted, sorted by name.
  std::vector<SourceGap> gaps(const Moment& now) const { return news_.gaps(now); }

  void swap(MapBodies& other) noexcept;

 private:
  /// The pose of a map in its frame.
  struct Seat {
    std::string frame;
    Pose frame_from_map = Pose::Identity();
  };

  std::map<SourceId, Seat> seats_;
  MapNews news_;
};

}  // namespace hgrid
