// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/find_trouble.h"

#include <algorithm>
#include <limits>

namespace hgrid {

BodyTrouble troubleOf(const Body& body, const BodyPose& pose, const Mover& mover, const std::string& world_frame) {
  BodyTrouble trouble{body.name, body.frame, pose.state, pose.age, pose.stamp, Code::tf_timeout, {}};
  if (mover.trouble) {
    trouble.code = mover.trouble->code();
    trouble.sentence = mover.trouble->what();
  } else if (pose.state == Freshness::fresh) {
    trouble.code = Code::conflict;
    trouble.sentence = "a frame between '" + mover.frame + "' and '" + world_frame +
                       "' is published on both /tf and /tf_static; it must be published on only one of them";
  } else if (pose.state == Freshness::frozen) {
    trouble.code = Code::clock;
    trouble.sentence = "the clock stands still or jumped, and no new transform has arrived since";
  } else {
    trouble.sentence = "the pose of frame '" + mover.frame + "' is " + secondsText(pose.age) + " old";
  }
  if (pose.state == Freshness::unplaced) trouble.age = std::numeric_limits<double>::quiet_NaN();
  return trouble;
}

void sortWorstFirst(std::vector<BodyTrouble>& troubles) {
  std::stable_sort(troubles.begin(), troubles.end(),
                   [](const BodyTrouble& a, const BodyTrouble& b) { return a.state > b.state; });
}

}  // namespace hgrid
