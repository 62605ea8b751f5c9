// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "queries/states/checker_parts.h"
#include "queries/states/state_search.h"
#include "queries/states/state_values.h"

namespace hgrid {

/// Examines edges, four at a time.
///
/// Each edge is examined from its beginning to its end, in parts. In the middle of a part, the search looks for shapes
/// that are nearer to each other than they can travel on half of the part. If there are none, no configuration of the
/// part has a contact, and the next part is longer. Otherwise the part is divided, and only those shapes are examined
/// in its halves. (Conservative advancement, as in Ericson 2005, section 5.5.3, from the middle of an interval instead
/// of its beginning; bounds of motion as in Schwarzer, Saha and Latombe: Adaptive dynamic collision checking, 2005.)
class EdgeSearch {
 public:
  EdgeSearch(const CheckerParts& all, const StateBatch& batch, const std::vector<StateEdge>& edges,
             const EdgeRequest& request, StateMemory& memory, EdgeAnswers& answers);
  /// Answers all edges.
  void run();

 private:
  void finishAll();
  bool begin(std::size_t lane);
  bool read(std::size_t edge, std::size_t lane);
  bool turnsHalf(std::size_t edge, std::size_t variable);
  bool readEnd(std::size_t edge, std::uint32_t state, std::size_t lane);
  void choosePart(EdgeInWork& work) const;
  bool isDone(EdgeInWork& work) const;
  void place(std::size_t lane);
  void findReaches(std::size_t lane);
  void findPairReaches(unsigned lanes);
  Four reachOfCluster(std::size_t cluster) const;
  void use(std::size_t lane);
  void useContact(EdgeInWork& work, const StatePair& contact, const TouchingSolids& touching) const;
  EdgePart keep(EdgeInWork& work, std::size_t lane, bool in_doubt) const;
  void divide(EdgeInWork& work, std::size_t lane, std::optional<std::uint32_t> doubt) const;
  bool isShort(const EdgeInWork& work, double length) const;
  void finish(std::size_t lane, bool in_time);

  const CheckerParts& all_;
  const StateBatch& batch_;
  const std::vector<StateEdge>& edges_;
  const EdgeRequest& request_;
  StateMemory& memory_;
  EdgeAnswers& answers_;
  StateValues values_;
  StateSearch search_;
  const std::optional<std::uint32_t> doubt_;  // a doubt that applies to all configurations
  double root_rounding_ = 0.0;                // [m] bound of the rounding errors of the place of the root
  std::size_t next_ = 0;                      // index of the next edge that no lane has taken
};

}  // namespace hgrid
