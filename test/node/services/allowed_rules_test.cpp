// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/AllowedPair.h>
#include <hgrid_proximity/RuleOrigin.h>
#include <hgrid_proximity/Rules.h>
#include <ros/this_node.h>
#include <ros/topic.h>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <stdexcept>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using msg::AllowedPair;
using Names = std::vector<std::string>;

AllowedPair pairOf(const std::string& first, const std::string& second, bool allowed, const std::string& reason = "") {
  AllowedPair pair;
  pair.first = first;
  pair.second = second;
  pair.allowed = allowed;
  pair.reason = reason;
  return pair;
}

AllowedPair allow(const std::string& first, const std::string& second, const std::string& reason = "") {
  return pairOf(first, second, true, reason);
}

AllowedPair enable(const std::string& first, const std::string& second, const std::string& reason = "") {
  return pairOf(first, second, false, reason);
}

msg::SetAllowed::Request toAdd(const std::vector<AllowedPair>& rules, bool force = false) {
  msg::SetAllowed::Request request;
  request.rules = rules;
  request.force = force;
  return request;
}

msg::SetAllowed::Request toRemove(const std::vector<AllowedPair>& rules) {
  msg::SetAllowed::Request request = toAdd(rules);
  request.remove = true;
  return request;
}

/// Three spheres in a row, each of which touches the next one. A post touches the last one. One rule is configured.
class AllowedRules : public ::testing::Test {
 protected:
  AllowedRules() {
    NodeSetup setup;
    setup.params =
        dict({{"obstacles", list({ball("post", 0.45, 0, 0, 0.1)})},
              {"limits/max_rules", 5},
              {"allowed_pairs",
               list({dict({{"first", "robot/c"}, {"second", "obstacle/p*"}, {"reason", "it leans there"}})})}});
    setup.beside["robot_description"] = balls({"a", "b", "c"});
    for (int i = 0; i < 3; ++i) transforms_.stream("base", std::string(1, static_cast<char>('a' + i)), at(0.15 * i));
    node_ = std::make_unique<NodeUnderTest>(setup);
    node_->waitForComplete();
  }
  /// Returns the pairs of the tick that a response names. Checks that this tick is the first with its bodies_revision.
  Names pairsOf(const msg::SetAllowed::Response& response) {
    EXPECT_TRUE(response.success) << response.code.text;
    node_->waitForPairs("the tick of the reply",
                        [&](const msg::Pairs& message) { return message.world.sequence >= response.world.sequence; });
    const Heard all = node_->heard();
    const auto tick = std::find_if(all.pairs.begin(), all.pairs.end(), [&](const msg::Pairs::ConstPtr& message) {
      return message->world.sequence == response.world.sequence;
    });
    if (tick == all.pairs.begin() || tick == all.pairs.end()) throw std::runtime_error("that tick was not received");
    EXPECT_EQ((*tick)->world.bodies_revision, response.world.bodies_revision);
    EXPECT_LT((*std::prev(tick))->world.bodies_revision, response.world.bodies_revision);
    return namesOf(**tick);
  }
  void expectRefused(const msg::SetAllowed::Request& request, const std::string& code, const std::string& words) {
    const Names before = namesOf(*node_->heard().pairs.back());
    const auto response = node_->setAllowed(request);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(response.code.name, code);
    EXPECT_TRUE(says(response.code.text, words));
    EXPECT_GT(response.world.sequence, 0u);
    node_->waitForTicks(2);
    EXPECT_EQ(namesOf(*node_->heard().pairs.back()), before) << "nothing has changed";
  }
  /// Returns each rule as "first second origin +"; "-" instead of "+" means that the rule does not allow the pair.
  Names rules() {
    msg::GetAllowed::Request request;
    request.rules = true;
    return gist(node_->getAllowed(request));
  }
  static Names gist(const msg::GetAllowed::Response& response) {
    EXPECT_TRUE(response.success) << response.code.text;
    return gist(response.entries);
  }
  static Names gist(const std::vector<AllowedPair>& entries) {
    Names lines;
    for (const AllowedPair& entry : entries) {
      lines.push_back(entry.first + " " + entry.second + " " + std::to_string(entry.origin) +
                      (entry.allowed ? " +" : " -"));
    }
    return lines;
  }

  TransformSource transforms_;
  std::unique_ptr<NodeUnderTest> node_;
  const Names all_ = {"obstacle/post|robot/b", "robot/a|robot/b", "robot/a|robot/c", "robot/b|robot/c"};
};

