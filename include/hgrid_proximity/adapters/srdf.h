// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/bodies/joint_groups.h"
#include "hgrid_proximity/bodies/link_matrix.h"

namespace hgrid {

/// Reads the collision rules of an SRDF: disable_collisions, disable_default_collisions and enable_collisions.
/// @throws Refusal in the same cases as checkXml(); parse also if a tag lacks an attribute
LinkRules readSrdf(const std::string& xml, const DescriptionLimits& limits = {});

/// Reads the groups of joints and the virtual joints of an SRDF.
/// @throws Refusal in the same cases as checkXml(); parse also if a tag lacks an attribute, or if the type of a virtual
/// joint is not fixed, planar or floating
JointGroups readJointGroups(const std::string& xml, const DescriptionLimits& limits = {});

}  // namespace hgrid
