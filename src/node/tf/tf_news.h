// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// A frame that moves, and the stamp of its newest transform.
struct FrameStamp {
  std::uint32_t frame = 0;  ///< number of the frame in the FrameTable
  Time newest{0};
};

/// Decides whether enough transforms have arrived since the last tick to make a tick with a newer time.
///
/// The time of a tick is the newest time at which all frames that keep up are known. So each of these frames must
/// receive a transform that is newer than the last tick. This object counts the frames that have not received one yet.
/// A call of note() takes a constant time. Only the tick thread may use this class.
class TfNews {
 public:
  /// @param max_wait  [s] how long a tick may wait for slower frames, as in TickTime
  explicit TfNews(double max_wait);

  /// Starts to wait for transforms that are newer than the last tick.
  /// @param frames  the frames that hold back the time of the next tick, each at most once
  /// @param tick    time of the last tick
  /// @param now     ROS time of the last tick
  void await(const std::vector<FrameStamp>& frames, Time tick, Time now);
  /// Notes that a frame received a transform that is newer than its others. @param now  ROS time of its arrival
  void note(std::uint32_t frame, Time stamp, Time now);
  /// Notes that frames were added, got another parent, or got another static transform.
  void noteStructure() { structure_ = true; }

  /// Whether the next tick can be made. It can if every awaited frame has news, or if the structure of the frames has
  /// changed. It can also if a transform arrived since await(), and the frames without news no longer keep up. False if
  /// no frame is awaited and nothing has changed.
  bool complete() const {
    const bool others_left_behind = heard_ && newest_ - tick_ > max_wait_;
    return structure_ || (!awaited_.empty() && (missing_ == 0 || others_left_behind));
  }

 private:
  enum class Wait : std::uint8_t { none, missing, has_news };

  const Time max_wait_;
  Time tick_{0};
  Time newest_{0};  // newest stamp of the awaited frames; a stamp ahead of ROS time counts as the time of its arrival
  std::vector<std::uint32_t> awaited_;
  std::vector<Wait> waits_;  // by frame number
  std::size_t missing_ = 0;  // number of awaited frames without news
  bool structure_ = false;
  bool heard_ = false;  // whether an awaited frame received a transform since await()
};

}  // namespace hgrid
