// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "hgrid_proximity/queries/state_checker.h"
#include "queries/states/motion_bounds.h"
#include "queries/states/robot_in_state.h"
#include "queries/states/world_shapes.h"

namespace hgrid {

/// What a shape of the robot is near.
enum class With : std::uint8_t { self, shape, plane, map };

/// A shape of the robot, and something whose box is near that of the shape in one state.
struct NearShapes {
  float gap;            ///< [m] bound of the distance; negative: the boxes overlap by about this much
  float reach;          ///< [m] larger distances do not matter
  With with;            ///< what `other` is
  std::uint32_t own;    ///< index into RobotShapes::shapes()
  std::uint32_t other;  ///< index into RobotShapes::shapes(), or WorldShapes::shapes(), planes() or maps()
  std::uint32_t pair;   ///< With::self: index into RobotShapes::selfPairs()
};

/// A part of an edge. Positions on an edge are from 0 to 1.
struct EdgePart {
  double begin, tip;
  std::size_t first = 0, count = 0;  // what may be in contact in this part: a range of EdgeInWork::candidates
  bool in_doubt = false;             // whether a StateDoubt may apply in this part
};

/// Two solids in contact: one of the robot in a state, and another one. Valid as long as the snapshot.
struct TouchingSolids {
  /// A solid at a pose. Null: not known.
  struct Placed {
    const Solid* solid = nullptr;
    Pose world_from_shape = Pose::Identity();
    double padding = 0.0;  // [m]
  };
  Placed first, second;

  /// Describes their contact; all NaN if a solid is not known or if measuring it failed. @param status  of the two
  Contact measure(const NarrowPhase& narrow_phase, Measure status) const;
};

/// An edge that is being examined, in one of four lanes.
struct EdgeInWork {
  std::size_t edge = 0;  // index of the edge
  bool active = false;
  double path = 0.0;                   // [m] bound of the path of any point of the robot on the whole edge
  float slack = 0.0f;                  // [m] bound of the rounding errors of the distance of two shapes
  double begin = 0.0;                  // everything before it has been examined
  double end = 1.0;                    // where the first known contact is; 1: none is known
  double step = 1.0;                   // length of the next part that is searched for everything
  double uncertain_from = 2.0;         // beginning of the first part that could not be proved free; 2: there is none
  std::optional<StatePair> contact;    // the pair in contact at `end`
  TouchingSolids touching;             // the solids of this pair
  std::optional<StatePair> near;       // the pair at `uncertain_from`
  std::optional<std::uint32_t> doubt;  // or the doubt that applies there
  EdgePart part{};                     // what is being examined
  std::uint32_t probes = 0;            // how many configurations are tested for contact before the parts are examined
  std::uint32_t probed = 0;            // how many of them have been tested
  bool searches_all = true;            // whether everything is searched in it, or only its candidates
  std::vector<EdgePart> parts;         // parts still to be examined; the last element is examined first
  std::vector<NearShapes> candidates;
  MotionBounds::Memory motion;
};

/// The content of a StateScratch.
struct StateMemory {
  /// Makes room for a robot.
  void prepare(const Kinematics& kinematics, const RobotShapes& robot);

  struct Column {
    std::uint32_t variable, column;  // index of a variable, and of its column in the batch
  };
  std::vector<Column> columns;
  std::vector<std::uint32_t> mimics;  // groups of the robot whose joints mimic a variable of the batch
  std::vector<GroupChange> changes;   // for each rigid group: what changes from one state of the batch to the next
  std::vector<FourDoubles> values;    // for each variable: its values in four states
  GroupPoses groups;                  // of the robot; those of groups without shapes are of the first states only
  std::vector<FourShapes> placed;     // for each shape of the robot
  std::vector<FourBounds> clusters;   // for each cluster of the robot: the boxes around its shapes
  std::vector<FourSpheres> spheres;   // for each shape of the robot, in each of the four states
  std::vector<std::uint8_t>
      spheres_known;              // for each shape of the robot: bit i: whether `spheres` has those of state i
  std::vector<Four> shape_reach;  // [m] for each shape of the robot: how near something outside the robot matters
  std::vector<std::uint8_t>
      map_far;  // for each map and each shape of the robot: bits of the states in which it is far from the map
  std::vector<Four> pair_reach;   // [m] for each pair of RobotShapes::selfPairs(): how near its shapes matter
  std::vector<Four> block_reach;  // [m] for each of RobotShapes::selfBlocks(): at least the greatest of its pair_reach
  struct SelfNear {
    std::uint32_t pair;  // index into RobotShapes::selfPairs()
    unsigned lanes;      // bit i: whether the boxes of its shapes are near each other in state i
  };
  std::vector<SelfNear> self_near;            // has room for all pairs
  std::vector<FourDoubles> from, difference;  // for each variable: value at the beginning of an edge, and its change
  std::array<EdgeInWork, 4> edges;
  std::vector<double> gradient;  // for each variable
  std::vector<ProxyId> found;
  std::array<std::vector<NearShapes>, 4> near;  // for each of the four states: what is left to be measured
  std::array<std::vector<NearShapes>, 4> kept;  // SearchGoal::all_near: for each of the four states: what is near
  std::array<float, 4> coarse;                  // the same: [m] shapes with a greater reach are not measured
  std::array<std::vector<StatePair>, 4> pairs;  // for each of the four states: its contacts
};

/// What StateSearch looks for.
enum class SearchGoal {
  contact,       ///< any contact; its points are not needed
  all_contacts,  ///< all contacts; if there are none, the pair of shapes within reach that are nearest to each other
  nearest,       ///< any contact; if there is none, the pair of shapes within reach that are nearest to each other
  all_near       ///< any contact; if there is none, all pairs of shapes within reach
};

/// Finds contacts in four states of a robot at a time.
///
/// Boxes come first: axis-aligned boxes of four states at once, then tilted boxes. What remains is measured, the pairs
/// whose boxes overlap deepest first, because these are most likely in contact.
class StateSearch {
 public:
  /// @param farthest  [m] larger distances never matter; StateMemory has smaller limits for single shapes
  /// @param describes  whether StatePair::contact of all contacts is needed
  StateSearch(const Snapshot& snapshot, const NarrowPhase& narrow_phase, const RobotShapes& robot,
              const WorldShapes& world, SearchGoal goal, double farthest, bool describes, StateMemory& scratch);