TEST_F(AllowedRules, AreInForceInTheTickThatTheReplyNames) {
  EXPECT_EQ(namesOf(*node_->heard().pairs.back()), all_);
  EXPECT_EQ(pairsOf(node_->setAllowed(toAdd({allow("robot/a", "robot/*", "parked")}))),
            Names({"obstacle/post|robot/b", "robot/b|robot/c"}));
  EXPECT_EQ(pairsOf(node_->setAllowed(toAdd({enable("robot/c", "robot/a")}))),
            Names({"obstacle/post|robot/b", "robot/a|robot/c", "robot/b|robot/c"}))
      << "a rule with two names takes precedence over a rule with a glob";
  EXPECT_EQ(pairsOf(node_->setAllowed(toAdd({enable("obstacle/post", "robot/c")}))),
            Names({"obstacle/post|robot/b", "obstacle/post|robot/c", "robot/a|robot/c", "robot/b|robot/c"}))
      << "it also takes precedence over the configured rule";
  EXPECT_EQ(pairsOf(node_->setAllowed(toRemove({allow("robot/*", "robot/a"), allow("robot/c", "obstacle/post")}))),
            all_);
  EXPECT_EQ(rules(), Names({"robot/c obstacle/p* 4 +", "robot/c robot/a 5 -"}));
}

TEST_F(AllowedRules, EndWithTheirLifetime) {
  AllowedPair brief = allow("robot/a", "robot/b", "for a moment");
  brief.lifetime = ros::Duration(0.5);
  const auto begin = std::chrono::steady_clock::now();
  const auto without = pairsOf(node_->setAllowed(toAdd({brief})));
  EXPECT_EQ(std::count(without.begin(), without.end(), "robot/a|robot/b"), 0);
  msg::GetAllowed::Request request;
  request.rules = true;
  request.first = "robot/a";
  const auto entries = node_->getAllowed(request).entries;
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_GT(entries[0].lifetime.toSec(), 0.0);
  EXPECT_LE(entries[0].lifetime.toSec(), 0.5);
  EXPECT_EQ(entries[0].reason, "for a moment");
  node_->waitForPairs("the pair is back", [&](const msg::Pairs& pairs) { return namesOf(pairs) == all_; });
  EXPECT_GT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(450));
  EXPECT_EQ(rules(), Names({"robot/c obstacle/p* 4 +"}));
}

TEST_F(AllowedRules, AreAllRefusedIfOneIsInvalid) {
  expectRefused(toAdd({allow("robot/a", "robot/b"), allow("robot/a", "robot/bb")}), "UNKNOWN_ID",
                "there is no body 'robot/bb'; similar names are");
  expectRefused(toAdd({allow("leg/*", "*")}), "UNKNOWN_ID", "no body matches the glob 'leg/*'");
  expectRefused(toAdd({allow("", "robot/b")}), "BAD_ID", "it must not be empty");
  expectRefused(toAdd({allow("robot/a\n", "robot/b")}), "BAD_ID", "robot/a\\x0a");
  expectRefused(toAdd({allow("robot/a", "robot/b", std::string(600, 'x'))}), "OUT_OF_RANGE", "has 600 bytes");
  AllowedPair negative = allow("robot/a", "robot/b");
  negative.lifetime = ros::Duration(-1.0);
  expectRefused(toAdd({negative}), "OUT_OF_RANGE", "must not be negative");
  expectRefused(toRemove({allow("robot/a", "robot/b")}), "UNKNOWN_ID", "there is no rule 'robot/a', 'robot/b'");
  expectRefused(toRemove({allow("robot/c", "obstacle/p*")}), "UNKNOWN_ID", "was configured and cannot be removed");
  expectRefused(toAdd(std::vector<AllowedPair>(6, allow("robot/a", "robot/b"))), "LIMIT", "the request has 6 rules");
  expectRefused(toAdd({allow("robot/a", "robot/b"), allow("robot/a", "robot/c"), allow("robot/b", "robot/c"),
                       allow("robot/base", "robot/a"), allow("robot/base", "robot/b")}),
                "LIMIT", "there would be 6 rules");
  EXPECT_EQ(rules(), Names({"robot/c obstacle/p* 4 +"}));
}

TEST_F(AllowedRules, ThatSwitchOffEveryPairNeedForceAndAreWarnedOf) {
  const auto everything = allow("*", "*", "maintenance");
  expectRefused(toAdd({everything}), "NEEDS_FORCE", "with these rules no pair of bodies would ever be reported");
  EXPECT_TRUE(pairsOf(node_->setAllowed(toAdd({everything}, true))).empty());
  const auto level = [](const Heard& all) {
    const auto found = all.diagnostics.find("world");
    return found == all.diagnostics.end() ? -1 : int(found->second.level);
  };
  node_->waitUntil("a warning in /diagnostics", [&](const Heard& all) { return level(all) == DiagnosticStatus::WARN; });
  EXPECT_TRUE(says(node_->heard().diagnostics.at("world").message, "rules switch off every pair"));
  EXPECT_EQ(pairsOf(node_->setAllowed(toRemove({everything}))), all_);
  node_->waitUntil("no warning in /diagnostics", [&](const Heard& all) { return level(all) == DiagnosticStatus::OK; });
}

