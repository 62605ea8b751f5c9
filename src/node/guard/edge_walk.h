// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/state_checker.h"
#include "node/guard/path_check.h"

namespace hgrid {

/// Checks the edges between successive states of a batch in their order, some at a time. Edge i goes from state i to
/// the next one.
class EdgeWalk {
 public:
  /// @param times  when the robots are at each state of the batch
  /// All references must outlive this object.
  EdgeWalk(const StateBatch& batch, const std::vector<Time>& times, std::chrono::steady_clock::time_point deadline)
      : batch_(batch), times_(times) {
    request_.deadline = deadline;
  }

  /// Checks the edges from `first` on, until one of them is not clear.
  /// @param first  becomes the index of this edge; if all are clear, their number
  /// @returns the name of a robot that has a conflict on this edge; empty: none was found
  std::string advance(const StateChecker& checker, std::size_t& first);

  /// Returns the answer for a robot for which all edges before the edge `end` are clear, and nothing is known of later
  /// ones.
  PathAnswer clearUntil(std::size_t end) const;

  /// Checks the edges from `first` on, until one of them has a conflict, and adds what it finds to an answer.
  void extend(PathAnswer& answer, const StateChecker& checker, std::size_t first);

 private:
  void check(const StateChecker& checker, std::size_t first, std::size_t count);
  void add(PathAnswer& answer, const StateChecker& checker, std::size_t i) const;

  const StateBatch& batch_;
  const std::vector<Time>& times_;
  EdgeRequest request_;
  StateScratch scratch_;
  std::vector<StateEdge> edges_;  // the edges of the last call of check()
  EdgeAnswers found_;             // the answers for them
};

}  // namespace hgrid
