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

/// Makes the body of a map, without its cells.
/// @throws Refusal nonfinite or out_of_range if the map's position in its frame is beyond ~world_limit
Body mapBodyOf(const LoadedMap& map, const std::string& world_frame, const Params& params);

/// Knows which maps are in the world, where they are in their frames, and whether their cells can be trusted.
///
/// A copy is cheap: a change is made in a copy, which then replaces this by swap().
class MapBodies {
 public:
  /// @param simulated  as in MapNews
  explicit MapBodies(bool simulated) : news_(simulated) {}

  bool has(const SourceId& map) const { return seats_.count(map) != 0; }
  /// Whether the map is in the world already, at the same pose in the same frame: then only its cells change.
  bool hasSame(const SourceId& map, const Body& body) const;
  /// The map is in the world now.
  void set(const SourceId& map, const Body& body, const LoadedMap& loaded);
  /// The maps for which `chosen` is true are no longer in the world.
  template <class Chosen>
  void eraseIf(const Chosen& chosen) {
    for (auto one = seats_.begin(); one != seats_.end();) {
      if (chosen(one->first)) news_.forget(one->first.name);
      one = chosen(one->first) ? seats_.erase(one) : std::next(one);
    }
  }
  /// The newest message of the map could not be used. @returns false if the map is not in the world
  bool noteRefused(const SourceId& map, const std::string& sentence);
  /// A gap for each map whose cells cannot be trusted, in the order of their names.
  std::vector<SourceGap> gaps(const Moment& now) const { return news_.gaps(now); }

  void swap(MapBodies& other) noexcept;

 private:
  /// Where a map is.
  struct Seat {
    std::string frame;
    Pose frame_from_map = Pose::Identity();
  };

  std::map<SourceId, Seat> seats_;
  MapNews news_;
};

}  // namespace hgrid
