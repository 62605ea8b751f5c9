// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/world/scene.h"
#include "node/time/clock_watch.h"
#include "node/world/body_trouble.h"
#include "node/world/model_report.h"

namespace hgrid {

/// The result of one tick. Every message and every answer is made from it. Immutable.
struct Tick {
  std::shared_ptr<const Snapshot> snapshot;  ///< null: there is no world yet, and not_ready says why
  std::string world_frame;
  Moment made;
  std::uint64_t epoch = 0;
  std::vector<std::string> not_ready;  ///< a sentence for each thing that is missing
  /// What the first sentence of not_ready is about: the name of a source, "clock" or "world frame".
  std::string waits_for;
  std::vector<BodyTrouble> troubles;  ///< the worst state first
  std::vector<std::string> missing_frames;
  std::vector<std::string> contested_frames;  ///< a sentence for each frame over which publishers fight
  std::shared_ptr<const ModelReport> models;
  TickTimes times;
  std::size_t frames = 0;  ///< that tf knows
  std::chrono::nanoseconds poses_time{0};
};

/// A tick and the exact distances of its pairs.
struct MeasuredTick {
  std::shared_ptr<const Tick> tick;
  std::shared_ptr<const PairDistances> distances;
};

}  // namespace hgrid
