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

/// Something that answers queries. All hits are returned, in any order; boxes that only touch are hits.
class QueryPeer {
 public:
  virtual ~QueryPeer() = default;

  virtual void load(const std::vector<Aabb>& boxes) = 0;
  /// Whether it answers this kind one by one, or many in one call.
  virtual bool answers(QueryKind kind, bool batched) const = 0;

  // One by one; `found` is replaced. Only called for kinds that are answered.
  virtual void sphere(const Sphere&, std::vector<ProxyId>&) {}
  virtual void segment(const Segment&, std::vector<ProxyId>&) {}
  virtual void box(const Aabb&, std::vector<ProxyId>&) {}
  virtual void nearest(const Eigen::Vector3d&, std::size_t, std::vector<ProxyId>&) {}
  /// All queries of the kind in one call; the peer keeps the hits in a form of its own.
  virtual void batch(QueryKind, const QuerySet&) {}
  /// The hits that the last batch() found for a query.
  virtual void batchHits(std::size_t, std::vector<ProxyId>&) const {}
};

struct QueryPeerKind {
  std::string name;
  std::function<std::unique_ptr<QueryPeer>()> make;
};

/// The peers that this program was built with, ours included.
const std::vector<QueryPeerKind>& queryPeers();

// One per peer; those of libraries that were not found are declared only.
std::unique_ptr<QueryPeer> makeHGridQueries();
std::unique_ptr<QueryPeer> makeFclQueries();
std::unique_ptr<QueryPeer> makeBulletQueries();
std::unique_ptr<QueryPeer> makeBoostQueries();
std::unique_ptr<QueryPeer> makeEmbreeQueries();

}  // namespace bench
}  // namespace hgrid
