// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/source.h"
#include "node/sources/loaded_map.h"
#include "node/time/clock_watch.h"

namespace hgrid {

/// Decides from the messages of each map whether its cells can be trusted.
///
/// A map is not complete if its newest message was refused, or if its newest message is older than its max_age. Only
/// one thread may use this class.
class MapNews {
 public:
  /// @param simulated  whether /clock drives ROS time. If so, ages are measured in ROS time, otherwise by the steady
  /// clock.
  explicit MapNews(bool simulated) : simulated_(simulated) {}

  /// Notes that the cells of this map are now in the world.
  /// @param body  name of the map's body, here and in the other functions
  void noteAccepted(const std::string& body, const LoadedMap& map);
  /// Notes that the newest message of a map that is in the world could not be used.
  void noteRefused(const std::string& body, const std::string& sentence);
  void forget(const std::string& body) { news_.erase(body); }

  /// Returns the age of the cells of a map [s]. For an unknown map, returns 0.
  double ageOf(const std::string& body, const Moment& now) const;
  /// Returns a SourceGap for each map whose cells cannot be trusted.
  std::vector<SourceGap> gaps(const Moment& now) const;

 private:
  struct News {
    double max_age = 0.0;  // [s] 0: no limit
    double latency = 0.0;  // [s] age of the message when it arrived
    Moment received;
    std::string refused;  // why the newest message could not be used; empty: it could
  };
  double ageOf(const News& news, const Moment& now) const;

  bool simulated_;
  std::map<std::string, News> news_;  // the key is the name of the body
};

}  // namespace hgrid
