// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hgrid {

class GroupTree;
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

/// Which links of one robot model may touch without being reported: one matrix per model, shared by equal robots.
/// The matrix is symmetric. A link with itself is Origin::self.
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

  bool allowed(std::uint32_t first, std::uint32_t second) const { return isIn(allowedWith(first), second); }
  /// The links that may touch this one, as a set of bits, for isIn(). Every near pair asks, of many robots in turn, so
  /// that caches should have to hold little.
  const std::uint64_t* allowedWith(std::uint32_t link) const { return allowed_.data() + link * words_; }
  static bool isIn(const std::uint64_t* links, std::uint32_t link) {
    return (links[link / 64] >> (link % 64) & 1u) != 0;
  }
  Origin origin(std::uint32_t first, std::uint32_t second) const { return origins_[first * size_ + second]; }
  std::size_t size() const { return size_; }

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
  void setGroups(const RobotModel& model);
  void applyRules(const RobotModel& model, const LinkRules& rules, std::vector<std::string>& warnings);
  void set(std::uint32_t first, std::uint32_t second, Origin origin);

  std::size_t size_, words_;  // links; 64-bit words of a set of links
  std::shared_ptr<const GroupTree> groups_;
  std::vector<std::uint32_t> group_of_;  // by link
  std::vector<Origin> origins_;
  std::vector<std::uint64_t> allowed_;                           // bit: there is an origin
  std::map<std::pair<std::uint32_t, std::uint32_t>, Tag> tags_;  // by links, the smaller first: few pairs have one
};

}  // namespace hgrid
