// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/kinematics.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/queries/state_edges.h"
#include "hgrid_proximity/queries/state_pair.h"
#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// States of a robot, or of several robots that joinRobots() has joined, as a planner asks about them. Each state is
/// one value for each variable of the joints.
struct StateBatch {
  /// Names of the variables that `positions` has, see JointVariable. Empty: all variables, in the order of
  /// Kinematics::variables().
  std::vector<std::string> joints;
  /// [rad] or [m] The values of the first state, in the order of `joints`, then those of the next state, and so on.
  std::vector<double> positions;
  /// Values for the variables that `joints` does not name, the same in all states: one value for each of
  /// Kinematics::variables(). Empty: `joints` must name all variables.
  std::vector<double> others;
  /// Pose of the root link of the robot in the world. nullopt: the pose that the snapshot has; for joined robots, the
  /// identity, because their root link is the world.
  std::optional<Pose> world_from_root;
};

/// What StateChecker::checkStates() looks for.
struct StateRequest {
  /// Whether to list all pairs of bodies in contact. If not, only one pair is listed.
  bool all_pairs = false;
  /// Whether to describe the contacts of the listed pairs (StatePair::contact). Each takes up to three times as long as
  /// measuring the same shapes while they are apart.
  bool contacts = false;
  /// [m] If it is greater than 0: measure how far a state without contact is from contact, up to this distance.
  double clearance = 0.0;
  /// Whether to compute how the measured clearance changes with each variable of the batch.
  bool gradients = false;
  /// When the search stops. The states that it has not examined get the verdict unknown (Unknown::budget). nullopt: no
  /// deadline.
  std::optional<std::chrono::steady_clock::time_point> deadline;
};

/// The answer for one state.
struct StateAnswer {
  /// hit: the robot touches itself or another body. clear: it surely touches nothing. unknown: neither is known.
  Verdict verdict = Verdict::unknown;
  Unknown because = Unknown::no;  ///< why the verdict is unknown
  Code refused = Code::ok;        ///< why the state was refused, if `because` is Unknown::refused
  bool beyond_limits = false;     ///< whether a joint is beyond its limits; the verdict is given nevertheless
  std::uint32_t detail = 0;       ///< for StateChecker::sentenceOf()
  std::uint32_t first_pair = 0;   ///< index of the first pair of this state in StateAnswers::pairs
  std::uint32_t pairs = 0;        ///< number of pairs of this state
  /// [m] How far the robot is from contact: 0 in contact, infinite if farther than StateRequest::clearance. NaN if not
  /// asked for or not known.
  double clearance = Proximity::kUnknown;
};

/// The answers to a batch of states.
struct StateAnswers {
  std::vector<StateAnswer> states;  ///< one for each state, in the order of the batch
  /// The pairs of all states. A state in contact has the pair that was found first, or with StateRequest::all_pairs all
  /// pairs, sorted by their bodies. A state whose clearance was measured has its nearest pair.
  std::vector<StatePair> pairs;
  /// Empty unless StateRequest::gradients. [m/rad, or 1 for lengths] For each state one row: how its clearance changes
  /// with each variable of StateBatch::joints, in their order; all NaN if the state has no clearance between 0 and
  /// StateRequest::clearance. Where the nearest points jump, it is the gradient of one of the sides.
  std::vector<double> gradients;
};

struct StateMemory;
struct CheckerParts;

/// Memory that a thread uses for checking states. Each thread needs its own. It keeps its memory, so that later batches
/// of the same size allocate nothing. Exceptions: where the robot is near a map at a place that no state was near
/// before, the map computes bounds of distances (MapCells::distances). And once for each closed mesh of the robot, when
/// it was measured thousands of times without contact, bounds of distances from this mesh are computed. Each takes some
/// milliseconds, also after the deadline.
class StateScratch {
 public:
  StateScratch();
  ~StateScratch();
  /// Takes over the memory of another object, which may then only be destroyed.
  StateScratch(StateScratch&&) noexcept;
  StateScratch& operator=(StateScratch&&) = delete;

 private:
  friend class StateChecker;
  std::unique_ptr<StateMemory> memory_;
};

/// Settings of a StateChecker.
struct StateCheckerOptions {
  std::vector<std::string> ignore = {};  ///< globs over names of bodies that are left out
  /// Names of the variables that a planner changes. Only bodies of the robot that they move count, against each other
  /// and against everything else. Bodies of the robot that they do not move are part of the world: their contacts with
  /// other bodies are not looked for. Empty: all variables.
  std::vector<std::string> group = {};
  /// Names of the robots that a planner moves, if `kinematics` are those of joinRobots(). Only their bodies count, as
  /// for `group`. The other robots are where their joints put them; of their contacts, only those with bodies that
  /// count are looked for. Empty: all robots.
  std::vector<std::string> robots = {};
  /// Name of the world frame. Obstacles that follow it are not attached to the robot, even if one of its links has this
  /// name. Empty: no link has the name of the world frame.
  std::string world_frame = {};
};

