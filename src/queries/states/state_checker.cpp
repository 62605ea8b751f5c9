// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/queries/state_checker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/queries/query.h"
#include "queries/question.h"
#include "queries/states/checker_parts.h"
#include "queries/states/clearance_gradient.h"
#include "queries/states/state_search.h"
#include "queries/states/state_values.h"

namespace hgrid {
namespace {

bool sameBodies(const StatePair& a, const StatePair& b) { return a.first == b.first && a.second == b.second; }

SearchGoal goalOf(const StateRequest& request) {
  if (request.all_pairs) return SearchGoal::all_contacts;
  return request.clearance > 0.0 ? SearchGoal::nearest : SearchGoal::contact;
}

/// Writes the answer for a state that was searched.
void write(const StateSearch& search, const StateDoubts& doubts, std::size_t lane, const StateRequest& request,
           bool by_snapshot, StateAnswer& answer, std::vector<StatePair>& pairs) {
  const std::vector<StatePair>& found = search.contacts(lane);
  const bool measured = request.clearance > 0.0;
  answer.first_pair = static_cast<std::uint32_t>(pairs.size());
  if (!found.empty()) {
    answer.verdict = Verdict::hit;
    if (measured) answer.clearance = 0.0;
    pairs.insert(pairs.end(), found.begin(), found.end());
    pairs.erase(std::unique(pairs.begin() + answer.first_pair, pairs.end(), sameBodies), pairs.end());
    answer.pairs = static_cast<std::uint32_t>(pairs.size()) - answer.first_pair;
    return;
  }
  const double nearest = search.hasNear(lane) ? search.nearDistance(lane) : request.clearance;
  auto doubt = doubts.findAnywhere(by_snapshot);
  if (!doubt) doubt = doubts.findNear(search.robotIn(lane), nearest);
  answer.verdict = doubt ? Verdict::unknown : Verdict::clear;
  if (doubt) {
    answer.because = doubts[*doubt].because;
    answer.detail = *doubt;
  }
  if (!measured) return;
  answer.clearance = search.hasNear(lane) ? nearest : std::numeric_limits<double>::infinity();
  if (!search.hasNear(lane)) return;
  pairs.push_back(search.nearPair(lane));
  answer.pairs = 1;
}

}  // namespace

StateScratch::StateScratch() : memory_(std::make_unique<StateMemory>()) {}
StateScratch::~StateScratch() = default;
StateScratch::StateScratch(StateScratch&&) noexcept = default;

StateChecker::StateChecker(std::shared_ptr<const Snapshot> snapshot, const Kinematics& kinematics,
                           const std::string& robot, std::shared_ptr<const NarrowPhase> narrow_phase,
                           const StateCheckerOptions& options) {
  const DefaultFloatEnvironment environment;
  state_ =
      std::make_unique<const CheckerParts>(std::move(snapshot), kinematics, robot, std::move(narrow_phase), options);
}
StateChecker::~StateChecker() = default;
StateChecker::StateChecker(StateChecker&&) noexcept = default;

const Snapshot& StateChecker::snapshot() const { return *state_->snapshot; }
const Kinematics& StateChecker::kinematics() const { return state_->kinematics; }
bool StateChecker::moves(std::uint32_t body) const { return state_->robot.moves(body); }
std::size_t StateChecker::countingShapes() const { return state_->robot.counting(); }
std::size_t StateChecker::selfPairs() const { return state_->robot.selfPairs().size(); }

void StateChecker::checkStates(const StateBatch& batch, const StateRequest& request, StateScratch& scratch,
                               StateAnswers& answers) const {
  const DefaultFloatEnvironment environment;
  if (!(request.clearance >= 0.0 && request.clearance <= kQueryReach)) {
    checkQueryLength(request.clearance, "the clearance of the states");  // its text would allocate in each call
  }
  const CheckerParts& all = *state_;
  StateMemory& memory = *scratch.memory_;
  const Pose world_from_root = all.worldFromRoot(batch);
  StateValues values(all.kinematics, all.robot, batch, memory);
  memory.prepare(all.kinematics, all.robot);
  std::fill(memory.shape_reach.begin(), memory.shape_reach.end(), allFour(roundedUp(request.clearance)));
  std::fill(memory.pair_reach.begin(), memory.pair_reach.end(), allFour(roundedUp(request.clearance)));
  std::fill(memory.block_reach.begin(), memory.block_reach.end(), allFour(roundedUp(request.clearance)));
  answers.states.assign(values.size(), StateAnswer{});
  answers.pairs.clear();
  answers.gradients.assign(request.gradients ? values.size() * memory.columns.size() : 0, Proximity::kUnknown);
  StateSearch search(*all.snapshot, *all.narrow_phase, all.robot, all.world, goalOf(request), request.clearance,
                     request.contacts, memory);
  for (std::size_t first = 0; first < values.size(); first += 4) {
    const bool is_first = first == 0;
    const std::size_t count = std::min<std::size_t>(4, values.size() - first);
    unsigned open = 0;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if (lane < count) {
        values.read(first + lane, lane, answers.states[first + lane]);
        if (answers.states[first + lane].refused == Code::ok) open |= 1u << lane;
      } else {
        values.clear(lane);
      }
    }
    if (request.deadline && std::chrono::steady_clock::now() >= *request.deadline) {
      for (std::size_t lane = 0; lane < count; ++lane) {
        if (open >> lane & 1u) answers.states[first + lane].because = Unknown::budget;
      }
      continue;
    }
    forwardKinematics(all.kinematics, memory.values, world_from_root, is_first ? nullptr : memory.changes.data(),
                      memory.groups);
    search.place(open, is_first);
    search.findAll(open);
    for (std::size_t lane = 0; lane < count; ++lane) {
      if ((open >> lane & 1u) == 0) continue;
      write(search, all.doubts, lane, request, !batch.world_from_root, answers.states[first + lane], answers.pairs);
      if (!request.gradients || !search.hasNear(lane)) continue;
      clearanceGradient(all.kinematics, all.robot, memory.groups.in_world, memory.values, lane, search.nearPair(lane),
                        memory.gradient);
      double* const row = &answers.gradients[(first + lane) * memory.columns.size()];
      for (const auto& [variable, column] : memory.columns) row[column] = memory.gradient[variable];
    }
  }
}

std::string StateChecker::sentenceOf(const StateBatch& batch, const StateAnswers& answers, std::size_t state) const {
  const StateAnswer& answer = answers.states[state];
  switch (answer.because) {
    case Unknown::no:
      return {};
    case Unknown::refused:
      return refusalOf(state_->kinematics, batch, state, answer);
    case Unknown::budget:
      return "the deadline passed before state " + std::to_string(state) + " was examined";
    default:
      return state_->doubts[answer.detail].sentence;
  }
}

}  // namespace hgrid
