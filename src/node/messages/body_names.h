// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"

namespace hgrid {

/// Stands for "no body" in messages with lists of bodies.
inline constexpr std::uint32_t kNoBody = 4294967295u;

/// Replaces indices of bodies by indices into `names`. kNoBody remains.
/// @param names  receives the names of all these bodies, each once, sorted
void nameBodies(const BodyList& bodies, std::initializer_list<std::vector<std::uint32_t>*> lists,
                std::vector<std::string>& names);

}  // namespace hgrid
