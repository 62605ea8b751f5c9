// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/body_params.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {

double lastMatch(const std::vector<PatternValue>& values, const std::string& name, double otherwise) {
  for (const PatternValue& value : values) {
    if (matches(value.pattern, name)) otherwise = value.value;
  }
  return otherwise;
}

void applySpeedBound(const Params& params, Body& body) {
  body.speed_bound = lastMatch(params.max_speed, body.name, std::numeric_limits<double>::infinity());
}

void applyPatterns(const Params& params, Body& body) {
  body.margin = lastMatch(params.margins, body.name, 0.0);
  applySpeedBound(params, body);
  const double padding = lastMatch(params.padding, body.name, 0.0);
  for (BodyShape& shape : body.shapes) shape.padding = padding;
}

void applyMaxSpeed(const Params& params, Body& body) {
  body.max_speed = lastMatch(params.max_speed, body.name, params.default_max_speed);
}

void makeSolids(NarrowPhase& narrow_phase, Body& body) {
  for (BodyShape& shape : body.shapes) shape.solid = narrow_phase.solidOf(shape.shape);
}

void applyObstacleParams(const Params& params, double margin, double max_speed, Body& obstacle) {
  std::vector<double> paddings;
  for (const BodyShape& shape : obstacle.shapes) paddings.push_back(shape.padding);
  applyMaxSpeed(params, obstacle);
  applyPatterns(params, obstacle);  // replaces the paddings
  for (std::size_t i = 0; i < paddings.size(); ++i) {
    obstacle.shapes[i].padding = std::max(obstacle.shapes[i].padding, paddings[i]);
  }
  if (margin > 0.0) obstacle.margin = margin;
  if (max_speed > 0.0) obstacle.max_speed = obstacle.speed_bound = max_speed;
}

void completeObstacle(const Params& params, double margin, double max_speed, NarrowPhase& narrow_phase,
                      Body& obstacle) {
  applyObstacleParams(params, margin, max_speed, obstacle);
  makeSolids(narrow_phase, obstacle);
}

}  // namespace hgrid
