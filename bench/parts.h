// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "bench/measure/record.h"
#include "bench/options.h"

namespace hgrid {
namespace bench {

/// All pairs, frame by frame: every workload, number of boxes and fraction that moves.
void runPairs(const Options& options, std::vector<Record>& records);

/// Frames late in the life of HGrid and of FCL's tree beside early ones.
void runAgeing(const Options& options, std::vector<Record>& records);

/// HGrid with two threads against HGrid with one, turn by turn, beside what two processors are worth at that time.
void runThreads(const Options& options, std::vector<Record>& records);

/// Queries of every kind against resting boxes, one by one and batched.
void runQueries(const Options& options, std::vector<Record>& records);

/// Maps: how they are loaded, what they hold, and questions about their leaves, beside OctoMap and FCL.
void runMaps(const Options& options, std::vector<Record>& records);

}  // namespace bench
}  // namespace hgrid
