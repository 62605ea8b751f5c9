// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <vector>

#include "hgrid_proximity/queries/state_checker.h"
#include "queries/states/robot_in_state.h"
#include "queries/states/state_doubts.h"
#include "queries/states/world_shapes.h"

namespace hgrid {

/// Two shapes whose boxes are near each other in one state.
struct NearShapes {
  float gap;            ///< [m] bound of the distance; negative: the boxes overlap by about this much
  std::uint32_t own;    ///< index into RobotShapes::shapes()
  std::uint32_t other;  ///< index into RobotShapes::shapes() or WorldShapes::shapes()
  bool is_self;         ///< whether `other` is a shape of the robot
};

/// The content of a StateScratch.
struct StateMemory {
  struct Column {
    std::uint32_t variable, column;  // index of a variable, and of its column in the batch
  };
  std::vector<Column> columns;
  std::vector<std::uint8_t> changing;  // for each rigid group: whether it is elsewhere in each state
  std::vector<FourDoubles> values;     // for each variable: its values in four states
  std::vector<FourPoses> groups;       // for each rigid group of the robot
  std::vector<FourShapes> placed;      // for each shape of the robot
  std::vector<FourSpheres> spheres;    // for each shape of the robot, in each of the four states
  std::vector<std::uint8_t>
      spheres_known;  // for each shape of the robot: bit i: whether `spheres` has those of state i
  std::vector<ProxyId> found;
  std::array<std::vector<NearShapes>, 4> near;  // for each of the four states: what is left to be measured
  std::array<std::vector<StatePair>, 4> pairs;  // for each of the four states: its contacts
};

/// Finds contacts in four states of a robot at a time.
///
/// Boxes come first: axis-aligned boxes of four states at once, then tilted boxes. What remains is measured, the pairs
/// whose boxes overlap deepest first, because these are most likely in contact.
class StateSearch {
 public:
  /// @param by_snapshot  whether the pose of the root link is that of the snapshot
  StateSearch(const Snapshot& snapshot, const NarrowPhase& narrow_phase, const RobotShapes& robot,
              const WorldShapes& world, const StateDoubts& doubts, const StateRequest& request, bool by_snapshot,
              StateMemory& scratch);

  /// Examines four states. Their rigid groups are in the scratch memory.
  /// @param open     bit i: whether state i is examined
  /// @param first    whether these are the first states of a batch
  /// @param answers  receives the verdicts of these states
  /// @param pairs    the pairs of these states are appended
  void run(unsigned open, bool first, StateAnswer* answers, std::vector<StatePair>& pairs);

 private:
  void findSelf();
  void findInFewShapes();
  void findInGrid();
  void consider(std::size_t lane, const NearShapes& near);
  const FourSpheres& spheresOf(std::size_t lane, std::size_t own);
  bool haveSpheresInCommon(std::size_t lane, const NearShapes& near);
  void measureLikely();
  StatePair pairOf(const NearShapes& near) const;
  void measure(std::size_t lane, const NearShapes& near);
  void measureMap(std::size_t lane, std::size_t own, const PlacedMap& map);
  void measureMaps(std::size_t lane);
  void measurePlanes(std::size_t lane);
  void take(std::size_t lane, const StatePair& pair, double gap);
  void finish(std::size_t lane, StateAnswer& answer, std::vector<StatePair>& pairs);
  bool isOpen(std::size_t lane) const { return (open_ >> lane & 1u) != 0; }
  bool hasNearest(std::size_t lane) const { return nearest_pair_[lane].first != Structure::kNone; }
  const RobotInState& in(std::size_t lane) const { return robots_[lane]; }

  const Snapshot& snapshot_;
  const NarrowPhase& narrow_phase_;
  const RobotShapes& robot_;
  const WorldShapes& world_;
  const StateDoubts& doubts_;
  const StateRequest& request_;
  const bool by_snapshot_;
  StateMemory& scratch_;
  const std::array<RobotInState, 4> robots_;
  unsigned open_ = 0;                // bit i: whether more pairs of state i must be examined
  std::array<double, 4> nearest_{};  // [m] distance of the nearest pair so far; larger distances do not count
  std::array<StatePair, 4> nearest_pair_;
};

}  // namespace hgrid
