// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {
namespace bench {

/// Measures how many times faster two threads are than one with a loop that adds registers and touches no memory.
///
/// The result is near 2 if two processors are free. It is near 1 if both are hardware threads of one core, or if other
/// programs use them. A virtual machine cannot find out which is the case, and it may change from one second to the
/// next. No computation can gain much more than this from a second thread.
/// @returns the median of five trials; this takes about 5 ms
double gainOfTwoProcessors();

}  // namespace bench
}  // namespace hgrid