TEST_F(AllowedRules, OutliveAReset) {
  const Names some = pairsOf(node_->setAllowed(toAdd({allow("robot/a", "robot/b")})));
  EXPECT_TRUE(node_->reset().success);
  node_->waitForComplete();
  node_->waitForTicks(2);
  EXPECT_EQ(namesOf(*node_->heard().pairs.back()), some);
}

TEST_F(AllowedRules, SayWhoSetThemAndWhen) {
  const ros::Time begin = ros::Time::now();
  AllowedPair rule = allow("robot/a", "robot/*");
  rule.origin = msg::RuleOrigin::SRDF;  // the node ignores it
  rule.set_by = "/somebody/else";       // the node ignores it
  pairsOf(node_->setAllowed(toAdd({rule})));
  const ros::Time end = ros::Time::now();
  msg::GetAllowed::Request request;
  for (const bool as_given : {true, false}) {
    request.rules = as_given;
    std::size_t of_service = 0;
    for (const AllowedPair& entry : node_->getAllowed(request).entries) {
      SCOPED_TRACE(entry.first + " " + entry.second);
      const bool is_set = entry.origin == msg::RuleOrigin::SERVICE;
      of_service += is_set ? 1 : 0;
      EXPECT_EQ(entry.set_by, is_set ? ros::this_node::getName() : "");
      EXPECT_EQ(entry.since.isZero(), !is_set);
      EXPECT_EQ(begin <= entry.since && entry.since <= end, is_set) << entry.since;
    }
    EXPECT_EQ(of_service, as_given ? 1u : 3u);
  }
  const AllowedPair explained = node_->explain("robot/a", "robot/b").rule;
  EXPECT_EQ(explained.set_by, ros::this_node::getName());
}

TEST_F(AllowedRules, SayHowManyPairsTheySwitchOffOrOn) {
  const auto changed = [&](const msg::SetAllowed::Request& request) {
    const auto response = node_->setAllowed(request);
    EXPECT_TRUE(response.success) << response.code.text;
    return response.pairs_changed;
  };
  EXPECT_EQ(changed(toAdd({allow("robot/a", "robot/*")})), 2u) << "with b and c; that with base was off already";
  EXPECT_EQ(changed(toAdd({allow("robot/a", "robot/b")})), 0u);
  EXPECT_EQ(changed(toAdd({enable("robot/a", "*")})), 2u) << "with c and base; a stronger rule decides about b";
  EXPECT_EQ(changed(toRemove({allow("robot/a", "robot/b")})), 1u);
  EXPECT_EQ(node_->setAllowed(toAdd({allow("robot/a", "robot/x")})).pairs_changed, 0u) << "the request was refused";
}

/// Subscribes to ~rules, which is latched.
class RulesTopic : public AllowedRules {
 protected:
  RulesTopic() {
    const boost::function<void(const msg::Rules::ConstPtr&)> hear = [this](const msg::Rules::ConstPtr& message) {
      const std::lock_guard<std::mutex> lock(mutex_);
      newest_ = message;
    };
    subscriber_ = ros::NodeHandle().subscribe<msg::Rules>(node_->named("rules"), 10, hear);
  }
  /// Waits until the newest message has these rules and an epoch greater than `after_epoch`. Returns this message.
  msg::Rules::ConstPtr waitFor(const Names& rules, std::uint64_t after_epoch = 0) {
    msg::Rules::ConstPtr message;
    node_->waitUntil("~rules", [&](const Heard&) {
      const std::lock_guard<std::mutex> lock(mutex_);
      message = newest_;
      return message && gist(message->rules) == rules && message->epoch > after_epoch;
    });
    return message;
  }
  const std::string configured_ = "robot/c obstacle/p* 4 +";

 private:
  std::mutex mutex_;
  msg::Rules::ConstPtr newest_;
  ros::Subscriber subscriber_;
};

TEST_F(RulesTopic, HasTheConfiguredRulesFromTheStart) {
  const auto message = waitFor({configured_});
  EXPECT_EQ(message->header.frame_id, node_->heard().pairs.back()->header.frame_id);
  EXPECT_EQ(message->epoch, node_->heard().pairs.back()->world.epoch);
  EXPECT_EQ(message->rules[0].reason, "it leans there");
}

