// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/uniform_grid.h"

namespace hgrid {
namespace book {

void UniformGrid::findPairs(PairSink& sink) const {
  findPairsInCells(sink);
  std::vector<ProxyId> near;
  for (const ProxyId large : large_) {
    if (sink.isFull()) return;
    near.clear();
    candidates(QueryShape(box(large)), near);
    for (const ProxyId other : near) {
      if (other != large && (!large_.contains(other) || other > large)) sink.tryPair(large, other);
    }
  }
}

void UniformGrid::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  candidatesInCells(shape, found);
  for (const ProxyId id : large_) {
    if (overlap(shape.bounds(), box(id))) found.push_back(id);
  }
}

}  // namespace book
}  // namespace hgrid
