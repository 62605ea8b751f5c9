// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/guard/action_goals.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hgrid {
namespace {

using Lines = std::vector<std::string>;

const char* nameOf(GoalPhase phase) {
  const char* const names[] = {"sent", "waiting", "followed", "unseen", "ending", "stopped", "over", "refused"};
  return names[static_cast<std::size_t>(phase)];
}

class ActionGoalsTest : public ::testing::Test {
 protected:
  static Time at(double second) { return Time(std::int64_t(1e9 * second)); }
  static Lines lines(const std::vector<GoalNews>& news) {
    Lines all;
    for (const GoalNews& one : news) all.push_back(one.key + " " + nameOf(one.phase));
    return all;
  }
  std::string send(const std::string& id, double stamp = 1.0) {
    const GoalNews news = goals_.send({id, at(stamp)}, at(now_));
    return news.key + " " + nameOf(news.phase);
  }
  Lines cancel(const std::string& id, double stamp = 0.0) { return lines(goals_.cancel({id, at(stamp)}, at(now_))); }
  Lines result(const std::string& id, GoalStatus::Value status) {
    return lines(goals_.result({{id, at(1.0)}, status}, at(now_)));
  }
  struct One {
    std::string id;
    GoalStatus::Value status;
    double stamp = 1.0;
  };
  Lines status(const std::vector<One>& all) {
    std::vector<GoalStatus> list;
    for (const One& one : all) list.push_back({{one.id, at(one.stamp)}, one.status});
    return lines(goals_.status(list, at(now_)));
  }