TEST_F(RulesTopic, IsPublishedWhenRulesAreSetAndRemoved) {
  waitFor({configured_});
  const auto response = node_->setAllowed(toAdd({allow("robot/a", "*"), enable("robot/a", "robot/b")}));
  const auto message = waitFor({configured_, "robot/a * 5 +", "robot/a robot/b 5 -"});
  EXPECT_EQ(message->bodies_revision, response.world.bodies_revision);
  EXPECT_EQ(message->header.stamp, response.world.stamp);
  EXPECT_EQ(message->rules[1].set_by, ros::this_node::getName());
  node_->setAllowed(toRemove({allow("robot/a", "*")}));
  waitFor({configured_, "robot/a robot/b 5 -"});
}

TEST_F(RulesTopic, IsPublishedWhenARuleEnds) {
  AllowedPair brief = allow("robot/a", "robot/b");
  brief.lifetime = ros::Duration(1.0);
  node_->setAllowed(toAdd({brief}));
  const auto message = waitFor({configured_, "robot/a robot/b 5 +"});
  EXPECT_GT(message->rules[1].lifetime.toSec(), 0.0);
  EXPECT_LE(message->rules[1].lifetime.toSec(), 1.0);
  waitFor({configured_});
}

TEST_F(RulesTopic, IsPublishedAfterAReset) {
  const std::uint64_t before = waitFor({configured_})->epoch;
  EXPECT_TRUE(node_->reset().success);
  waitFor({configured_}, before);
}

TEST_F(AllowedRules, TheMatrixIsReturnedForGlobsWithALimitAndAsSrdf) {
  pairsOf(node_->setAllowed(toAdd({allow("robot/b", "robot/a", "parked & safe"), enable("robot/base", "robot/c")})));
  msg::GetAllowed::Request request;
  request.as_srdf = true;
  const auto all = node_->getAllowed(request);
  EXPECT_EQ(gist(all), Names({"obstacle/post robot/c 4 +", "robot/a robot/b 5 +", "robot/a robot/base 2 +",
                              "robot/b robot/base 2 +", "robot/base robot/c 5 -"}));
  EXPECT_EQ(all.total, 5u);
  EXPECT_FALSE(all.truncated);
  EXPECT_EQ(all.entries[0].reason, "it leans there");
  EXPECT_EQ(all.entries[0].lifetime, ros::Duration(0));
  EXPECT_EQ(all.srdf,
            "<robot name=\"r\">\n"
            "  <disable_collisions link1=\"a\" link2=\"b\" reason=\"parked &amp; safe\"/>\n"
            "  <disable_collisions link1=\"a\" link2=\"base\" reason=\"joint 'base_a' connects them\"/>\n"
            "  <disable_collisions link1=\"b\" link2=\"base\" reason=\"joint 'base_b' connects them\"/>\n"
            "  <enable_collisions link1=\"base\" link2=\"c\" reason=\"\"/>\n"
            "</robot>\n");
  request.first = "robot/base";
  request.second = "robot/*";
  request.limit = 2;
  const auto some = node_->getAllowed(request);
  EXPECT_EQ(gist(some), Names({"robot/a robot/base 2 +", "robot/b robot/base 2 +"}));
  EXPECT_EQ(some.total, 3u);
  EXPECT_TRUE(some.truncated);
  request.first = std::string(513, '*');
  EXPECT_EQ(node_->getAllowed(request).code.name, "BAD_ID");
}

TEST(RulesBeforeTheWorld, AreTheConfiguredOnes) {
  NodeSetup setup;  // without a robot there is no world frame
  setup.params = dict({{"allowed_pairs", list({dict({{"first", "a/b"}, {"second", "*"}})})}});
  NodeUnderTest node(setup);
  const auto message = ros::topic::waitForMessage<msg::Rules>(node.named("rules"), ros::Duration(20.0));
  ASSERT_TRUE(message);
  ASSERT_EQ(message->rules.size(), 1u);
  EXPECT_EQ(message->rules[0].origin, msg::RuleOrigin::PARAMETER);
  EXPECT_EQ(message->bodies_revision, 0u);
  EXPECT_TRUE(message->header.stamp.isZero());
}

TEST(AllowedBeforeTheWorld, IsNotReady) {
  NodeUnderTest node(NodeSetup{});  // without a robot there is no world frame
  EXPECT_EQ(node.setAllowed(toAdd({allow("*", "*")})).code.name, "NOT_READY");
  EXPECT_EQ(node.getAllowed().code.name, "NOT_READY");
  EXPECT_EQ(node.explain("robot/a", "robot/b").code.name, "NOT_READY");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
