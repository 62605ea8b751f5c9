// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"

namespace hgrid {

/// Pointers to names, in any order. A name is "source/local".
using NameList = std::vector<const std::string*>;

/// So many names, even long ones, are compared in less than 1 ms. A tick may wait so long if it refuses a change.
constexpr std::size_t kQuicklyCompared = 300;

/// Returns up to three of the names that are most similar to `name`, the most similar first.
///
/// A name is similar if few bytes of all of it, or of the part after the source, must be replaced, removed or added to
/// get `name`. The result is empty if no name is similar, or if there are too many names to compare all of them.
std::vector<std::string> nearestNames(const std::string& name, const NameList& names);

/// Returns the end of an error sentence: "; similar names are 'robot/gripper'". Empty if no name is similar.
std::string similarNames(const std::string& name, const NameList& names);
std::string similarNames(const std::string& name, const BodyList& bodies);

/// Returns the error sentence for a name that no body has. It lists similar names.
std::string noSuchBody(const std::string& name, const BodyList& bodies);

}  // namespace hgrid
