// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/conflicts_message.h"

#include "node/messages/world_state_message.h"

namespace hgrid {

msg::Conflicts conflictsMessage(const Tick& tick, const RobotPaths& paths, const std::vector<PathAnswer>& answers,
                                const std::vector<Time>& since) {
  msg::Conflicts message;
  message.header = headerOf(tick);
  message.world = worldState(tick, 0.0);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    message.robots.push_back(paths[i]->robot);
    message.verdicts.push_back(static_cast<std::uint8_t>(answers[i].verdict));
    message.reasons.push_back(answers[i].reason);
    if (!answers[i].conflict) continue;
    const PathConflict& conflict = *answers[i].conflict;
    message.since.push_back(toRos(since[message.since.size()]));
    message.robot.push_back(static_cast<std::uint32_t>(i));
    message.first.push_back(conflict.first);
    message.second.push_back(conflict.second);
    message.point.push_back(toPoint(conflict.contact.point));
    message.normal.push_back(toVector(conflict.contact.normal));
    message.depth.push_back(conflict.contact.depth);
    message.at.push_back(toRos(conflict.at));
  }
  return message;
}

}  // namespace hgrid
