// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {
namespace bench {

/// Measures how many times faster two threads are than one thread. They add numbers in registers and use no memory.
///
/// The result is near 2 if two processors are free. It is near 1 if the two processors are hardware threads of one
/// core, or if other programs use them. A virtual machine cannot know which of these is true, and this can change every
/// second. No other computation gains much more than this result from a second thread.
/// @returns the median of five trials; this takes about 5 ms
double gainOfTwoProcessors();

}  // namespace bench
}  // namespace hgrid
