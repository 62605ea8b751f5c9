// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/queries/query_set.h"

namespace hgrid {
namespace bench {

/// A peer that answers queries. It must return all hits, in any order. Boxes that only touch are hits.
class QueryPeer {
 public:
  virtual ~QueryPeer() = default;

  /// Stores the boxes and does everything that makes later queries faster.
  virtual void load(const std::vector<Aabb>& boxes) = 0;
  virtual bool answers(QueryKind kind) const = 0;

  // Each of the next four functions answers one query and replaces the list with its hits. The benchmark calls them
  // only for kinds of queries that answers() accepts.
  virtual void sphere(const Sphere&, std::vector<ProxyId>&) {}
  virtual void segment(const Segment&, std::vector<ProxyId>&) {}
  virtual void box(const Aabb&, std::vector<ProxyId>&) {}
  virtual void nearest(const Eigen::Vector3d&, std::size_t, std::vector<ProxyId>&) {}
};

struct QueryPeerKind {
  std::string name;
  std::function<std::unique_ptr<QueryPeer>()> make;
};

/// Returns the peers that this program was built with, including hgrid.
const std::vector<QueryPeerKind>& queryPeers();

// One factory per peer. If the library of a peer was not found, its factory is declared but not defined.
std::unique_ptr<QueryPeer> makeHGridQueries();
std::unique_ptr<QueryPeer> makeFclQueries();
std::unique_ptr<QueryPeer> makeBulletQueries();
std::unique_ptr<QueryPeer> makeBoostQueries();
std::unique_ptr<QueryPeer> makeEmbreeQueries();

}  // namespace bench
}  // namespace hgrid
