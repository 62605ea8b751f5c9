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

/// A broad phase in the benchmark. Every peer receives the same float boxes. In each frame, it must write all
/// overlapping pairs into the caller's buffer. Boxes that only touch overlap.
class Peer {
 public:
  virtual ~Peer() = default;

  /// Loads the boxes of frame 0. The id of a box is its index.
  virtual void load(const std::vector<Aabb>& boxes) = 0;
  /// Updates the boxes that moved. Then replaces `pairs` with all overlapping pairs: each pair once, the smaller id
  /// first, pairs in any order.
  virtual void frame(const Frame& frame, std::vector<ProxyPair>& pairs) = 0;
  /// Whether the time of a frame depends on earlier frames. If not, untimed frames are skipped.
  virtual bool remembers() const { return true; }
  /// Returns the bytes that the peer reports to hold. 0: it reports nothing, so the bytes that it has allocated count.
  virtual std::size_t bytes() const { return 0; }
};

/// Returns the pair with the smaller id first.
inline ProxyPair ordered(ProxyId a, ProxyId b) { return a < b ? ProxyPair{a, b} : ProxyPair{b, a}; }

/// A kind of peer: its name, the largest number of boxes it runs with, and how to create it.
struct PeerKind {
  std::string name;
  std::string instructions;    ///< instruction set that the peer uses, if known, else "default"
  std::size_t most = 0;        ///< largest number of boxes; with more, a frame or loading takes far too long
  std::size_t quick_most = 0;  ///< largest number of boxes in a quick run; 0: the peer is left out
  std::function<std::unique_ptr<Peer>()> make;
};

/// Returns the peers that this program was built with, without hgrid.
const std::vector<PeerKind>& peers();

/// Returns the names of the peers whose libraries were not found when this program was built.
const std::vector<std::string>& missingPeers();

}  // namespace bench
}  // namespace hgrid
