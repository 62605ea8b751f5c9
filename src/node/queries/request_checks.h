// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "node/params/params.h"

namespace hgrid {

// Checks of fields that several kinds of requests have.

/// Checks globs over names of bodies. @throws Refusal limit if there are too many, bad_id if one is too long
void checkPatterns(const std::vector<std::string>& patterns);

/// Returns when the time of a request is over; nullopt: there is no limit.
/// @throws Refusal out_of_range unless max_time [s] is 0 or positive
std::optional<std::chrono::steady_clock::time_point> deadlineOf(double max_time);

/// Returns when the time of a request with many questions is over.
/// @param max_time  [s] 0, or more than 10, means 10
/// @throws Refusal out_of_range if max_time is negative or NaN
std::chrono::steady_clock::time_point batchDeadlineOf(double max_time);

/// Checks the number of questions of a request. @param what  names the questions in the error sentence
/// @throws Refusal limit if there are more than ~limits/max_batch
void checkBatch(const char* what, std::size_t count, const Params& params);

}  // namespace hgrid
