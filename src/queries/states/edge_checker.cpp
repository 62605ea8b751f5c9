// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The part of StateChecker that is about edges.
#include <cmath>

#include "hgrid_proximity/geometry/float_environment.h"
#include "queries/states/edge_search.h"

namespace hgrid {

void StateChecker::checkEdges(const StateBatch& batch, const std::vector<StateEdge>& edges, const EdgeRequest& request,
                              StateScratch& scratch, EdgeAnswers& answers) const {
  const DefaultFloatEnvironment environment;
  constexpr double kLeastTolerance = 1e-6;  // [m]
  if (!(request.tolerance >= kLeastTolerance && request.tolerance <= 1.0)) {
    throw Refusal(Code::out_of_range,
                  "the tolerance of the edges is " + text(request.tolerance) + " m; it must be between 1e-6 and 1 m");
  }
  EdgeSearch(*state_, batch, edges, request, *scratch.memory_, answers).run();
}

std::string StateChecker::sentenceOf(const StateBatch& batch, const EdgeAnswers& answers, std::size_t edge) const {
  const EdgeAnswer& answer = answers.edges[edge];
  const std::string what = "edge " + std::to_string(edge);
  switch (answer.because) {
    case Unknown::no:
      return {};
    case Unknown::refused: {
      const std::size_t states = StateValues::sizeOf(state_->kinematics, batch);
      if (answer.refused_state >= states) {
        return what + " has the state " + std::to_string(answer.refused_state) +
               "; its states must be smaller than the number of states, " + std::to_string(states);
      }
      StateAnswer state;
      state.refused = answer.refused;
      state.detail = answer.detail;
      return what + ", " + refusalOf(state_->kinematics, batch, answer.refused_state, state);
    }
    case Unknown::budget:
      return "the deadline passed before all of " + what + " was examined";
    case Unknown::tolerance: {
      const StatePair& pair = answers.pairs[answer.first_pair];
      const BodyList& bodies = state_->snapshot->structure().bodies;
      const double distance = pair.proximity.distance;
      return what + ": " + bodies[pair.first].name + " and " + bodies[pair.second].name + " come " +
             (std::isfinite(distance) ? "within " + text(distance) + " m of each other" : "near each other") +
             ", at about " + text(answer.free_until) +
             " of the edge; a smaller tolerance may prove that they stay apart";
    }
    case Unknown::half_turn:
      return what + ": joint '" + state_->kinematics.variables()[answer.detail].joint +
             "' turns by half a turn, so both ways are equally short; give a state between its ends";
    default:
      return state_->doubts[answer.detail].sentence;
  }
}

}  // namespace hgrid
