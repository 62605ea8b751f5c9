// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"
#include "hgrid_proximity/pairs/name_matches.h"
#include "hgrid_proximity/pairs/pair_rule.h"

namespace hgrid {

class NameIndex;

/// Selects the kinds of pair that exist at all. A pair of two fixed bodies never exists.
struct PairKinds {
  bool self = true;             ///< links of one robot
  bool robot_robot = true;      ///< links of two robots
  bool robot_obstacle = true;   ///< a link and an obstacle or track
  bool robot_map = true;        ///< a link and a map or cloud
  bool moving_obstacle = true;  ///< a moving obstacle or track, and any other obstacle, track, map or cloud
};

/// Says whether a pair of bodies is reported, what decided that, and why.
struct PairDecision {
  static constexpr std::uint32_t kNoRule = 0xffffffff;  ///< stands for "no rule"

  Origin origin = Origin::none;  ///< source of the decision; none: no source, so the pair is reported
  bool allowed = false;          ///< true: the two bodies may touch, and the pair is not reported
  std::string reason;            ///< reason from the rule, the SRDF or the robot's joints; may be empty
  std::uint32_t rule = kNoRule;  ///< index of the deciding rule in PairFilter::rules(), or kNoRule
};

/// Decides which pairs of bodies are reported. Immutable: a new filter is created when bodies or rules change.
///
/// The filter stores no matrix of all pairs. It looks up two links of one robot in the LinkMatrix of their model. It
/// keeps rules for two names in a sorted list. It matches globs once per body and stores the results as bit sets.
class PairFilter {
 public:
  static constexpr std::uint32_t kNoRule = PairDecision::kNoRule;  ///< stands for "no rule"
  static constexpr std::uint32_t kUnknown = 0xffffffff;  ///< stands for "a body that the filter does not know"

  PairFilter() = default;
  /// @param bodies  the bodies that the indices in the other functions refer to; not kept
  /// @param rules   if two equally exact rules match a pair, the later one decides (see PairRule)
  PairFilter(const BodyList& bodies, PairKinds kinds, std::vector<PairRule> rules);

  /// Returns the filter without some of its rules, for the same bodies. Takes much less time than a new filter, because
  /// it matches no globs.
  /// @param gone  for each rule: whether it is left out; as many values as there are rules
  PairFilter without(const std::vector<bool>& gone) const;
  /// Returns a filter with the same kinds and rules for other bodies. Takes much less time than a new filter if this
  /// filter knows most of the bodies, because it matches globs only with the names of the others.
  /// @param bodies  the bodies that the indices in the other functions of the returned filter refer to; not kept
  /// @param known   for each of them: its index in this filter, or kUnknown. The body must be the same in both.
  /// @param matches  results of match() for names of the others, which save the time to match these names. They never
  ///                 change the result: those of a filter with other globs are ignored.
  PairFilter forBodies(const BodyList& bodies, const std::vector<std::uint32_t>& known,
                       const std::vector<NameMatches>& matches = {}) const;
  /// Matches names with the globs of the rules. Takes long if there are many names and many rules. Several threads may
  /// call this at a time. @param names  in any order; a name may occur several times
  NameMatches match(std::vector<std::string> names) const;

  /// Returns whether the pair of the two bodies is switched off, which means that it is not reported. Symmetric.
  bool allowed(std::uint32_t first, std::uint32_t second) const {
    Origin origin = Origin::none;
    if (!asksMatrix(first, second, origin)) return origin != Origin::none;
    return LinkMatrix::isIn(subjects_[first].allowed, subjects_[second].link);
  }
  /// Returns why the pair is switched off; Origin::none if it is reported. The first of these that applies decides: the
  /// two bodies are the same body, their kind of pair does not exist, the rule that takes precedence, the matrix of the
  /// robot model, the group of two obstacles.
  Origin origin(std::uint32_t first, std::uint32_t second) const {
    Origin origin = Origin::none;
    if (!asksMatrix(first, second, origin)) return origin;
    return matrices_[subjects_[first].matrix]->origin(subjects_[first].link, subjects_[second].link);
  }