/// Answers whether a robot would touch anything if its joints stood at given positions, for many states at once, or if
/// they moved from one state to another.
///
/// All bodies of one snapshot count, with their padding: links of the robot against each other, and against all other
/// bodies, maps, clouds and planes. The pair filter of the snapshot applies. The links of the robot and the obstacles
/// that are attached to them are where the joints put them. Everything else stays where the snapshot has it, also other
/// robots that are not joined to this one. An obstacle is attached if it can move and follows the frame of a link that
/// can move, but not the world frame (StateCheckerOptions::world_frame).
///
/// The verdict of a state without contact is `unknown` instead of `clear` if something may be in contact unseen:
/// - A source of the snapshot lacks something (Snapshot::gaps()) that may be where the robot would be.
/// - A body has no pose, is FROZEN or INVALID, or has a shape that could not be read. This includes unreadable shapes
///   of the robot itself. The poses of its links do not matter, because the joints give their poses.
/// - An attached obstacle is in a worse state than the link, for example LOST at the end of its lifetime.
/// - A body may have moved to the robot since its last pose (BodyPose::reach).
/// - The pose of the robot is the one of the snapshot, and the robot may have moved since.
/// - Snapshot::reportsUnmapped(), and no map knows the space around a shape of the robot to be free.
/// - A deadline passed.
/// With StateRequest::clearance, it is also `unknown` if something unseen may be nearer than the clearance found. For
/// bodies that the pair filter switches off with all bodies of the robot that count, and for ignored bodies, nothing of
/// this counts.
///
/// Immutable. Any number of threads may call checkStates() and checkEdges() at the same time, each with a scratch
/// object of its own. The answer for a state depends neither on the other states of its batch, nor on the thread, nor
/// on the processor. Exception: shapes whose measurement fails count as contact, unless bounds of distances, which
/// exist later, prove that they are apart.
class StateChecker {
 public:
  /// Prepares the shapes of the robot and of the world. Takes time proportional to the number of shapes.
  /// @param snapshot    the world; the checker keeps it
  /// @param kinematics  the joints of the robot; they must be of the model whose links are in the snapshot
  /// @param robot       name of the robot in the snapshot (Body::robot). Empty: `kinematics` are those of joinRobots()
  /// @param narrow_phase  measures the shapes; the solids of the bodies must come from it
  /// @throws Refusal unknown_id if the snapshot has no links of this robot, or of one of the joined robots, or if there
  /// is no variable of the group or no robot of StateCheckerOptions::robots
  /// @throws Refusal conflict if its links are not those of `kinematics`
  /// @throws Refusal nonfinite, out_of_range or bad_rotation for the pose of a joined robot
  StateChecker(std::shared_ptr<const Snapshot> snapshot, const Kinematics& kinematics, const std::string& robot,
               std::shared_ptr<const NarrowPhase> narrow_phase, const StateCheckerOptions& options = {});
  ~StateChecker();
  /// Takes over the content of another checker, which may then only be destroyed.
  StateChecker(StateChecker&&) noexcept;
  StateChecker& operator=(StateChecker&&) = delete;

  /// Answers for each state of a batch. Replaces the content of `answers`.
  ///
  /// A state with an invalid value is refused and gets the verdict unknown; all other states are answered. A value is
  /// invalid if it is not finite, if it is out of range (an angle beyond 1e8 rad, a length beyond 1e6 m), or if the
  /// norm of a quaternion is not near 1. If the last state is incomplete, it is refused.
  /// @throws Refusal unknown_id or dup_id for an entry of `joints`
  /// @throws Refusal not_ready if `joints` and `others` do not give a value for each variable, or if neither the batch
  /// nor the snapshot has a pose of the robot's root link
  /// @throws Refusal out_of_range if `others` has the wrong length, or if the clearance is negative or not finite
  /// @throws Refusal nonfinite if the pose of the root link or a value of `others` is not finite; bad_rotation if a
  /// quaternion of `others` is not a unit quaternion
  void checkStates(const StateBatch& batch, const StateRequest& request, StateScratch& scratch,
                   StateAnswers& answers) const;

  /// Returns a sentence that says why a state was refused or why its verdict is unknown; empty for other states.
  /// @param batch    the batch that `answers` is the answer to
  /// @param state    index of the state
  std::string sentenceOf(const StateBatch& batch, const StateAnswers& answers, std::size_t state) const;

  /// Answers for each edge whether the robot touches anything on the way. Replaces the content of `answers`.
  ///
  /// The verdict clear is certain for every configuration of the edge, not only for some of them: the search divides
  /// the edge into parts. In the middle of a part, it measures whether everything is farther away than the robot can
  /// travel on half of the part. There is one exception: an open mesh is only its surface. Whether a shape may be
  /// inside it, without touching the surface, is examined in the middle of the parts only.
  ///
  /// The verdict unknown has the reasons that it has for states, and one more: two shapes come so near to each other
  /// that parts on which no point travels farther than half of EdgeRequest::tolerance do not prove that they stay
  /// apart. The time grows with the length of the way of the robot divided by the tolerance, if shapes stay this near.
  ///
  /// An edge with a refused state is refused, and all other edges are answered. The answer for an edge does not depend
  /// on the other edges.
  /// @param batch  has the states where edges begin and end; the root link of the robot does not move
  /// @throws Refusal as checkStates() for the batch, and out_of_range for a tolerance that is not between 1e-6 and 1 m
  void checkEdges(const StateBatch& batch, const std::vector<StateEdge>& edges, const EdgeRequest& request,
                  StateScratch& scratch, EdgeAnswers& answers) const;

  /// Returns a sentence that says why an edge was refused or why its verdict is unknown; empty for other edges.
  std::string sentenceOf(const StateBatch& batch, const EdgeAnswers& answers, std::size_t edge) const;

  const Snapshot& snapshot() const;      ///< the world
  const Kinematics& kinematics() const;  ///< the joints
  /// Returns whether the joints of the robot move this body: one of its links, or an attached obstacle.
  /// @param body  index into Structure::bodies
  bool moves(std::uint32_t body) const;
  /// Returns the number of shapes of the robot that count, see StateCheckerOptions. If it is 0, every state is clear.
  std::size_t countingShapes() const;
  /// Returns the number of pairs of shapes of the robot that are tested against each other.
  std::size_t selfPairs() const;

 private:
  std::unique_ptr<const CheckerParts> state_;
};

}  // namespace hgrid
