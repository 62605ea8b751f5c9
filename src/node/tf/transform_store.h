// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

#include "node/tf/frame_history.h"
#include "node/tf/frame_table.h"

namespace hgrid {

/// Stores the checked transforms of all frames, for the ticks and for everything else.
///
/// One thread writes, that of the ticks, and reads without a lock. Any other thread reads through a Reading.
/// A call that throws has changed nothing.
class TransformStore {
 public:
  /// @param cache       [ns] how long transforms are kept
  /// @param max_frames  as in FrameTable
  TransformStore(Time cache, std::size_t max_frames) : cache_(cache), table_(max_frames) {}
  TransformStore(const TransformStore&) = delete;
  TransformStore& operator=(const TransformStore&) = delete;

  Time cache() const { return cache_; }

  // The writing thread only.
  /// The frames' names, numbers and parents.
  const FrameTable& table() const { return table_; }
  const FrameHistory& history(std::uint32_t frame) const { return histories_[frame]; }
  /// As FrameTable::admit().
  std::uint32_t admit(const std::string& parent, const std::string& child);
  /// The frame is static at this pose in its parent.
  void fix(std::uint32_t frame, const std::string& parent, const FramePose& parent_from_frame);
  /// Stores the newest sample of a frame that moves.
  /// @param sample  its parent is set here
  /// @param now     [ROS time] a stamp far ahead of it drops no other sample
  void advance(std::uint32_t frame, const std::string& parent, PoseSample sample, Time now);
  /// As FrameHistory::fill(), in the frame's newest parent.
  bool fill(std::uint32_t frame, PoseSample sample);
  /// Drops the stamps of all samples. Static poses stay.
  void forgetStamps();

  /// Allows any thread to read. The writing thread waits until it is destroyed, so it should live for microseconds.
  class Reading {
   public:
    explicit Reading(const TransformStore& store) : store_(store), lock_(store.mutex_) {}
    const FrameTable& table() const { return store_.table_; }
    const FrameHistory& history(std::uint32_t frame) const { return store_.histories_[frame]; }

   private:
    const TransformStore& store_;
    std::lock_guard<std::mutex> lock_;
  };

 private:
  void makeRoom();
  std::uint32_t numberOfParent(std::uint32_t frame, const std::string& parent);

  const Time cache_;
  mutable std::mutex mutex_;  // held by the writing thread while it changes what stands below
  FrameTable table_;
  std::deque<FrameHistory> histories_;  // by number; may have more entries than the table
};

}  // namespace hgrid
