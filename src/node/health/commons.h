// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/health/ledger.h"
#include "node/health/node_health.h"
#include "node/params/settings.h"

namespace hgrid {

/// Objects that nearly every part of the node uses. Any thread may use them.
struct Commons {
  Settings settings;  ///< those of the start of the node; Tick::settings has those that changed since then
  std::shared_ptr<NarrowPhase> narrow_phase;
  Ledger ledger;
  NodeHealth health;
};

}  // namespace hgrid
