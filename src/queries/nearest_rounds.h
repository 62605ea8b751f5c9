// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "queries/question.h"

namespace hgrid {

/// Gathers the boxes for a query for the nearest bodies. Each round gathers more boxes, in the order of their distance.
/// The distance of a box is a lower bound of the distance of its body. So the search ends when no further box can be
/// nearer than the last wanted body.
class NearestRounds {
 public:
  /// @param center  [m, world] the point of the query, or the center of the asking body's bounds
  /// @param reach   [m] distance from `center` to the farthest point of the asking body; 0 for a point
  /// @param limit   [m] bodies farther away are no hits; may be infinite
  NearestRounds(const Question& question, const Eigen::Vector3d& center, double reach, double limit)
      : question_(question), center_(center), reach_(reach), limit_(limit) {}

  /// Returns the limit [m] for the parameter `max_distance`: infinite for 0, which means "no limit".
  static double limitOf(double max_distance) {
    return max_distance > 0.0 ? max_distance : std::numeric_limits<double>::infinity();
  }
  double limit() const { return limit_; }
  /// Implements Question::wanted().
  std::size_t wanted() const { return std::max<std::uint32_t>(1, question_.scope.limit); }
  /// Implements Question::gather().
  bool gather(std::size_t round, std::vector<QueryHit>& hits, std::vector<ProxyId>& candidates);

 private:
  bool isEnough(std::vector<QueryHit>& hits) const;

  const Question& question_;
  Eigen::Vector3d center_;
  double reach_, limit_;
  std::size_t count_ = 0;      // number of boxes that the last round requested
  std::vector<NearHit> near_;  // boxes found in all rounds, nearest first
};

}  // namespace hgrid
