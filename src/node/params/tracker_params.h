// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "node/params/param_value.h"
#include "node/params/params.h"

namespace hgrid {

/// Reads ~tracks, a list of trackers.
/// @param params  limits for the sizes of shapes and the number of triangles
std::vector<TrackerParams> readTrackers(ParamValue value, const Params& params);

}  // namespace hgrid