  /// Begins with four states. Their rigid groups and reaches are in the scratch memory.
  /// @param open   bit i: whether state i is examined
  /// @param first  whether these are the first states of a batch
  void place(unsigned open, bool first);
  /// Examines everything in some of these states. @param lanes  bit i: whether this is state i
  void findAll(unsigned lanes);
  /// Examines only some shapes in one of these states.
  void findAmong(std::size_t lane, const NearShapes* begin, const NearShapes* end);

  /// Returns the contacts that were found in a state, sorted by bodies. A pair of bodies may occur more than once.
  const std::vector<StatePair>& contacts(std::size_t lane) const { return scratch_.pairs[lane]; }
  /// Returns the solids of the contact that was found last in a state.
  const TouchingSolids& touching(std::size_t lane) const { return touching_[lane]; }
  /// Returns whether shapes within reach were found that are not in contact, and none in contact.
  bool hasNear(std::size_t lane) const { return contacts(lane).empty() && near_pair_[lane].first != Structure::kNone; }
  /// Returns these shapes, see SearchGoal. With SearchGoal::all_near, the nearest of those that were measured.
  const StatePair& nearPair(std::size_t lane) const { return near_pair_[lane]; }
  /// Returns their distance [m].
  double nearDistance(std::size_t lane) const { return near_distance_[lane]; }
  /// SearchGoal::all_near: returns all shapes within reach.
  const std::vector<NearShapes>& kept(std::size_t lane) const { return scratch_.kept[lane]; }
  /// Returns the robot in a state.
  const RobotInState& robotIn(std::size_t lane) const { return robots_[lane]; }

 private:
  std::size_t findSelfBoxes();
  void findSelf();
  unsigned farFromMesh(const SelfPair& pair, const Four& reach, unsigned lanes) const;
  bool isFarFromMesh(std::size_t lane, const NearShapes& near) const;
  void findInFewShapes();
  void findInGrid();
  void findNearCluster(std::size_t lane, const ShapeCluster& cluster);
  void findFarFromMaps();
  bool isFarFromMap(std::size_t lane, std::size_t map, std::size_t own) const;
  void findPlanesAndMaps(std::size_t lane);
  void consider(std::size_t lane, const NearShapes& near);
  const FourSpheres& spheresOf(std::size_t lane, std::size_t own);
  bool haveSpheresInCommon(std::size_t lane, const NearShapes& near);
  void measureLikely();
  StatePair pairOf(const NearShapes& near) const;
  void measure(std::size_t lane, const NearShapes& near);
  void measureMap(std::size_t lane, const NearShapes& near, double limit);
  TouchingSolids::Placed otherOf(std::size_t lane, const NearShapes& near) const;
  void take(std::size_t lane, const NearShapes& near, const StatePair& pair, const TouchingSolids::Placed& other,
            double limit);
  void sortContacts(std::size_t lane);
  bool isOpen(std::size_t lane) const { return (open_ >> lane & 1u) != 0; }

  const Snapshot& snapshot_;
  const NarrowPhase& narrow_phase_;
  const RobotShapes& robot_;
  const WorldShapes& world_;
  const SearchGoal goal_;
  const double farthest_;
  const bool describes_;
  StateMemory& scratch_;
  const std::array<RobotInState, 4> robots_;
  unsigned open_ = 0;              // bit i: whether more pairs of state i must be examined
  std::array<double, 4> limit_{};  // [m] larger distances do not count any more
  std::array<StatePair, 4> near_pair_;
  std::array<double, 4> near_distance_{};
  std::array<TouchingSolids, 4> touching_;
};

}  // namespace hgrid
