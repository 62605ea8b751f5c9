// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/self_pairs.h"

#include "hgrid_proximity/bodies/link_matrix.h"
#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {

SelfPairs countSelfPairs(const RobotModel& model, const LinkMatrix& matrix) {
  SelfPairs counts;
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    if (!model.links[i].hasGeometry()) continue;
    ++counts.links;
    for (std::uint32_t j = 0; j < i; ++j) {
      if (!model.links[j].hasGeometry()) continue;
      const Origin origin = matrix.origin(i, j);
      ++counts.pairs;
      counts.rigid += origin == Origin::rigid;
      counts.adjacent += origin == Origin::adjacent;
      counts.srdf += origin == Origin::srdf;
    }
  }
  return counts;
}

std::string text(const SelfPairs& counts) {
  return std::to_string(counts.off()) + " of the " + std::to_string(counts.pairs) + " pairs of its " +
         std::to_string(counts.links) + " links with geometry are off (" + std::to_string(counts.rigid) + " rigid, " +
         std::to_string(counts.adjacent) + " adjacent, " + std::to_string(counts.srdf) + " by SRDF)";
}

}  // namespace hgrid
