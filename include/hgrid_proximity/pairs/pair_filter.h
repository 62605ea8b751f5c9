// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/pairs/pair_rule.h"

namespace hgrid {

class NameIndex;

/// Which kinds of pair exist at all.
struct PairKinds {
  bool self = true;             ///< links of one robot
  bool robot_robot = true;      ///< links of two robots
  bool robot_obstacle = true;   ///< a link and an obstacle
  bool robot_map = true;        ///< a link and a map or cloud
  bool moving_obstacle = true;  ///< an obstacle in a moving frame and any other obstacle or map
};

/// What decides of a pair of bodies, and why.
struct PairDecision {
  static constexpr std::uint32_t kNoRule = 0xffffffff;

  Origin origin = Origin::none;  ///< of what decides; none: nothing speaks of the pair, so it is reported
  bool allowed = false;          ///< the pair may touch and is not reported
  std::string reason;            ///< of the rule, of the SRDF or of the robot's joints; may be empty
  std::uint32_t rule = kNoRule;  ///< index into PairFilter::rules()
};

/// Decides which pairs of bodies are reported. Made anew when bodies or rules change; immutable.
///
/// Holds no matrix of the world: within a robot it asks the model's LinkMatrix; rules for two names stand in a sorted
/// list; globs were matched once per body and are compared as bit sets.
class PairFilter {
 public:
  static constexpr std::uint32_t kNoRule = PairDecision::kNoRule;

  PairFilter() = default;
  /// @param bodies  what the indices of allowed() mean; not kept
  /// @param rules   the stronger of two that are equally exact last
  PairFilter(const std::vector<Body>& bodies, PairKinds kinds, std::vector<PairRule> rules);

  /// Whether the pair may touch, that is, is not reported. Symmetric.
  bool allowed(std::uint32_t first, std::uint32_t second) const {
    Origin origin = Origin::none;
    if (!asksMatrix(first, second, origin)) return origin != Origin::none;
    return LinkMatrix::isIn(subjects_[first].allowed, subjects_[second].link);
  }
  /// Why it may, the first that holds of: self, kind, the strongest rule, the model's matrix.
  Origin origin(std::uint32_t first, std::uint32_t second) const {
    Origin origin = Origin::none;
    if (!asksMatrix(first, second, origin)) return origin;
    return matrices_[subjects_[first].matrix]->origin(subjects_[first].link, subjects_[second].link);
  }

  /// As origin(), with all that is known of it: also where a rule or an SRDF says that the pair is reported.
  PairDecision decision(std::uint32_t first, std::uint32_t second) const;
  const std::vector<PairRule>& rules() const { return rules_; }
  /// Whether a rule speaks of some pair of this body.
  bool isRuled(std::uint32_t body) const { return subjects_[body].ruled != 0; }
  /// Appends numbers to `key` that decide all pairs of this body with bodies of other robots or of none: bodies that
  /// get equal numbers are in equal pairs with every third body, and with each other if they are not links of one
  /// robot.
  void appendKey(std::uint32_t body, std::vector<std::uint64_t>& key) const;
  /// Whether there is a pair that is reported when it is near.
  bool reportsAny() const;

 private:
  static constexpr std::uint32_t kNoRobot = 0xffffffff;
  static constexpr std::size_t kTypes = 8;                 // kinds of body, each fixed or moving
  static constexpr std::uint8_t kByName = 1, kByGlob = 2;  // bits of Subject::ruled
  struct Subject {
    const std::uint64_t* allowed = nullptr;  // links of its robot that it may touch, by the model; null: no model
    std::uint32_t robot = kNoRobot;          // equal for links of one robot
    std::uint32_t link = 0;
    std::uint32_t matrix = 0;  // its model's
    std::uint8_t type = 0;
    std::uint8_t ruled = 0;  // what kind of rule knows it; both of a pair must be known by one kind
  };
  struct NamedPair {
    std::uint64_t bodies;  // the smaller index in the upper half
    std::uint32_t rule;
  };
  /// Whether the model's matrix decides; else `origin` is what does.
  bool asksMatrix(std::uint32_t first, std::uint32_t second, Origin& origin) const {
    if (first == second) return origin = Origin::self, false;
    const Subject &a = subjects_[first], &b = subjects_[second];
    const bool same_robot = a.robot == b.robot && a.robot != kNoRobot;
    if (!exists_[same_robot][a.type][b.type]) return origin = Origin::kind, false;
    if ((a.ruled & b.ruled) != 0) {
      const std::uint32_t rule = ruleOf(first, second);
      if (rule != kNoRule) return origin = verdicts_[rule], false;
    }
    return same_robot && a.allowed != nullptr;
  }
  void resolve(const std::vector<Body>& bodies);
  void fillSets(const NameIndex& names, std::size_t bodies);
  std::uint32_t ruleOf(std::uint32_t first, std::uint32_t second) const;
  std::vector<std::uint32_t> representatives() const;

  bool exists_[2][kTypes][kTypes] = {};  // by whether they are links of one robot, and by the types of both
  std::vector<Subject> subjects_;
  std::vector<std::shared_ptr<const LinkMatrix>> matrices_;  // holds what subjects_ point to
  std::vector<PairRule> rules_;
  std::vector<Origin> verdicts_;           // by rule: its origin, or none where it says that the pair is reported
  std::vector<NamedPair> named_;           // sorted; of several rules for one pair the last
  std::vector<std::uint32_t> glob_rules_;  // rules with a glob; bit k in the sets is of glob_rules_[k]
  std::size_t words_ = 0;                  // 64-bit words per body in the bit sets
  std::vector<std::uint64_t> as_first_, as_second_;  // bit k: the body matches that rule's first, second
};

/// Whether the rules switch off every pair that would be reported without them.
bool silencesAll(const std::vector<Body>& bodies, const PairKinds& kinds, const PairFilter& filter);

}  // namespace hgrid
