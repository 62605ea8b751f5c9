// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "node/params/params.h"
#include "node/text/text_hash.h"

namespace hgrid {

/// The description of a robot, as text. The constructor computes the hash of the text, because the tick thread, which
/// needs the hash, must not read long texts.
class RobotDescription {
 public:
  /// @param srdf  nullopt: the robot has none
  explicit RobotDescription(std::string urdf = {}, std::optional<std::string> srdf = std::nullopt)
      : urdf_(std::move(urdf)), srdf_(std::move(srdf)), hash_(fnv1a(urdf_)) {
    if (srdf_) hash_ = fnv1a(*srdf_, fnv1a("\n", hash_));
  }

  const std::string& urdf() const { return urdf_; }
  const std::optional<std::string>& srdf() const { return srdf_; }
  /// Returns a hash of both texts. Descriptions that differ have the same hash with a probability of 2^-64.
  std::uint64_t hash() const { return hash_; }

 private:
  std::string urdf_;
  std::optional<std::string> srdf_;
  std::uint64_t hash_;
};

inline bool isSame(const RobotDescription& a, const RobotDescription& b) {
  return a.hash() == b.hash() && a.urdf() == b.urdf() && a.srdf() == b.srdf();
}

/// The name of a robot, its frames, and where its description comes from.
struct RobotSpec {
  RobotParams params;
  /// The description, if a request of ~apply_robots contained it; null: the parameters that `params` names hold it.
  std::shared_ptr<const RobotDescription> text;
};

/// Returns whether two robots have the same frames, and descriptions from the same place. Names are not compared.
inline bool isSame(const RobotSpec& a, const RobotSpec& b) {
  const bool same_text = a.text == b.text || (a.text && b.text && isSame(*a.text, *b.text));
  return same_text && a.params.tf_prefix == b.params.tf_prefix &&
         (a.text || (a.params.description == b.params.description && a.params.semantic == b.params.semantic));
}

}  // namespace hgrid
