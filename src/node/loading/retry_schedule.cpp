// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/retry_schedule.h"

#include <algorithm>

namespace hgrid {

void RetrySchedule::noteTry(Time now) {
  pause_ = std::clamp(2 * pause_, kFirstPause, kLongestPause);
  next_ = now + pause_;
}

}  // namespace hgrid
