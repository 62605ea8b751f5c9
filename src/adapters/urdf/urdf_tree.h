// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tinyxml2.h>

namespace hgrid {

/// Checks that a URDF's links and joints form one tree: names are unique, every joint joins two links that exist,
/// every link but one hangs on one joint, and all hang together. urdfdom overlooks some of these.
/// @throws Refusal parse, naming the link or joint
void checkTree(const tinyxml2::XMLElement& robot);

}  // namespace hgrid
