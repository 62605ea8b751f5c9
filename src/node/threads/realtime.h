// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// Whether the process may lock memory without a limit. With a limit, later allocations would fail when they reach it.
bool mayLockAllMemory();

/// Gives the calling thread a real-time priority (SCHED_FIFO), and keeps all memory of the process in RAM (mlockall).
/// Does neither if the process lacks one of the two rights.
/// @param priority   1 .. 99
/// @param may_lock   whether the process has the right to lock all memory
/// @throws Refusal resource_denied if a right is missing; says which one and how to get it
void makeRealtime(int priority, bool may_lock = mayLockAllMemory());

}  // namespace hgrid
