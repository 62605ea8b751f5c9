// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "world/entering_bodies.h"
#include "world/scene_structure.h"

namespace hgrid {

/// The content of a PreparedBodies.
struct PreparedBodies::Data {
  std::shared_ptr<const SceneStructure> before;  ///< the structure before the change
  EnteringBodies in;                             ///< in the order of the caller
  std::vector<std::size_t> sorted;               ///< indices of the elements of `in`, sorted by the names of the bodies
  BodyChange change;                             ///< what changes; change.in is in the order of `sorted`
  std::vector<std::uint32_t> places;             ///< for each element of change.in: its index in `next`
  std::shared_ptr<SceneStructure> next;          ///< the structure after the change; new bodies have no handles yet
  std::vector<bool> watched;                     ///< memory for State::is_watched: false for each body of `next`
  NameMatches matches;  ///< of the names of `in`, for Scene::prepareNames(); empty if the rules change
};

}  // namespace hgrid
