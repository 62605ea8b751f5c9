// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hgrid {

/// Where it comes from that a pair is not reported; the numbers are those of msg/AllowedPair.msg.
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

struct RobotModel;

/// Which links of one robot model may touch without being reported: one per model, shared by equal robots.
/// Symmetric; a link with itself is Origin::self.
class LinkMatrix {
 public:
  /// From the model's joints and an SRDF's rules. An explicit disable beats an enable; an enable beats a
  /// default disable, adjacency and rigid groups. Rules that name links the model does not have are left
  /// out, one sentence each in `warnings`.
  LinkMatrix(const RobotModel& model, const LinkRules& rules, std::vector<std::string>& warnings);

  bool allowed(std::uint32_t first, std::uint32_t second) const { return origin(first, second) != Origin::none; }
  Origin origin(std::uint32_t first, std::uint32_t second) const { return origins_[first * size_ + second]; }
  std::size_t size() const { return size_; }

  /// What an SRDF says of just this pair.
  struct Tag {
    bool disabled = true;  ///< disable_collisions; else enable_collisions
    std::string reason;    ///< its attribute, made printable; may be empty
  };
  /// The tag that decides of a pair; null: it has none.
  const Tag* tag(std::uint32_t first, std::uint32_t second) const;

 private:
  void set(std::uint32_t first, std::uint32_t second, Origin origin);

  std::size_t size_;
  std::vector<Origin> origins_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Tag> tags_;  // by links, the smaller first: few pairs have one
};

}  // namespace hgrid
