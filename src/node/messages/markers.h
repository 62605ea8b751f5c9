// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <mutex>
#include <optional>
#include <vector>

#include "hgrid_proximity/queries/query_answer.h"
#include "node/tick/tick.h"

namespace hgrid {

/// The last question of each kind, to be drawn. Any thread.
class QuerySketch {
 public:
  void show(const Sphere& sphere, Verdict verdict);
  void show(const Segment& segment, Verdict verdict);

  template <class Geometry>
  struct Drawn {
    Geometry geometry;  // [m, world frame]
    Verdict verdict;
    std::chrono::steady_clock::time_point at;
  };
  std::optional<Drawn<Sphere>> sphere() const;
  std::optional<Drawn<Segment>> segment() const;

 private:
  mutable std::mutex mutex_;
  std::optional<Drawn<Sphere>> sphere_;
  std::optional<Drawn<Segment>> segment_;
};

/// What RViz draws of a tick, in the world frame: namespace "boxes" (one colour per grid level), "not_fresh" (boxes of
/// bodies that are not, red), "pairs" (a line between the nearest points of each near pair's boxes), "distances" (a
/// line between the nearest points of the shapes of each measured pair, from green at the report distance to red in
/// contact), "distance_texts" (the distance beside each such line [mm]), "queries". Every marker has a stable id and is
/// replaced, or deleted where there is nothing to draw.
/// @param distances  of the tick's snapshot; null: not measured
visualization_msgs::MarkerArray markers(const Tick& tick, const QuerySketch& queries, const PairDistances* distances);

/// Deletes all of them: for the first message to a new viewer.
visualization_msgs::MarkerArray markersGone(const Tick& tick);

}  // namespace hgrid
