// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "node/params/params.h"

namespace hgrid {

/// The description of a robot, as text.
struct RobotDescription {
  std::string urdf;
  std::optional<std::string> srdf;  ///< nullopt: the robot has none
};

inline bool isSame(const RobotDescription& a, const RobotDescription& b) {
  return a.urdf == b.urdf && a.srdf == b.srdf;
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
