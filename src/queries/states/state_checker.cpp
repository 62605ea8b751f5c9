// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/queries/state_checker.h"

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/queries/query.h"
#include "queries/question.h"
#include "queries/states/state_search.h"
#include "queries/states/state_values.h"

namespace hgrid {
namespace {

QueryScope scopeOf(const StateCheckerOptions& options) {
  QueryScope scope;
  scope.exclude = options.ignore;
  return scope;
}

/// Returns the body of the robot from which the pose of its root link follows: a link that is rigidly connected to the
/// root link. Structure::kNone if the snapshot has no pose of such a link.
std::uint32_t rootBodyOf(const Snapshot& snapshot, const RobotShapes& robot) {
  for (const RobotBody& own : robot.bodies()) {
    const bool is_link = snapshot.structure().bodies[own.body].kind == BodyKind::link;
    if (is_link && own.group == 0 && snapshot.poses()[own.body].state != Freshness::unplaced) return own.body;
  }
  return Structure::kNone;
}

}  // namespace

struct StateChecker::State {
  State(std::shared_ptr<const Snapshot> asked, const Kinematics& joints, const std::string& name,
        std::shared_ptr<const NarrowPhase> measures, const StateCheckerOptions& options)
      : snapshot(std::move(asked)),
        kinematics(joints),
        narrow_phase(std::move(measures)),
        robot(*snapshot, joints, name, options.group, options.world_frame, scopeOf(options)),
        world(*snapshot, robot, scopeOf(options)),
        root_body(rootBodyOf(*snapshot, robot)),
        doubts(*snapshot, robot, world, scopeOf(options), root_body) {}

  /// Returns the pose of the root link for a batch. @throws Refusal not_ready, nonfinite, out_of_range
  Pose worldFromRoot(const StateBatch& batch) const {
    if (batch.world_from_root) {
      if (!batch.world_from_root->matrix().allFinite()) {
        throw Refusal(Code::nonfinite, "the pose of the robot's root link is not finite; every number must be finite");
      }
      checkQueryPoint(batch.world_from_root->translation(), "the position of the robot's root link");
      return *batch.world_from_root;
    }
    if (root_body == Structure::kNone) {
      throw Refusal(Code::not_ready, "the snapshot has no pose of the root link of robot '" +
                                         printable(kinematics.name()) + "'; give its pose with the states");
    }
    const std::uint32_t link = snapshot->structure().bodies[root_body].link;
    return snapshot->poses()[root_body].world_from_body * kinematics.groupFromLink()[link].inverse();
  }

  const std::shared_ptr<const Snapshot> snapshot;
  const Kinematics kinematics;
  const std::shared_ptr<const NarrowPhase> narrow_phase;
  const RobotShapes robot;
  const WorldShapes world;
  const std::uint32_t root_body;
  const StateDoubts doubts;
};

StateScratch::StateScratch() : memory_(std::make_unique<StateMemory>()) {}
StateScratch::~StateScratch() = default;
StateScratch::StateScratch(StateScratch&&) noexcept = default;

StateChecker::StateChecker(std::shared_ptr<const Snapshot> snapshot, const Kinematics& kinematics,
                           const std::string& robot, std::shared_ptr<const NarrowPhase> narrow_phase,
                           const StateCheckerOptions& options) {
  const DefaultFloatEnvironment environment;
  state_ = std::make_unique<const State>(std::move(snapshot), kinematics, robot, std::move(narrow_phase), options);
}
StateChecker::~StateChecker() = default;
StateChecker::StateChecker(StateChecker&&) noexcept = default;

const Snapshot& StateChecker::snapshot() const { return *state_->snapshot; }
const Kinematics& StateChecker::kinematics() const { return state_->kinematics; }
bool StateChecker::moves(std::uint32_t body) const { return state_->robot.moves(body); }
std::size_t StateChecker::selfPairs() const { return state_->robot.selfPairs().size(); }

void StateChecker::checkStates(const StateBatch& batch, const StateRequest& request, StateScratch& scratch,
                               StateAnswers& answers) const {
  const DefaultFloatEnvironment environment;
  if (!(request.clearance >= 0.0 && request.clearance <= kQueryReach)) {
    checkQueryLength(request.clearance, "the clearance of the states");  // its text would allocate in each call
  }
  const State& all = *state_;
  StateMemory& memory = *scratch.memory_;
  const Pose world_from_root = all.worldFromRoot(batch);
  StateValues values(all.kinematics, batch, memory);
  memory.groups.resize(all.kinematics.state().groups.size());
  memory.placed.resize(all.robot.shapes().size());
  memory.spheres.resize(4 * all.robot.shapes().size());
  memory.spheres_known.resize(all.robot.shapes().size());
  answers.states.assign(values.size(), StateAnswer{});
  answers.pairs.clear();
  StateSearch search(*all.snapshot, *all.narrow_phase, all.robot, all.world, all.doubts, request,
                     !batch.world_from_root, memory);
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
    forwardKinematics(all.kinematics, memory.values, world_from_root, is_first ? nullptr : memory.changing.data(),
                      memory.groups);
    search.run(open, is_first, &answers.states[first], answers.pairs);
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
