// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {

const std::vector<QueryPeerKind>& queryPeers() {
  static const std::vector<QueryPeerKind> kinds{
      {"hgrid", makeHGridQueries},
#ifdef HGRID_BENCH_FCL
      {"FCL DynamicAABBTree", makeFclQueries},
#endif
#ifdef HGRID_BENCH_BULLET
      {"Bullet dbvt", makeBulletQueries},
#endif
#ifdef HGRID_BENCH_BOOST
      {"Boost R-tree", makeBoostQueries},
#endif
#ifdef HGRID_BENCH_EMBREE
      {"Embree", makeEmbreeQueries},
#endif
  };
  return kinds;
}

}  // namespace bench
}  // namespace hgrid
