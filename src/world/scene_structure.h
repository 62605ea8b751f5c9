// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "hgrid_proximity/world/scene.h"
#include "hgrid_proximity/world/structure.h"

namespace hgrid {

/// A structure, and lists of its bodies and proxies that only a scene needs.
struct SceneStructure final : Structure {
  std::vector<const BodyShape*> shapes;  ///< for each proxy; `bodies` owns the shapes
  /// [m] For each proxy: the box of its shape in its own frame, grown by half of the margin. The grid chooses its cells
  /// by these boxes.
  std::vector<Aabb> sizes;
  std::vector<ProxyId> fixed_proxies;    ///< proxies of fixed bodies, except planes, ascending
  std::vector<std::uint32_t> uncovered;  ///< bodies that are neither covered nor waived, ascending
  GridScale scale;                       ///< sizes of the cells of the grid, computed from `sizes`
};

/// A body that enters a structure. It is new, or it replaces the body of the same name and keeps its handle.
struct EnteringBody {
  std::shared_ptr<const Body> body;           ///< never null
  BodyId id;                                  ///< its handle; Scene::prepare() does not know that of a new body
  std::uint32_t replaces = Structure::kNone;  ///< index of the replaced body in the structure before, or kNone
};

/// How the bodies of a structure change.
struct BodyChange {
  std::vector<std::uint32_t> out;  ///< indices of the bodies that leave or are replaced, ascending
  std::vector<EnteringBody> in;    ///< sorted by name
};

/// Makes the filter of a structure.
/// @param bodies  those of the structure
/// @param known   for each of them: its index in the structure before, or Structure::kNone
using FilterMaker = std::function<PairFilter(const BodyList& bodies, const std::vector<std::uint32_t>& known)>;

/// Returns the structure that follows another one.
/// @param margin   [m] the global margin now
/// @param options  their `margin` and `allowed_pairs` are not used
std::shared_ptr<SceneStructure> nextStructure(const SceneStructure& before, const BodyChange& change, double margin,
                                              const SceneOptions& options, const FilterMaker& filter);

}  // namespace hgrid
