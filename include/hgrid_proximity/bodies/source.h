// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>

#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {

struct Body;

/// Returns the name of the source of a body: the name of its robot, "obstacle", the name of the map or cloud, or
/// trackerOf() its name.
std::string sourceOf(const Body& body);

/// Returns the source of a track: "track/people" for "track/people/5". `name` may also be a glob over such names.
std::string trackerOf(const std::string& name);

/// Missing data that makes a source incomplete, such as a robot without a model or a map that never arrived.
struct SourceGap {
  std::string source;    ///< name of the source, as sourceOf() returns it
  std::string bodies;    ///< glob that matches the names of the missing bodies
  std::string sentence;  ///< begins with a code or state: "NOT_READY map 'hall': its file has not been read yet"
  /// [m, world] The missing bodies are inside this sphere. nullopt: they can be anywhere.
  std::optional<Sphere> within = std::nullopt;
};

}  // namespace hgrid
