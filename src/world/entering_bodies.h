// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/scene.h"

namespace hgrid {

/// Bodies that enter a scene. They are shared, because snapshots keep them alive.
using EnteringBodies = std::vector<std::shared_ptr<const Body>>;

constexpr double kLargestMargin = 1e3;  ///< [m] largest margin, padding, hysteresis, growth cap and finest edge
/// [m] Largest coordinate of a shape in the frame of its body, and of a body in the world frame.
constexpr double kFarthestShape = 1e6;

/// Returns the number of planes among the shapes of a body.
std::size_t planesOf(const Body& body);

/// Checks each of the bodies, their names, and whether there is room for all of them.
/// @param count   number of bodies that stay in the scene
/// @param planes  number of planes of these bodies
/// @param stays   returns whether a body with this name stays in the scene
/// @throws Refusal as Scene::add()
void checkEntering(const EnteringBodies& in, std::size_t count, std::size_t planes, const SceneOptions& options,
                   const std::function<bool(const std::string&)>& stays);

/// Returns the refusal of a change that removes a body twice.
Refusal removedTwice(const Body& body);

/// Returns whether `after` is the fixed obstacle `before`, perhaps at another place. Its pairs then continue. A moving
/// obstacle becomes a new body, because its pose may be unknown until its frame is found.
bool isSameElsewhere(const Body& before, const Body& after);

/// @throws Refusal out_of_range unless `value` [m] is within 0 .. `limit`
void checkLength(double value, double limit, const std::string& what);

}  // namespace hgrid
