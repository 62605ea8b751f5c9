// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "bench/measure/record.h"
#include "bench/states/state_contest.h"

namespace hgrid {
namespace bench {

/// Measures edges: hgrid proves that all configurations are free or finds the first contact, and FCL tests one
/// configuration each 1 cm of motion. Compares the verdicts one by one, and prints what the samples miss.
/// @param clear  states without contact, as values of the group
void raceEdges(StateContest& contest, std::size_t boxes, const std::vector<double>& clear, int turns,
               std::vector<Record>& records);

}  // namespace bench
}  // namespace hgrid
