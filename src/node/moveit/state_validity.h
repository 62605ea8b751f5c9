// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/moveit/validity_types.h"
#include "node/services/envelope/answer_tick.h"
#include "node/tf/transform_lookup.h"

namespace hgrid {

/// The answer to a request of check_state_validity.
struct StateValidity {
  moveit::GetStateValidity::Response response;
  /// Why nobody knows whether the state is valid, so that the response says it is not; empty: it is known.
  std::string unknown;
};

/// Answers whether a robot would touch anything in a state, and whether the state satisfies the joint constraints.
/// doc/moveit.md says what is different from MoveIt.
/// @throws Refusal not_ready while there is no world; unsupported for constraints of positions, orientations or
/// visibility; what askedState(), variablesOf() and StateChecker throw
StateValidity stateValidity(const moveit::GetStateValidity::Request& request, const AnswerTick& tick,
                            const TransformLookup& transforms, std::shared_ptr<const NarrowPhase> narrow_phase);

}  // namespace hgrid
