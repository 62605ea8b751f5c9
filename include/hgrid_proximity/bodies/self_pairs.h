// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>

namespace hgrid {

class LinkMatrix;
struct RobotModel;

/// How many pairs of a robot's own links its model switches off, by origin. Only links with geometry count.
struct SelfPairs {
  std::size_t links = 0;  ///< with geometry
  std::size_t pairs = 0;  ///< of these links, in all
  std::size_t rigid = 0, adjacent = 0, srdf = 0;

  std::size_t off() const { return rigid + adjacent + srdf; }
  /// Whether there are pairs and none of them is reported.
  bool allOff() const { return pairs > 0 && off() == pairs; }
};

SelfPairs countSelfPairs(const RobotModel& model, const LinkMatrix& matrix);

/// The counts as a clause: "7 of the 36 pairs of its 9 links with geometry are off (0 rigid, 7 adjacent, 0 by SRDF)".
std::string text(const SelfPairs& counts);

}  // namespace hgrid
