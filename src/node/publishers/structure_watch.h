// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "node/tick/tick.h"

namespace hgrid {

/// Detects changes of the structure of the world: bodies, margins and rules. One thread may use it.
class StructureWatch {
 public:
  /// @returns true for the first tick, and if the epoch or the revision of the structure is not that of the last call
  bool changed(const Tick& tick) {
    const std::uint64_t revision = tick.snapshot ? tick.snapshot->structure().revision : 0;
    if (revision == revision_ && tick.epoch == epoch_) return false;
    revision_ = revision;
    epoch_ = tick.epoch;
    return true;
  }

 private:
  std::uint64_t revision_ = 0, epoch_ = 0;  // an epoch is never 0
};

}  // namespace hgrid
