// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/action_goals.h"

#include <set>

namespace hgrid {
namespace {

constexpr std::size_t kMostGoals = 1000;
// A request to cancel may arrive this long after its effect, and the id of a goal this long after the goal.
constexpr Time kLate = std::chrono::seconds(1);

bool isFinal(std::uint8_t status) {
  return status != GoalStatus::PENDING && status != GoalStatus::ACTIVE && status != GoalStatus::PREEMPTING &&
         status != GoalStatus::RECALLING;
}

bool isMeant(const GoalId& request, const std::string& id, Time stamp) {
  if (request.id.empty() && request.stamp == Time(0)) return true;
  return (!request.id.empty() && request.id == id) || (request.stamp > Time(0) && stamp <= request.stamp);
}

/// Returns the phase of a goal that was received.
/// @param canceled  whether a client wanted that. Without this, a goal is preempted because a newer goal or command
/// replaces it: the joints that the newer one does not name may go on.
GoalPhase phaseOf(std::uint8_t status, bool canceled) {
  switch (status) {
    case GoalStatus::PENDING:
    case GoalStatus::RECALLING:
      return GoalPhase::waiting;
    case GoalStatus::ACTIVE:
      return canceled ? GoalPhase::ending : GoalPhase::followed;
    case GoalStatus::PREEMPTED:
      return canceled ? GoalPhase::stopped : GoalPhase::ending;
    case GoalStatus::SUCCEEDED:
      return GoalPhase::over;
    case GoalStatus::REJECTED:
    case GoalStatus::RECALLED:
      return GoalPhase::refused;
    default:
      return GoalPhase::ending;  // ABORTED, too: many controllers then continue the path
  }
}

/// Returns the phase of a goal that was not received. Only one that moves the robot is of interest.
GoalPhase unseenPhaseOf(std::uint8_t status) {
  const bool moves = status == GoalStatus::ACTIVE || status == GoalStatus::PREEMPTING;
  return moves ? GoalPhase::unseen : GoalPhase::over;
}

}  // namespace

GoalNews ActionGoals::send(const GoalId& goal, Time now) {
  makeRoom();
  if (goal.id.empty()) {
    unnamed_.push_back({"without id, number " + std::to_string(++names_), now});
    return {unnamed_.back().key, GoalPhase::sent};
  }
  Goal& known = goals_[goal.id];
  if (known.sent) return {known.key, GoalPhase::refused};
  known.key = goal.id;
  known.sent = true;
  known.stamp = goal.stamp;
  if (known.listed) known.phase = phaseOf(known.status, known.canceled);
  return {known.key, known.phase};
}

std::vector<GoalNews> ActionGoals::cancel(const GoalId& request, Time now) {
  std::vector<GoalNews> news;
  for (auto& [id, goal] : goals_) {
    if (!goal.sent || !isMeant(request, id, goal.stamp)) continue;
    if (isFinal(goal.status) && now - goal.ended > kLate) continue;
    goal.canceled = true;
    if (!goal.listed || phaseOf(goal.status, true) == goal.phase) continue;
    goal.phase = phaseOf(goal.status, true);
    news.push_back({goal.key, goal.phase});
  }
  return news;
}

std::vector<GoalNews> ActionGoals::result(const GoalStatus& status, Time now) {
  std::vector<GoalNews> news;
  note(status, now, news);
  return news;
}

std::vector<GoalNews> ActionGoals::status(const std::vector<GoalStatus>& all, Time now) {
  std::vector<GoalNews> news;
  std::set<std::string> present;
  for (const GoalStatus& status : all) {
    present.insert(status.goal.id);
    note(status, now, news);
  }
  has_list_ = true;
  for (auto it = goals_.begin(); it != goals_.end();) {
    const Goal& goal = it->second;
    if (!goal.listed || present.count(it->first) > 0) {
      ++it;
      continue;
    }
    // A server forgets goals that ended. If it forgets another one, it was started again.
    if (!isFinal(goal.status)) news.push_back({goal.key, goal.sent ? GoalPhase::ending : GoalPhase::over});
    it = goals_.erase(it);
  }
  return news;
}

/// Bounds the number of goals. A goal that was forgotten counts as not received if it is accepted later.
void ActionGoals::makeRoom() {
  if (goals_.size() + unnamed_.size() < kMostGoals) return;
  goals_.clear();
  unnamed_.clear();
}

/// Returns the goal that a status tells of.
ActionGoals::Goal& ActionGoals::goalOf(const GoalStatus& status, Time now) {
  const std::string& id = status.goal.id;
  const auto known = goals_.find(id);
  if (known != goals_.end()) return known->second;
  makeRoom();
  Goal& goal = goals_[id];
  goal.key = id;
  goal.stamp = status.goal.stamp;
  // The first list may have goals that ended before. RECALLING is a goal that the server itself has not received.
  const bool may_be_unnamed = status.status != GoalStatus::RECALLING && (has_list_ || !isFinal(status.status));
  while (!unnamed_.empty() && now - unnamed_.front().sent > kLate) unnamed_.pop_front();
  if (!unnamed_.empty() && may_be_unnamed) {
    goal.key = unnamed_.front().key;
    goal.sent = true;
    unnamed_.pop_front();
  }
  return goal;
}

void ActionGoals::note(const GoalStatus& status, Time now, std::vector<GoalNews>& news) {
  Goal& goal = goalOf(status, now);
  if (isFinal(goal.status) && goal.listed) return;  // an older message arrives later: what is final stays so
  if (isFinal(status.status)) goal.ended = now;
  goal.status = status.status;
  goal.listed = true;
  const GoalPhase before = goal.phase;
  goal.phase = goal.sent ? phaseOf(goal.status, goal.canceled) : unseenPhaseOf(goal.status);
  const bool was_unseen = before == GoalPhase::unseen;
  if (goal.sent ? goal.phase != before : was_unseen || goal.phase == GoalPhase::unseen) {
    news.push_back({goal.key, goal.phase});
  }
}

}  // namespace hgrid
