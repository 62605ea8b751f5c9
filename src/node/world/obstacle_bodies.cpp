// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/obstacle_bodies.h"

#include <utility>

#include "node/sources/body_params.h"

namespace hgrid {

ObstacleBodies::ObstacleBodies(const Params& params, std::shared_ptr<NarrowPhase> narrow_phase, Ledger& ledger)
    : params_(params), narrow_phase_(std::move(narrow_phase)), ledger_(ledger) {}

Body ObstacleBodies::bodyOf(const ObstacleParams& configured, const std::string& world_frame) const {
  Body body = configured.body;
  if (body.frame.empty()) body.frame = world_frame;
  body.mobility = body.frame == world_frame ? Mobility::fixed : Mobility::moving;
  applyMaxSpeed(params_, body);
  applyPatterns(params_, body);
  makeSolids(*narrow_phase_, body);
  return body;
}

void ObstacleBodies::addAll(const std::string& world_frame, Movers& movers, MissingSources& missing) {
  while (done_ < params_.obstacles.size()) {
    const ObstacleParams& configured = params_.obstacles[done_];
    const SourceId source = SourceId::ofObstacle(configured.body.name);
    try {
      movers.add(source, bodyOf(configured, world_frame));
      ++done_;
    } catch (const Refusal& refusal) {
      missing.set(source, std::string(name(refusal.code())) + " " + refusal.what());
      ++done_;
      ledger_.refuse("obstacles.refused", refusal);
    }
  }
}

}  // namespace hgrid
