// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Names of the few bodies that are called nearly so: with few letters exchanged, left out or added, in the whole name
/// or in what comes after its source. The nearest first; none where nothing is like it, or where there are so many
/// bodies that comparing would take long.
std::vector<std::string> nearestNames(const std::string& name, const std::vector<Body>& bodies);

/// The sentence for a name that no body has.
std::string noSuchBody(const std::string& name, const std::vector<Body>& bodies);

}  // namespace hgrid
