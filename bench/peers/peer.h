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

/// A broad phase in the benchmark. Every peer gets the same float boxes and must end each frame with the full list of
/// overlapping pairs in the caller's buffer, boxes that only touch included.
class Peer {
 public:
  virtual ~Peer() = default;

  virtual void load(const std::vector<Aabb>& boxes) = 0;
  /// Takes the boxes that moved, then replaces `pairs` by all pairs, each once, the smaller id first, in any order.
  virtual void frame(const Frame& frame, std::vector<ProxyPair>& pairs) = 0;
  /// Whether a frame depends on the frames before; if not, ageing is left out.
  virtual bool remembers() const { return true; }
  /// [byte] What the peer itself says that it holds; 0: it does not, and what it has allocated is counted.
  virtual std::size_t bytes() const { return 0; }
};

/// Ids of a pair that a library names in any order.
inline ProxyPair ordered(ProxyId a, ProxyId b) { return a < b ? ProxyPair{a, b} : ProxyPair{b, a}; }

/// A peer by name, and how many boxes it is asked to handle at most.
struct PeerKind {
  std::string name;
  std::string instructions;    ///< instruction set that it is known to use, else "default"
  std::size_t most = 0;        ///< above this number of boxes a frame, or loading, takes far too long
  std::size_t quick_most = 0;  ///< the same for a quick run; 0: takes no part in it
  std::function<std::unique_ptr<Peer>()> make;
};

/// The peers that this program was built with, ours not among them.
const std::vector<PeerKind>& peers();

/// Names of the peers whose libraries were not found when this program was built.
const std::vector<std::string>& missingPeers();

}  // namespace bench
}  // namespace hgrid
