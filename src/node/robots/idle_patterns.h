// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "node/params/params.h"

namespace hgrid {

/// Returns a warning for each pattern in the parameters that matches no name, so that users notice misspelled names.
/// Patterns that can match a track of a configured tracker, and patterns for maps, are not reported: tracks and maps
/// come and go at run time.
/// @param bodies             names of the bodies
/// @param without_collision  names of the links without a body; ~accept_uncovered and ~use_visual may match them
std::vector<std::string> idlePatterns(const Params& params, const std::vector<std::string>& bodies,
                                      const std::vector<std::string>& without_collision);

/// Returns a warning for each margin of ~margins and ~pair_margins that has no effect.
std::vector<std::string> idleMargins(const Params& params);

}  // namespace hgrid
