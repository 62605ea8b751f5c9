// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/time/age_clock.h"

#include <algorithm>

namespace hgrid {

Time AgeClock::read(const Moment& moment) const {
  if (!simulated_) return std::chrono::duration_cast<Time>(moment.steady.time_since_epoch());
  if (frozen_) return reading_ + std::chrono::duration_cast<Time>(moment.steady - last_.steady);
  return reading_ + std::max(Time(0), moment.ros - last_.ros);
}

void AgeClock::look(const Moment& now, bool frozen) {
  reading_ = read(now);
  const bool began = last_.ros.count() > 0;
  if (began && now.ros < last_.ros) reading_ += std::chrono::duration_cast<Time>(now.steady - last_.steady);
  if (now.ros != last_.ros) advanced_ = now.steady;
  if (frozen && !frozen_) reading_ += std::chrono::duration_cast<Time>(now.steady - advanced_);
  frozen_ = frozen;
  last_ = now;
}

}  // namespace hgrid
