// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/adapters/urdf.h"

namespace hgrid {
namespace test {

/// Checks a model that was read from the text of a URDF. All numbers must be valid, and parents must come before their
/// children. Every <collision> must be a shape or be listed as unreadable. If urdfdom reads the whole text without an
/// error, it must find the same links, joints and shapes.
/// @returns what is wrong with the model; empty if nothing is wrong
std::string flawOf(const RobotModel& model, const std::string& urdf);

}  // namespace test
}  // namespace hgrid
