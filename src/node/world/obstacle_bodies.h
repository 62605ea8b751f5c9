// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/diagnostics/ledger.h"
#include "node/params/params.h"
#include "node/world/missing_sources.h"
#include "node/world/movers.h"

namespace hgrid {

/// Adds the configured obstacles to the world, as soon as there is a world frame.
class ObstacleBodies {
 public:
  ObstacleBodies(const Params& params, std::shared_ptr<NarrowPhase> narrow_phase, Ledger& ledger);

  /// Adds the obstacles that were not added yet. A refused obstacle becomes a missing source. If this throws, the next
  /// call continues with the obstacle that failed.
  void addAll(const std::string& world_frame, Movers& movers, MissingSources& missing);
  /// Makes the next addAll() begin with the first obstacle again.
  void startAgain() noexcept { done_ = 0; }

 private:
  Body bodyOf(const ObstacleParams& configured, const std::string& world_frame) const;

  const Params& params_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  Ledger& ledger_;
  std::size_t done_ = 0;  // number of obstacles that were added or refused
};

}  // namespace hgrid
