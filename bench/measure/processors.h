// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {
namespace bench {

/// How much sooner two threads end twice a piece of work than one thread does, for a loop that adds registers and
/// touches no memory: near 2 on two processors of one's own. Near 1 where both are hardware threads of one core, or
/// where others use them; a virtual machine is told neither, and both may change from one second to the next. Nothing
/// that computes can gain much more than this from a second thread. Takes about 5 ms; the median of five trials.
double gainOfTwoProcessors();

}  // namespace bench
}  // namespace hgrid
