// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/scene/body.h"

namespace hgrid {

/// Two globs over body names: pairs that match, in either order, may touch without being reported.
struct AllowedPattern {
  std::string first, second, reason;
};

/// Which kinds of pair exist at all.
struct PairKinds {
  bool self = true;             ///< links of one robot
  bool robot_robot = true;      ///< links of two robots
  bool robot_obstacle = true;   ///< a link and an obstacle
  bool robot_map = true;        ///< a link and a map or cloud
  bool moving_obstacle = true;  ///< an obstacle in a moving frame and any other obstacle or map
};

/// Decides which pairs of bodies are reported. Made anew when bodies or rules change; immutable.
///
/// Holds no matrix of the world: within a robot it asks the model's LinkMatrix; globs were matched once
/// per body and are compared as bit sets.
class PairFilter {
 public:
  PairFilter() = default;
  /// @param bodies  what the indices of allowed() mean; not kept
  PairFilter(const std::vector<Body>& bodies, PairKinds kinds, std::vector<AllowedPattern> patterns);

  /// Whether the pair may touch, that is, is not reported. Symmetric.
  bool allowed(std::uint32_t first, std::uint32_t second) const { return origin(first, second) != Origin::none; }
  /// Why it may, the first that holds of: self, kind, the model's matrix, a pattern.
  Origin origin(std::uint32_t first, std::uint32_t second) const {
    if (first == second) return Origin::self;
    const Subject &a = subjects_[first], &b = subjects_[second];
    const bool same_robot = a.robot == b.robot && a.robot != kNoRobot;
    if (!exists_[same_robot][a.type][b.type]) return Origin::kind;
    if (same_robot && a.links != nullptr) {
      const Origin origin = a.links->origin(a.link, b.link);
      if (origin != Origin::none) return origin;
    }
    return words_ > 0 && patternMatches(first, second) ? Origin::parameter : Origin::none;
  }

 private:
  static constexpr std::uint32_t kNoRobot = 0xffffffff;
  static constexpr std::size_t kTypes = 6;  // kinds of body, each fixed or moving
  struct Subject {
    std::uint32_t robot = kNoRobot;  // equal for links of one robot
    std::uint32_t link = 0;
    const LinkMatrix* links = nullptr;
    std::uint8_t type = 0;
  };
  bool patternMatches(std::uint32_t first, std::uint32_t second) const;

  bool exists_[2][kTypes][kTypes] = {};  // by whether they are links of one robot, and by the types of both
  std::vector<Subject> subjects_;
  std::vector<std::shared_ptr<const LinkMatrix>> matrices_;  // keeps what subjects_ point to
  std::size_t words_ = 0;                                    // 64-bit words per body in the bit sets
  std::vector<std::uint64_t> as_first_, as_second_;          // bit k: the body matches pattern k's first, second
};

}  // namespace hgrid
