// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <vector>

#include "node/wire/scene_types.h"
#include "node/world/matrix_rules.h"

namespace hgrid {

/// Returns what an allowed collision matrix says about pairs that may touch, in MoveIt's sense: an entry of two names
/// takes precedence over the defaults of the names. Two names may touch if both of their entries say so. Pairs that may
/// not touch need no rule, unless the default of one of the names says the opposite.
/// @param most  maximum number of rules
/// @throws Refusal bad_id for a name that is not valid or contains a glob, dup_id for a name that occurs twice, parse
/// if the lists have different lengths, limit if there are too many rules
std::vector<MatrixRule> matrixRulesOf(const moveit::AllowedCollisionMatrix& matrix, std::size_t most);

/// Returns the matrix that the rules stand for.
moveit::AllowedCollisionMatrix matrixMessage(const std::vector<MatrixRule>& rules);

}  // namespace hgrid
