// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/query_answer.h"
#include "queries/states/world_shapes.h"

namespace hgrid {

class RobotInState;

/// Something that may be in contact with the robot although no shape of the snapshot is.
struct StateDoubt {
  enum class Where {
    anywhere,  ///< it can be anywhere
    sphere,    ///< it is in the sphere `within`
    near_body  ///< it is at most `reach` [m] from where the snapshot has `body`
  };
  Unknown because;
  std::string sentence;
  Where where = Where::anywhere;
  Sphere within{};  ///< [m, world]
  std::uint32_t body = 0;
  double reach = 0.0;  ///< [m]
};

/// Decides whether a state without contact may be called clear. It must be unknown if one of the doubts applies.
class StateDoubts {
 public:
  /// @param root_body  index of the body from which the pose of the root link is taken, or Structure::kNone
  StateDoubts(const Snapshot& snapshot, const RobotShapes& robot, const WorldShapes& world, const QueryScope& scope,
              std::uint32_t root_body);

  /// Returns the number of the first doubt that applies to all states, or nullopt.
  /// @param by_snapshot  whether the pose of the root link is that of the snapshot
  std::optional<std::uint32_t> findAnywhere(bool by_snapshot) const;
  /// Returns the number of the first other doubt that applies to a state, or nullopt.
  /// @param clearance    [m] everything that may be this near counts
  std::optional<std::uint32_t> findNear(const RobotInState& robot, double clearance) const;
  /// Returns a doubt.
  const StateDoubt& operator[](std::uint32_t number) const { return doubts_[number]; }
  /// Returns whether there are no doubts at all.
  bool none() const { return doubts_.empty(); }

 private:
  void addGaps(const Snapshot& snapshot, const RobotShapes& robot, const QueryScope& scope);
  void addBodies(const Snapshot& snapshot, const RobotShapes& robot, const QueryScope& scope);
  bool isFree(const RobotInState& robot, double clearance) const;
  bool isAnywhere(const StateDoubt& doubt) const {
    return doubt.where == StateDoubt::Where::anywhere && doubt.because != Unknown::unmapped;
  }

  const WorldShapes& world_;
  std::vector<StateDoubt> doubts_;
  std::size_t by_snapshot_ =
      0;                    // number of doubts at the beginning that count only if the pose is that of the snapshot
  bool asks_maps_ = false;  // whether the last doubt is that no map knows the space to be free
};

}  // namespace hgrid
