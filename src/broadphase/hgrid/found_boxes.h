// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "broadphase/hgrid/layer.h"
#include "broadphase/hgrid/loose_boxes.h"
#include "broadphase/hgrid/position_writer.h"
#include "geometry/rounding.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {

inline kernels::Box boxOf(const Aabb& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

inline bool overlap(const kernels::Box& a, const kernels::Box& b) {
  bool both = true;
  for (int axis = 0; axis < 3; ++axis) both = both & (a.min[axis] <= b.max[axis]) & (b.min[axis] <= a.max[axis]);
  return both;
}

/// Returns a box that contains the sphere. The box may be slightly too large, because the found boxes are then tested
/// against the sphere itself.
inline kernels::Box boxOf(const Sphere& sphere) {
  // The sum is computed beside the corners, not before them: a query into empty space takes hardly longer than this.
  const double slack = 2.0 * roundingSlack(sphere.center.lpNorm<1>() + sphere.radius) + kFloatRoundingNearZero;
  kernels::Box box;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kRounding = 2.5e-7;  // allows for two roundings to float
    const double center = sphere.center[axis];
    const auto grown = static_cast<float>((std::abs(center) + sphere.radius) * kRounding + slack);
    box.min[axis] = static_cast<float>(center - sphere.radius) - grown;
    box.max[axis] = static_cast<float>(center + sphere.radius) + grown;
  }
  return box;
}

/// Converts a segment for the kernels.
inline kernels::Line lineOf(const Segment& segment) {
  kernels::Line line;
  const double reach = std::max(segment.from.cwiseAbs().maxCoeff(), segment.to.cwiseAbs().maxCoeff()) + segment.radius;
  line.around = segment.radius + 4.0 * roundingSlack(reach);
  for (int axis = 0; axis < 3; ++axis) {
    line.from[axis] = segment.from[axis];
    line.step[axis] = segment.to[axis] - segment.from[axis];
  }
  return line;
}

// Each searchLayer() searches the levels of a layer and writes positions.
inline void searchLayer(const kernels::Kernels& loops, const Layer& layer, const kernels::Box& query,
                        kernels::PositionSink* sink) {
  const kernels::LevelSet levels = layer.querySet();
  if (layer.occupancy().mayOverlap(query)) loops.overlapping(&levels, &query, sink);
}
inline void searchLayer(const kernels::Kernels& loops, const Layer& layer, const Sphere& query,
                        kernels::PositionSink* sink) {
  if (!layer.occupancy().mayBeNear(query.center.data(), touchingDistance(query))) return;
  const kernels::LevelSet levels = layer.querySet();
  const kernels::Box box = boxOf(query);
  loops.overlapping(&levels, &box, sink);
}
inline void searchLayer(const kernels::Kernels& loops, const Layer& layer, const Segment& query,
                        kernels::PositionSink* sink) {
  const kernels::LevelSet levels = layer.querySet();
  const kernels::Line line = lineOf(query);
  if (layer.occupancy().mayTouch(line)) loops.along(&levels, &line, sink);
}

// Each searchSingles() searches the table of the loose boxes, and writes places.
inline void searchSingles(const LooseBoxes& boxes, const kernels::Box& query, kernels::PositionSink* sink) {
  boxes.overlapping(query, sink);
}
inline void searchSingles(const LooseBoxes& boxes, const Sphere& query, kernels::PositionSink* sink) {
  boxes.overlapping(boxOf(query), sink);
}
inline void searchSingles(const LooseBoxes& boxes, const Segment& query, kernels::PositionSink* sink) {
  boxes.along(lineOf(query), sink);
}

/// Calls visit(boxes, places) for each layer in which a search finds boxes. `boxes` is a Layer and the places are
/// positions, or it is LooseBoxes, which are searched in place of the loose layer. Both have the functions boxAt(place)
/// and idAt(place).
/// @param query  a box, a sphere or a segment. The search may find a few boxes more than those that touch it
template <class Engine, class Query, class Visit>
__attribute__((noinline)) void visitFound(const Engine& engine, const Query& query, const Visit& visit) {
  for (std::size_t number = 0; number < engine.layers.size(); ++number) {
    PositionWriter writer;
    if (number == Engine::kLoose && engine.isHashed()) {
      searchSingles(engine.singles, query, writer.sink());
      if (writer.size() != 0) visit(engine.singles, writer);
      continue;
    }
    const Layer& layer = engine.layers[number];
    if (layer.isEmpty()) continue;
    searchLayer(*engine.loops, layer, query, writer.sink());
    if (writer.size() != 0) visit(layer, writer);
  }
}

}  // namespace hgrid
