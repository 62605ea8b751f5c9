// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <memory>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "hgrid_proximity/partitions/broad_phase_type.h"

namespace hgrid {

/// The settings that makeBroadPhase() needs.
struct BroadPhaseOptions {
  BroadPhaseType type = BroadPhaseType::hgrid;  ///< the kind
  double finest_edge = 0.0625;  ///< [m] GridScale::finest_edge, for `hgrid`; the others compute their cells themselves
  int threads = 1;              ///< HGrid::setThreads(), for `hgrid`; the others use one thread
};

/// Creates an empty broad phase.
/// @throws std::invalid_argument if an option is out of range, see HGrid
std::unique_ptr<BroadPhase> makeBroadPhase(const BroadPhaseOptions& options);

/// Returns the memory [bytes] of all data that a broad phase of makeBroadPhase() stores.
std::size_t storedBytes(const BroadPhase& broad_phase);

}  // namespace hgrid
