// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace hgrid {

struct RobotModel;

/// What switches a pair off. The numbers are part of the interface: do not change them.
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
};

/// What an SRDF says of pairs of links, by link name.
struct LinkRules {
  struct Pair {
    std::string first, second, reason;
  };
  std::vector<Pair> disabled;                 ///< disable_collisions
  std::vector<std::string> disabled_default;  ///< disable_default_collisions: every pair of this link
  std::vector<Pair> enabled;                  ///< enable_collisions: undoes defaults, adjacency and rigid groups
};

/// Which links of one robot model may touch without being reported. Equal robots share one matrix.
///
/// The matrix is symmetric. A link with itself is Origin::self. Immutable; copies share memory.
class LinkMatrix {
 public:
  /// Switches off all pairs of links of one rigid group and of two adjacent groups, then applies the rules of an SRDF.
  ///
  /// Two groups are adjacent if exactly one moving joint connects them. They are also adjacent if several moving joints
  /// connect them in one chain from parent to child, no link of a group between them has geometry, and the origins of
  /// consecutive joints (all joints at zero) are at most 1 cm apart.
  ///
  /// An explicit disable takes precedence over an enable. An enable takes precedence over a default disable, adjacency
  /// and rigid groups. A rule that names a link that the model does not have is left out and adds one sentence to
  /// `warnings`.
  LinkMatrix(const RobotModel& model, const LinkRules& rules, std::vector<std::string>& warnings);

  /// Whether the pair is off.
  bool allowed(std::uint32_t first, std::uint32_t second) const { return isIn(allowedWith(first), second); }
  /// The links whose pairs with this link are off, as a bit set for isIn(). The filter of pairs asks this for every
  /// near pair of many robots, so the set is small enough for the caches.
  const std::uint64_t* allowedWith(std::uint32_t link) const;
  static bool isIn(const std::uint64_t* links, std::uint32_t link) {
    return (links[link / 64] >> (link % 64) & 1u) != 0;
  }
  /// What switches the pair off; Origin::none if nothing does.
  Origin origin(std::uint32_t first, std::uint32_t second) const;
  /// Number of links.
  std::size_t size() const;

  /// What an SRDF says of just this pair.
  struct Tag {
    bool disabled = true;  ///< disable_collisions; else enable_collisions
    std::string reason;    ///< its attribute, made printable; may be empty
  };
  /// The tag that decides of a pair; null: it has none.
  const Tag* tag(std::uint32_t first, std::uint32_t second) const;
  /// Why two links of adjacent groups may touch, with the names of the joints that connect their groups.
  std::string adjacencyReason(std::uint32_t first, std::uint32_t second) const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace hgrid
