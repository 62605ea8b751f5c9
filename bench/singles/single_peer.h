// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// A broad phase whose boxes change one at a time, as in a planner that attaches an object, or in an editor.
class SinglePeer {
 public:
  virtual ~SinglePeer() = default;

  /// Loads the boxes. The id of a box is its index.
  virtual void load(const std::vector<Aabb>& boxes) = 0;
  /// Moves a box.
  virtual void update(ProxyId id, const Aabb& box) = 0;
  /// Takes a box out and puts it back at another place.
  virtual void replace(ProxyId id, const Aabb& box) = 0;
  /// Replaces the list with the boxes that overlap this one, in any order. Boxes that only touch overlap.
  virtual void overlapping(const Aabb& box, std::vector<ProxyId>& found) = 0;
};

struct SinglePeerKind {
  std::string name;
  std::function<std::unique_ptr<SinglePeer>()> make;
};

/// Returns the peers that this program was built with, including hgrid.
std::vector<SinglePeerKind> singlePeers();

// Declared but not defined if the library of the peer was not found.
std::unique_ptr<SinglePeer> makeBulletSingles();
std::unique_ptr<SinglePeer> makeBox3dSingles();
std::unique_ptr<SinglePeer> makeJoltSingles();

}  // namespace bench
}  // namespace hgrid
