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

/// Judges whether the cells of each map can be trusted, by the messages that brought them.
///
/// A map is not complete if its newest message was refused, or if no message arrived for longer than its max_age. One
/// thread.
class MapNews {
 public:
  /// @param simulated  /clock drives ROS time, and ages are counted by it; otherwise they are counted by the steady
  /// clock
  explicit MapNews(bool simulated) : simulated_(simulated) {}

  /// The cells of this map are in the world now.
  /// @param body  name of the map's body, here and in the other functions
  void noteAccepted(const std::string& body, const LoadedMap& map);
  /// The newest message of a map that is in the world could not be used.
  void noteRefused(const std::string& body, const std::string& sentence);
  void forget(const std::string& body) { news_.erase(body); }

  /// [s] Age of the newest cells of a map; 0 for a map that is not known.
  double ageOf(const std::string& body, const Moment& now) const;
  /// One gap for each map whose cells cannot be trusted.
  std::vector<SourceGap> gaps(const Moment& now) const;

 private:
  struct News {
    double max_age = 0.0;  // [s] 0: off
    double latency = 0.0;  // [s] age of the message when it arrived
    Moment received;
    std::string refused;  // why the newest message could not be used; empty: it could
  };
  double ageOf(const News& news, const Moment& now) const;

  bool simulated_;
  std::map<std::string, News> news_;  // by name of the body
};

}  // namespace hgrid
