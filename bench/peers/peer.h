// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/workload/world.h"

namespace hgrid {
namespace bench {

/// A broad phase in the benchmark. Each peer receives the same boxes of floats. In each frame (time step), it must
/// write all overlapping pairs into the buffer of the caller. Boxes that only touch overlap.
class Peer {
 public:
  virtual ~Peer() = default;

  /// Loads the boxes before the first step (frame 0). The id of a box is its index.
  virtual void load(const std::vector<Aabb>& boxes) = 0;
  /// Updates the boxes that moved. Then replaces `pairs` with all overlapping pairs. Each pair is written once, the
  /// smaller id first. The pairs may be in any order.
  virtual void frame(const Frame& frame, std::vector<ProxyPair>& pairs) = 0;
  /// Returns whether the time of a frame depends on earlier frames. If not, the benchmark skips untimed frames.
  virtual bool remembers() const { return true; }
  /// Returns how many bytes the peer says that it holds. 0: the peer does not say it; its allocated bytes count
  /// instead.
  virtual std::size_t bytes() const { return 0; }
};

/// Returns the pair with the smaller id first.
inline ProxyPair ordered(ProxyId a, ProxyId b) { return a < b ? ProxyPair{a, b} : ProxyPair{b, a}; }

/// A kind of peer: its name, the largest number of boxes it runs with, and how to create it.
struct PeerKind {
  std::string name;
  std::string instructions;    ///< instruction set of the peer; "default" if it is not known
  std::size_t most = 0;        ///< largest number of boxes; with more boxes, a frame or loading takes far too long
  std::size_t quick_most = 0;  ///< largest number of boxes in a quick run; 0: a quick run leaves out the peer
  std::function<std::unique_ptr<Peer>()> make;
};

/// Returns the peers that this program was built with, without hgrid.
const std::vector<PeerKind>& peers();

/// Returns the names of the peers whose libraries were not found when this program was built.
const std::vector<std::string>& missingPeers();

}  // namespace bench
}  // namespace hgrid
