// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/history/history.h"
#include "hgrid_proximity/world/scene.h"
#include "node/params/settings.h"
#include "node/robots/model_report.h"
#include "node/robots/robot_entry.h"
#include "node/tf/publisher_clocks.h"
#include "node/tick/body_trouble.h"
#include "node/time/clock_watch.h"

namespace hgrid {

/// The result of one tick. All messages and answers are built from it. It never changes after it was made.
struct Tick {
  std::shared_ptr<const Settings> settings;  ///< the parameters that this tick was made with; never null in a World's
  std::shared_ptr<const Snapshot> snapshot;  ///< null: there is no world yet, and not_ready says why
  std::string world_frame;                   ///< empty: not known yet
  Moment made;                               ///< when the node computed the tick
  std::uint64_t epoch = 0;
  std::vector<std::string> not_ready;  ///< one sentence for each thing that is missing
  /// The subject of the first sentence of not_ready: the name of a source, "clock" or "world frame".
  std::string waits_for;
  std::vector<BodyTrouble> troubles;  ///< bodies that are not FRESH or have a conflict, worst state first
  /// Why robots have links that never had a pose, and what to do; one sentence each.
  std::vector<std::string> unplaced;
  std::vector<std::string> missing_frames;    ///< names of frames that were never published, sorted
  std::vector<std::string> contested_frames;  ///< one sentence for each contested frame
  std::vector<ClockOffset> clock_offsets;     ///< publishers whose stamps are constantly early or late
  std::shared_ptr<const ModelReport> models;
  std::shared_ptr<const RobotEntries> robots;  ///< all robots, by name, also those that are absent or not loaded
  HistoryExtent history;                       ///< the past ticks that queries could ask for when this tick was made
  TickTimes times;
  int threads = 0;                         ///< number of threads that made the snapshot
  std::size_t frames = 0;                  ///< number of frames that a transform has placed
  std::chrono::nanoseconds poses_time{0};  ///< how long the computation of all poses took
};

/// A tick and the exact distances of its pairs.
struct MeasuredTick {
  std::shared_ptr<const Tick> tick;
  std::shared_ptr<const PairDistances> distances;  ///< null if the tick has no snapshot
  std::chrono::nanoseconds time{0};                ///< how long the measurements took
};

}  // namespace hgrid
