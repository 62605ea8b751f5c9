// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <sys/types.h>

namespace hgrid {
namespace bench {

/// Returns the processor time [s] that a process has used.
double processorTime(pid_t process);
/// Returns the processor time [s] that all programs have used on all processors. It includes the time that the host of
/// a virtual machine gave to others.
double processorTimeOfAll();

}  // namespace bench
}  // namespace hgrid
