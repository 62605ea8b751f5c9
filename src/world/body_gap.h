// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Returns why a body makes its source incomplete, such as "LOST robot/tool0: its pose is 3 s old (frame 'tool0')".
/// The text is empty if the body does not make its source incomplete.
std::string gapLeftBy(const Body& body, const BodyPose& pose);

/// Returns why a pose is INVALID, as the beginning of a sentence that ends with the age of the pose. Returns an empty
/// text for all other states.
std::string causeOf(Freshness state);

}  // namespace hgrid
