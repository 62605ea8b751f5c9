// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

#include "node/tick/tick.h"

namespace hgrid {

/// The tick that an answer is made from: the newest tick when the request arrived, or a later one that contains the
/// change that the request made.
class AnswerTick {
 public:
  /// @param tick  null before the first tick
  explicit AnswerTick(std::shared_ptr<const Tick> tick);

  /// Returns the tick; null before the first tick.
  const std::shared_ptr<const Tick>& get() const { return tick_; }
  /// Returns the time [s] from the computation of the tick to the construction of this object. 0 before the first tick.
  double age() const { return age_; }
  /// Returns the snapshot of the tick. @throws Refusal not_ready before the first tick and while there is no world
  const Snapshot& snapshot() const;
  /// Returns why an answer about the present cannot be CLEAR, as a sentence: the tick is older than ~valid_for. Returns
  /// an empty string if the tick is recent enough. There must be a tick.
  std::string whyOutdated() const;

 private:
  std::shared_ptr<const Tick> tick_;
  double age_ = 0.0;
};

}  // namespace hgrid
