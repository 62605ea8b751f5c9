// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/unplaced_robots.h"

#include <map>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostRoots = 3;  // number of root frames that a sentence names

/// The links of one robot that never had a pose.
struct UnplacedLinks {
  std::size_t all = 0, unplaced = 0;
  const Mover* first = nullptr;  // first mover without a pose
};

/// Returns the names of frames without a parent, as text: "; frames without a parent are 'map', 'odom'".
std::string rootsOf(const FrameTable& frames) {
  std::string names;
  std::size_t count = 0;
  for (std::uint32_t frame = 0; frame < frames.size() && count < kMostRoots; ++frame) {
    if (frames.parent(frame) != FrameTable::kNone) continue;
    names += (count++ == 0 ? "" : ", ") + ("'" + printable(frames.name(frame)) + "'");
  }
  return count == 0 ? "" : "; frames without a parent are " + names;
}

/// Returns why robot_state_publisher does not send a frame of a robot that was never published; empty: not known.
std::string whyUnsent(const LoadedRobot* robot, const FrameTable& frames) {
  if (robot == nullptr) return {};
  for (const auto& [frame, reason] : robot->unsent_frames) {
    if (frames.find(frame) == FrameTable::kNone) return reason;
  }
  return {};
}

std::string sentenceOf(const std::string& robot, const UnplacedLinks& links, const std::string& world_frame,
                       const FrameTable& frames, const LoadedRobot* model) {
  const std::string& frame = links.first->frame;
  const bool published = frames.find(frame) != FrameTable::kNone;
  const std::string beginning = "UNPLACED robot '" + robot + "': " + std::to_string(links.unplaced) + " of its " +
                                std::to_string(links.all) + " links never had a pose: ";
  if (links.first->trouble->code() == Code::unsupported) return beginning + links.first->trouble->what();
  if (const std::string unsent = whyUnsent(model, frames); !unsent.empty()) return beginning + unsent;
  return beginning + "frame '" + printable(frame) + "' " +
         (published ? "is not connected to the world frame '" + printable(world_frame) +
                          "'; publish a transform that connects them"
                    : "was never published; start robot_state_publisher and what publishes joint_states, or correct "
                      "the tf_prefix of the robot");
}

}  // namespace

std::vector<std::string> whyUnplaced(const std::vector<Mover>& movers, const RobotEntries& robots,
                                     const FrameTable& frames, const std::string& world_frame, bool configured) {
  const bool world_is_unknown = configured && frames.placed() > 0 && frames.find(world_frame) == FrameTable::kNone;
  std::map<std::string, UnplacedLinks> unplaced;  // by robot
  for (const Mover& mover : movers) {
    if (mover.source.kind != SourceKind::robot) continue;
    UnplacedLinks& links = unplaced[mover.source.name];
    links.all += mover.last - mover.first;
    if (mover.pose.exists()) continue;
    links.unplaced += mover.last - mover.first;
    const bool blame_world = world_is_unknown && frames.find(mover.frame) != FrameTable::kNone;
    const bool blame_robot =
        mover.trouble && !blame_world &&
        (mover.trouble->code() == Code::unknown_frame || mover.trouble->code() == Code::unsupported);
    if (blame_robot && links.first == nullptr) links.first = &mover;
  }
  std::vector<std::string> sentences;
  if (world_is_unknown) {
    sentences.push_back("UNPLACED: ~world_frame is '" + printable(world_frame) +
                        "', but no transform names this frame, so nothing can be placed in it; set ~world_frame to a "
                        "frame of tf, or publish it" +
                        rootsOf(frames));
  }
  for (const auto& [robot, links] : unplaced) {
    const auto entry = robots.find(robot);
    const LoadedRobot* model = entry == robots.end() ? nullptr : entry->second.model.get();
    if (links.first != nullptr) sentences.push_back(sentenceOf(robot, links, world_frame, frames, model));
  }
  return sentences;
}

}  // namespace hgrid
