// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace hgrid {

struct RobotModel;

/// Why a pair is switched off, which means: it is never reported. The numbers are part of the interface: do not change
/// them.
enum class Origin : std::uint8_t {
  none = 0,
  rigid = 1,
  adjacent = 2,
  srdf = 3,
  parameter = 4,
  service = 5,
  kind = 6,
  attached = 7,
  self = 8,
  moveit = 9,
  group = 10,
};

/// The rules of an SRDF for pairs of links. Links are given by name.
struct LinkRules {
  /// Two links that one tag names.
  struct Pair {
    std::string first;   ///< name of one link
    std::string second;  ///< name of the other link
    std::string reason;  ///< attribute `reason` of the tag; may be empty
  };
  std::vector<Pair> disabled;                 ///< tags disable_collisions: these pairs are switched off
  std::vector<std::string> disabled_default;  ///< tags disable_default_collisions: every pair with such a link is off
  std::vector<Pair> enabled;  ///< tags enable_collisions: override disabled_default, adjacency and rigid groups
};

/// Stores for each pair of links of one robot model whether the two links may touch. Such pairs are switched off.
///
/// Equal robots share one matrix. It is symmetric, and the pair of a link with itself is Origin::self. It is immutable,
/// and copies share memory.
class LinkMatrix {
 public:
  /// Switches off all pairs of links of one rigid group and of adjacent links, then applies the rules of an SRDF.
  ///
  /// A moving joint makes adjacent the nearest links with geometry above it and the nearest ones below it. These are
  /// its own two links if they have geometry. From a link without geometry, the nearest ones are found over fixed
  /// joints, through links without geometry only. Other links of the two rigid groups are not adjacent.
  ///
  /// Several moving joints in one chain from parent to child count as one joint if no link between them has geometry
  /// and the origins of consecutive joints are at most 1 cm apart while all joints are at zero.
  ///
  /// disable_collisions takes precedence over enable_collisions. enable_collisions takes precedence over
  /// disable_default_collisions, adjacency and rigid groups. A rule with a link that the model does not have is ignored
  /// and adds one sentence to `warnings`.
  LinkMatrix(const RobotModel& model, const LinkRules& rules, std::vector<std::string>& warnings);

  /// Whether the pair is allowed to touch, that is, switched off.
  bool allowed(std::uint32_t first, std::uint32_t second) const { return isIn(allowedWith(first), second); }
  /// Returns all links whose pair with `link` is allowed, as a bit set for isIn(). Bit sets are small enough for the
  /// caches. That matters because the pair filter reads them for every near pair of many robots.
  const std::uint64_t* allowedWith(std::uint32_t link) const;
  /// Whether a bit set of allowedWith() contains `link`.
  static bool isIn(const std::uint64_t* links, std::uint32_t link) {
    return (links[link / 64] >> (link % 64) & 1u) != 0;
  }
  /// Returns why the pair is switched off, or Origin::none if it is not switched off.
  Origin origin(std::uint32_t first, std::uint32_t second) const;
  /// Returns the number of links.
  std::size_t size() const;
  /// Returns the name that the URDF gives the robot. Equal robots have the same one.
  const std::string& modelName() const;

  /// The SRDF tag that names one pair of links.
  struct Tag {
    bool disabled = true;  ///< true: disable_collisions; false: enable_collisions
    std::string reason;    ///< attribute `reason` of the tag, made printable; may be empty
  };
  /// Returns the SRDF tag that decides about the pair, or null if no tag names it.
  const Tag* tag(std::uint32_t first, std::uint32_t second) const;
  /// Returns a clause that says why two adjacent links may touch. It names the joints that connect them.
  std::string adjacencyReason(std::uint32_t first, std::uint32_t second) const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace hgrid
