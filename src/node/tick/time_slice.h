// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// Asks the system to let the calling thread run soon after it wakes up, for short times, also while other programs are
/// busy. Its share of a processor stays the same. Threads that it creates later inherit this.
///
/// Needs Linux 6.12 or newer (sched_attr::sched_runtime of a thread without a real-time priority) and no right. Does
/// nothing if the system does not know it.
void askForShortTimeSlices();

}  // namespace hgrid
