// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// What becomes of the path of a goal.
enum class GoalPhase : std::uint8_t {
  sent,      ///< nothing was heard of the goal since it was sent
  waiting,   ///< the server has the goal, and may accept or refuse it
  followed,  ///< the robot follows the path
  unseen,    ///< the robot follows the path of a goal that was not received
  ending,    ///< the robot stops, or it goes on: the goal is being canceled, or it ended before the robot arrived
  stopped,   ///< the goal was canceled, and the robot stops
  over,      ///< the goal ended, and the robot has arrived
  refused,   ///< the robot never follows the path: the goal was refused, or canceled before it was accepted
};

/// The fields of actionlib_msgs/GoalID.
struct GoalId {
  std::string id;
  Time stamp{0};
};

/// The fields of actionlib_msgs/GoalStatus that tell how a goal stands.
struct GoalStatus {
  enum Value : std::uint8_t {
    PENDING = 0,
    ACTIVE = 1,
    PREEMPTED = 2,
    SUCCEEDED = 3,
    ABORTED = 4,
    REJECTED = 5,
    PREEMPTING = 6,
    RECALLING = 7,
    RECALLED = 8,
    LOST = 9,
  };

  GoalId goal;
  std::uint8_t status = PENDING;
};

/// The phase of a goal.
struct GoalNews {
  std::string key;  ///< the name of the goal, see ActionGoals
  GoalPhase phase = GoalPhase::sent;
};

/// Follows the goals of an action from what its clients send (goal, cancel) and what its server says (status, result).
/// Messages of different topics may arrive in any order. One thread may use it.
///
/// The name of a goal is its id. A goal without id gets a name of its own; its server then makes an id, which is the
/// next one within a second that nobody has sent.
class ActionGoals {
 public:
  /// Takes a goal. If the server already has a goal with this id, it ignores the later one; then the phase is refused.
  GoalNews send(const GoalId& goal, Time now);
  /// Takes a request to cancel goals: the one with its id, those up to its stamp, or all if it has neither.
  /// @returns the goals whose phases change
  std::vector<GoalNews> cancel(const GoalId& request, Time now);
  /// Takes the status in the result of a goal. @returns as status()
  std::vector<GoalNews> result(const GoalStatus& status, Time now);
  /// Takes the status of all goals that the server has.
  /// @returns the goals whose phases change, and each time those that are unseen
  std::vector<GoalNews> status(const std::vector<GoalStatus>& all, Time now);

 private:
  struct Goal {
    std::string key;
    Time stamp{0};
    GoalPhase phase = GoalPhase::sent;
    std::uint8_t status = GoalStatus::PENDING;
    bool sent = false, listed = false, canceled = false;
    Time ended{0};  // when its status became final
  };
  struct Unnamed {
    std::string key;
    Time sent{0};
  };
  using Goals = std::map<std::string, Goal>;

  void makeRoom();
  Goal& goalOf(const GoalStatus& status, Time now);
  void note(const GoalStatus& status, Time now, std::vector<GoalNews>& news);

  Goals goals_;                  // by the id that the server knows
  std::deque<Unnamed> unnamed_;  // goals that were sent without id, whose ids are not known yet
  std::size_t names_ = 0;        // number of names that were made
  bool has_list_ = false;        // whether the server has sent a list
};

}  // namespace hgrid
