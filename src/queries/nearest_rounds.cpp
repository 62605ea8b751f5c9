// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/nearest_rounds.h"

namespace hgrid {
namespace {

constexpr std::size_t kFirstRound = 16;  // the first round requests so many boxes plus four for each wanted body

}  // namespace

/// Returns whether enough hits were found. That is so if all boxes that were not gathered yet are farther away than the
/// wanted hits.
bool NearestRounds::isEnough(std::vector<QueryHit>& hits) const {
  if (near_.size() < count_) return true;  // there are no more boxes
  sortOnePerBody(question_, hits);
  return hits.size() >= wanted() && hits[wanted() - 1].distance < near_.back().distance - reach_;
}

bool NearestRounds::gather(std::size_t round, std::vector<QueryHit>& hits, std::vector<ProxyId>& candidates) {
  if (round > 0 && isEnough(hits)) return false;
  const std::size_t known = near_.size();
  count_ = round == 0 ? 4 * wanted() + kFirstRound : 4 * count_;
  question_.snapshot.broadPhase().nearest(center_ - question_.snapshot.origin(), count_, limit_ + reach_, near_);
  candidates.clear();
  for (std::size_t i = known; i < near_.size(); ++i) candidates.push_back(near_[i].id);
  return true;
}

}  // namespace hgrid
