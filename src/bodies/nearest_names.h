// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"

namespace hgrid {

/// Returns the names of up to three bodies that are most similar to `name`, the most similar first.
///
/// A body is similar if few bytes of its whole name, or of the part after the source, must be replaced, removed or
/// added to get `name`. The list is empty if no name is similar, or if there are too many bodies to compare all names.
std::vector<std::string> nearestNames(const std::string& name, const BodyList& bodies);

/// Returns the end of an error sentence: "; similar names are 'robot/gripper'". Empty if no name is similar.
std::string similarNames(const std::string& name, const BodyList& bodies);

/// Returns the error sentence for a name that no body has. It lists similar names.
std::string noSuchBody(const std::string& name, const BodyList& bodies);

}  // namespace hgrid
