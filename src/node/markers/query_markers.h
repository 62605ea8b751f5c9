// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <chrono>
#include <mutex>
#include <optional>
#include <vector>

#include "hgrid_proximity/queries/query_answer.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Stores the last sphere query and the last segment query for the markers. Any thread may use it.
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

/// Returns markers for the queries of the last 3 s, in namespace "queries". The color shows the verdict: orange HIT,
/// green CLEAR, gray UNKNOWN.
std::vector<visualization_msgs::Marker> queryMarkers(const Tick& tick, const QuerySketch& queries);

}  // namespace hgrid
