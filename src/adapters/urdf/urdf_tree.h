// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

namespace hgrid {

/// Checks that the links and joints of a URDF form one tree. urdfdom does not check all of these rules:
///
/// - Names are unique.
/// - Every joint connects two different links that exist.
/// - Every link except the root is the child of exactly one joint.
/// - Every link is reachable from the root.
/// - Elements of xacro are not within links and joints.
/// @param warnings  gets a sentence for each element of xacro that is ignored
/// @throws Refusal with code parse; its sentence names the link or joint
void checkTree(const tinyxml2::XMLElement& robot, std::vector<std::string>& warnings);

}  // namespace hgrid
