// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Returns whether the body can be anywhere, because its position or its size is not bounded.
bool canBeAnywhere(const Body& body, const BodyPose& pose);

/// Returns a sentence that says why a body may be elsewhere than at its pose, or may have more shapes than are known.
std::string doubtOf(const Body& body, const BodyPose& pose);

}  // namespace hgrid
