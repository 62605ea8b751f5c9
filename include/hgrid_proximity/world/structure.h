// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"
#include "hgrid_proximity/pairs/pair_filter.h"
#include "hgrid_proximity/pairs/pair_margins.h"

namespace hgrid {

/// The part of a snapshot that does not change while bodies move. Snapshots of one revision share it.
struct Structure {
  /// Stands for "no body" where an index of a body is expected.
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::uint64_t revision = 0;                ///< increases whenever bodies or rules change
  BodyList bodies;                           ///< sorted by name
  std::vector<BodyId> ids;                   ///< handle of each body
  std::vector<std::uint32_t> first_proxy;    ///< body i has the proxies first_proxy[i] .. first_proxy[i + 1] - 1
  std::vector<std::uint32_t> body_of_proxy;  ///< for each proxy: index of its body
  std::vector<std::uint32_t> planes;         ///< the proxies whose shapes are planes, ascending
  std::vector<std::uint32_t> maps;           ///< indices of the bodies that are maps or clouds, ascending
  std::vector<std::string> sources;          ///< names of the sources of the bodies (see sourceOf()), sorted
  std::vector<std::uint32_t> source_of;      ///< for each body: index of its source in `sources`
  std::vector<std::string> absent;           ///< globs of required bodies that no body matches
  std::vector<double> margin;                ///< [m] for each body: its own margin, at least the global one
  double least_margin = 0.0;                 ///< [m] the global margin
  PairMargins pair_margins;                  ///< margins that are configured for single pairs
  PairFilter filter;                         ///< decides which pairs are reported
  bool silenced = false;                     ///< whether rules switch off every pair that is reported without rules

  /// Returns whether the body is a map or a cloud, which has cells instead of shapes.
  bool isMap(std::uint32_t body) const { return hasCells(bodies[body].kind); }
  /// Returns whether the shape of a proxy is a plane. Such a proxy has no box.
  bool isPlane(std::uint32_t proxy) const {
    return !planes.empty() && std::binary_search(planes.begin(), planes.end(), proxy);
  }
  /// Returns whether at least one shape of the body is a plane.
  bool hasPlane(std::uint32_t body) const {
    const auto next = std::lower_bound(planes.begin(), planes.end(), first_proxy[body]);
    return next != planes.end() && *next < first_proxy[body + 1];
  }
  /// Returns the index of a proxy's shape among the shapes of its body.
  std::uint32_t shapeOf(std::uint32_t proxy) const { return proxy - first_proxy[body_of_proxy[proxy]]; }
  /// Returns the number of bodies whose names sort before this name.
  std::uint32_t countBefore(const std::string& name) const;
  /// Returns the index of the body with this name, or kNone.
  std::uint32_t find(const std::string& name) const;
};

}  // namespace hgrid
