// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/bodies/link_matrix.h"

namespace hgrid {

/// Reads what an SRDF says of collisions: disable_collisions, disable_default_collisions, enable_collisions.
/// @throws Refusal parse, limit, unsupported
LinkRules readSrdf(const std::string& xml, const DescriptionLimits& limits = {});

}  // namespace hgrid
