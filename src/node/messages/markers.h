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

/// Stores the last sphere query and the last segment query, so that ~markers can show them. Any thread may use it.
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

/// Returns markers that show a tick in RViz, in the world frame. Their namespaces are:
/// - "boxes": the boxes of all shapes, with one color for each level of the grid;
/// - "not_fresh": the boxes of bodies that are STALE or worse, in red;
/// - "pairs": a line between the nearest points of the boxes of each pair;
/// - "distances": a line between the nearest points of the shapes of each measured pair, from green (the farthest pair)
///   to red (in contact);
/// - "distance_texts": the distance [mm] beside such lines;
/// - "queries": the last queries.
/// Each marker has a fixed id, so that a new message replaces it. A marker without content deletes the old one.
/// @param distances  the distances of the tick's snapshot; null: they were not measured
visualization_msgs::MarkerArray markers(const Tick& tick, const QuerySketch& queries, const PairDistances* distances);

/// Returns a message that deletes all markers. It is the first message for a new subscriber.
visualization_msgs::MarkerArray markersGone(const Tick& tick);

}  // namespace hgrid
