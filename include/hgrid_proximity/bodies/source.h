// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>

#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {

struct Body;

/// Name of the source that a body comes from: the robot's name, "obstacle", or the name of the map or cloud itself.
std::string sourceOf(const Body& body);

/// Something that a source should know but does not, such as a robot without a model or a map that never arrived.
/// It makes the source incomplete.
struct SourceGap {
  std::string source;    ///< as sourceOf() names it
  std::string bodies;    ///< glob over the names of the bodies that may be somewhere unseen
  std::string sentence;  ///< begins with a code or a state: "NOT_READY map 'hall': nothing came on octomap_binary yet"
  /// [m, world] Where these bodies can be. None: anywhere.
  std::optional<Sphere> within = std::nullopt;
};

}  // namespace hgrid
