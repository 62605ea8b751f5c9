// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "queries/question.h"

namespace hgrid {

/// Gathers candidates for what is nearest, by growing distance of their boxes. That distance is a lower bound of the
/// one that is asked for. So the search ends when no further box can be nearer than the last body that is wanted.
class NearestRounds {
 public:
  /// @param center  [m, world] around what the question asks from
  /// @param reach   [m] from that center to the farthest point of what the question asks from
  /// @param limit   [m] farther bodies are no hits; may be infinite
  NearestRounds(const Question& question, const Eigen::Vector3d& center, double reach, double limit)
      : question_(question), center_(center), reach_(reach), limit_(limit) {}

  /// [m] The limit that a `max_distance` stands for: 0 means that there is none.
  static double limitOf(double max_distance) {
    return max_distance > 0.0 ? max_distance : std::numeric_limits<double>::infinity();
  }
  double limit() const { return limit_; }
  /// As Question::wanted().
  std::size_t wanted() const { return std::max<std::uint32_t>(1, question_.scope.limit); }
  /// As Question::gather().
  bool gather(std::size_t round, std::vector<QueryHit>& hits, std::vector<ProxyId>& candidates);

 private:
  bool isEnough(std::vector<QueryHit>& hits) const;

  const Question& question_;
  Eigen::Vector3d center_;
  double reach_, limit_;
  std::size_t count_ = 0;      // boxes that the last round asked for
  std::vector<NearHit> near_;  // boxes of all rounds
};

}  // namespace hgrid
