// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "node/params/params.h"

namespace hgrid {

/// Warns of each pattern in the parameters that matches no name. Without such a warning, nobody would notice a
/// misspelled name. Patterns for maps are not checked, because maps come and go.
/// @param bodies             names of the bodies
/// @param without_collision  names of the links that have no body. ~accept_uncovered and ~use_visual may mean them.
std::vector<std::string> idlePatterns(const Params& params, const std::vector<std::string>& bodies,
                                      const std::vector<std::string>& without_collision);

}  // namespace hgrid