  ActionGoals goals_;
  double now_ = 10.0;  // [s]
};

TEST_F(ActionGoalsTest, FollowsAGoalFromItsStartToItsEnd) {
  EXPECT_EQ(send("a"), "a sent");
  EXPECT_EQ(status({{"a", GoalStatus::PENDING}}), Lines{"a waiting"});
  EXPECT_EQ(status({{"a", GoalStatus::ACTIVE}}), Lines{"a followed"});
  EXPECT_EQ(status({{"a", GoalStatus::ACTIVE}}), Lines{});
  EXPECT_EQ(result("a", GoalStatus::SUCCEEDED), Lines{"a over"});
  EXPECT_EQ(status({{"a", GoalStatus::ACTIVE}}), Lines{}) << "an older message that arrives later";
  EXPECT_EQ(status({{"a", GoalStatus::SUCCEEDED}}), Lines{});
  EXPECT_EQ(status({}), Lines{});
}

/// Claim: a goal that is refused or recalled was never followed; one that is aborted may go on.
TEST_F(ActionGoalsTest, TellsGoalsThatNeverBeginFromThoseThatEndEarly) {
  send("a"), send("b"), send("c");
  EXPECT_EQ(status({{"a", GoalStatus::REJECTED}, {"b", GoalStatus::RECALLING}, {"c", GoalStatus::ACTIVE}}),
            (Lines{"a refused", "b waiting", "c followed"}));
  EXPECT_EQ(status({{"a", GoalStatus::REJECTED}, {"b", GoalStatus::RECALLED}, {"c", GoalStatus::ABORTED}}),
            (Lines{"b refused", "c ending"}));
}

/// Claim: a robot stops for a cancel. It need not stop if a newer goal of some joints replaces the goal.
TEST_F(ActionGoalsTest, TellsACanceledGoalFromOneThatIsReplaced) {
  send("a");
  status({{"a", GoalStatus::ACTIVE}});
  EXPECT_EQ(cancel("other"), Lines{});
  EXPECT_EQ(cancel("a"), Lines{"a ending"});
  EXPECT_EQ(status({{"a", GoalStatus::PREEMPTING}}), Lines{});
  EXPECT_EQ(status({{"a", GoalStatus::PREEMPTED}}), Lines{"a stopped"});
  send("b");
  status({{"b", GoalStatus::ACTIVE}});
  EXPECT_EQ(status({{"b", GoalStatus::PREEMPTED}}), Lines{"b ending"});
}

/// Claim: a cancel means the goal with its id, those up to its stamp, or all, as in actionlib.
TEST_F(ActionGoalsTest, CancelsByIdByStampOrAll) {
  const auto begin = [&] {
    goals_ = ActionGoals();
    send("a", 1.0), send("b", 2.0), send("c", 3.0);
    status({{"a", GoalStatus::ACTIVE, 1.0}, {"b", GoalStatus::ACTIVE, 2.0}, {"c", GoalStatus::ACTIVE, 3.0}});
  };
  begin();
  EXPECT_EQ(cancel("b"), Lines{"b ending"});
  begin();
  EXPECT_EQ(cancel("", 2.0), (Lines{"a ending", "b ending"}));
  begin();
  EXPECT_EQ(cancel("c", 1.0), (Lines{"a ending", "c ending"}));
  begin();
  EXPECT_EQ(cancel(""), (Lines{"a ending", "b ending", "c ending"}));
}

/// Claim: messages of different topics may arrive in any order.
TEST_F(ActionGoalsTest, TakesMessagesInAnyOrder) {
  EXPECT_EQ(status({{"a", GoalStatus::ACTIVE}}), Lines{"a unseen"});
  EXPECT_EQ(send("a"), "a followed");
  EXPECT_EQ(status({{"a", GoalStatus::PREEMPTED}}), Lines{"a ending"});
  now_ += 0.1;
  EXPECT_EQ(cancel("a"), Lines{"a stopped"}) << "the request arrives later than its effect";
  EXPECT_EQ(result("b", GoalStatus::REJECTED), Lines{});
  EXPECT_EQ(send("b"), "b refused");
  send("c");
  status({{"c", GoalStatus::ACTIVE}});
  status({{"c", GoalStatus::PREEMPTED}});
  now_ += 1.5;
  EXPECT_EQ(cancel(""), Lines{}) << "the goal was replaced long before; its other joints go on";
}

/// Claim: a goal that was sent before the node started is told of as long as the robot follows it.
TEST_F(ActionGoalsTest, TellsOfGoalsThatItHasNotReceived) {
  EXPECT_EQ(status({{"old", GoalStatus::SUCCEEDED}, {"a", GoalStatus::ACTIVE}}), Lines{"a unseen"});
  EXPECT_EQ(status({{"a", GoalStatus::ACTIVE}}), Lines{"a unseen"}) << "again, because the world may have changed";
  EXPECT_EQ(status({{"a", GoalStatus::PREEMPTING}}), Lines{"a unseen"});
  EXPECT_EQ(status({{"a", GoalStatus::ABORTED}}), Lines{"a over"});
  EXPECT_EQ(status({{"b", GoalStatus::ACTIVE}}), Lines{"b unseen"});
  EXPECT_EQ(status({}), Lines{"b over"});
}

/// Claim: a server that was started again has forgotten its goals; nobody knows whether the robot goes on.
TEST_F(ActionGoalsTest, EndsGoalsThatTheServerForgets) {
  send("a");
  EXPECT_EQ(status({}), Lines{}) << "the server has not received it so far";
  status({{"a", GoalStatus::ACTIVE}});
  EXPECT_EQ(status({}), Lines{"a ending"});
  EXPECT_EQ(status({}), Lines{});
}

/// Claim: a server ignores a second goal with an id that it has, so the robot does not follow it.
TEST_F(ActionGoalsTest, RefusesAnIdThatTheServerHas) {
  send("a");
  status({{"a", GoalStatus::ACTIVE}});
  EXPECT_EQ(send("a"), "a refused");
  status({});
  EXPECT_EQ(send("a"), "a sent") << "the server has forgotten it";
}

/// Claim: the id that the server makes for a goal without id is the next one that nobody has sent.
TEST_F(ActionGoalsTest, RecognizesGoalsWithoutId) {
  status({{"old", GoalStatus::SUCCEEDED}});
  EXPECT_EQ(send(""), "without id, number 1 sent");
  EXPECT_EQ(send(""), "without id, number 2 sent");
  EXPECT_EQ(send("named"), "named sent");
  EXPECT_EQ(status({{"old", GoalStatus::SUCCEEDED}, {"server-1", GoalStatus::ACTIVE}, {"named", GoalStatus::REJECTED}}),
            (Lines{"without id, number 1 followed", "named refused"}));
  EXPECT_EQ(status({{"server-1", GoalStatus::PREEMPTED}, {"server-2", GoalStatus::ACTIVE}}),
            (Lines{"without id, number 1 ending", "without id, number 2 followed"}));
  send("");
  now_ += 1.5;
  EXPECT_EQ(status({{"server-2", GoalStatus::ACTIVE}, {"other", GoalStatus::ACTIVE}}), Lines{"other unseen"})
      << "the server has not received the goal";
}

/// Claim: however many goals are sent, their number is bounded; what was forgotten counts as not received.
TEST_F(ActionGoalsTest, ForgetsGoalsOfAServerThatNeverAnswers) {
  for (int i = 0; i < 4500; ++i) send(std::to_string(i));
  EXPECT_EQ(status({{"0", GoalStatus::ACTIVE}}), Lines{"0 unseen"});
  EXPECT_EQ(status({{"0", GoalStatus::ACTIVE}, {"4499", GoalStatus::ACTIVE}}), (Lines{"0 unseen", "4499 followed"}));
}

}  // namespace
}  // namespace hgrid