  /// Returns the decision about a pair with all details. Unlike origin(), it also names the rule or SRDF tag that says
  /// that the pair is reported.
  PairDecision decision(std::uint32_t first, std::uint32_t second) const;
  /// Returns the rules in the order in which the constructor received them.
  const std::vector<PairRule>& rules() const { return rules_; }
  /// Returns whether a rule may match a pair that contains this body.
  bool isRuled(std::uint32_t body) const { return subjects_[body].ruled != 0; }
  /// Appends numbers to `key` that describe how the filter treats this body in pairs with bodies outside its robot.
  ///
  /// The filter treats bodies with equal numbers alike. Let A and B be two such bodies, and C a third body outside the
  /// robots of A and B. Then the filter gives the same result for the pairs (A, C) and (B, C). It also gives the same
  /// result for all pairs of bodies with these numbers, except for pairs of links of one robot.
  void appendKey(std::uint32_t body, std::vector<std::uint64_t>& key) const;
  /// Returns whether at least one pair is reported when its bodies are near.
  bool reportsAny() const;
  /// Returns the memory [bytes] that the filter uses, without the matrices of the robot models.
  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kNoRobot = 0xffffffff;    // stands for "no robot"
  static constexpr std::size_t kTypes = 10;                // a type is one of 5 kinds of body, fixed or moving
  static constexpr std::uint8_t kByName = 1, kByGlob = 2;  // bits of Subject::ruled
  struct Subject {
    const std::uint64_t* allowed = nullptr;  // bit set of LinkMatrix::allowedWith() for this link; null: no model
    std::uint32_t robot = kNoRobot;          // equal for links of one robot, and for obstacles of one group
    std::uint32_t link = 0;                  // Body::link
    std::uint32_t matrix = 0;                // index in matrices_ of the matrix of its robot model
    std::uint8_t type = 0;                   // kind and mobility of the body, as one number less than kTypes
    std::uint8_t ruled = 0;  // bits kByName and kByGlob: which kinds of rule have a name or glob for this body
  };
  struct NamedPair {
    std::uint64_t bodies;  // the two indices, the smaller one in the upper 32 bits
    std::uint32_t rule;    // index in rules_
  };
  static bool isObstacle(std::uint8_t type) { return type / 2 == static_cast<int>(BodyKind::obstacle); }
  /// Returns whether the matrix of the robot model decides about the pair. If not, sets `origin` to the result.
  bool asksMatrix(std::uint32_t first, std::uint32_t second, Origin& origin) const {
    if (first == second) return origin = Origin::self, false;
    const Subject &a = subjects_[first], &b = subjects_[second];
    const bool same_robot = a.robot == b.robot && a.robot != kNoRobot;
    if (!exists_[same_robot][a.type][b.type]) return origin = Origin::kind, false;
    if ((a.ruled & b.ruled) != 0) {
      const std::uint32_t rule = ruleOf(first, second);
      if (rule != kNoRule) return origin = verdicts_[rule], false;
    }
    if (same_robot && isObstacle(a.type)) return origin = Origin::group, false;
    return same_robot && a.allowed != nullptr;
  }
  void fillSubjects(const BodyList& bodies);
  void listRules();
  void fillNamed(const NameIndex& names);
  void matchGlobs(const NameIndex& names);
  void copySets(const PairFilter& from, const std::vector<std::uint32_t>& known);
  NameMatches::Globs globs() const;
  bool copyMatch(const NameMatches& from, const std::string& name, std::uint32_t body);
  std::vector<std::uint32_t> copyMatches(const std::vector<NameMatches>& matches, const BodyList& bodies,
                                         const std::vector<std::uint32_t>& known);
  std::uint32_t ruleOf(std::uint32_t first, std::uint32_t second) const;
  std::vector<std::uint32_t> representatives() const;

  using ByType = std::array<std::array<bool, kTypes>, kTypes>;
  std::array<ByType, 2> exists_ = {};  // by (links of one robot or not, type, type): whether such pairs exist
  std::vector<Subject> subjects_;      // one for each body, by index of the body
  std::vector<std::shared_ptr<const LinkMatrix>> matrices_;  // keeps the matrices alive that subjects_ point into
  std::vector<PairRule> rules_;
  std::vector<Origin> verdicts_;  // for each rule: its origin, or none if the rule says "report this pair"
  std::vector<NamedPair> named_;  // sorted by bodies; of several rules that name one pair, the last comes first
  std::vector<std::uint32_t> glob_rules_;  // rules that contain a glob; bit k of the bit sets stands for
                                           // glob_rules_[k], kNoRule if without() left the rule out
  std::size_t words_ = 0;                  // number of 64-bit words per body in the bit sets
  std::vector<std::uint64_t> as_first_;    // one bit set per body; bit k: `first` of the rule matches the body
  std::vector<std::uint64_t> as_second_;   // one bit set per body; bit k: `second` of the rule matches the body
};

/// Returns whether the rules switch off every pair that would be reported without them.
bool silencesAll(const BodyList& bodies, const PairKinds& kinds, const PairFilter& filter);

}  // namespace hgrid
