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

/// Replaces indices of bodies in the snapshot by indices into `names`. Does not replace kNoBody.
/// @param names  must be empty; receives the names of all bodies in `lists`, each once, sorted
void nameBodies(const BodyList& bodies, std::initializer_list<std::vector<std::uint32_t>*> lists,
                std::vector<std::string>& names);

}  // namespace hgrid
