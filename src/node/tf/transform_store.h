// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "node/tf/frame_history.h"
#include "node/tf/frame_table.h"

namespace hgrid {

/// Stores the checked transforms of all frames.
///
/// Only one thread at a time writes (see TfReader::Hold); it also reads, without a lock. Any other thread must read
/// through a Reading. A call that throws changes nothing.
class TransformStore {
 public:
  /// @param cache        [ns] how long transforms are kept
  /// @param max_frames   limits the number of frames, as in FrameTable
  /// @param max_samples  how many transforms of one frame are kept; the oldest are dropped
  TransformStore(Time cache, std::size_t max_frames, std::size_t max_samples = kMaxSamples)
      : cache_(cache), max_samples_(max_samples), table_(max_frames) {}
  TransformStore(const TransformStore&) = delete;
  TransformStore& operator=(const TransformStore&) = delete;

  static constexpr std::size_t kMaxSamples = 10000;  ///< default of `max_samples`

  Time cache() const { return cache_; }
  /// Returns how many samples were dropped because of `max_samples` since the last call. Only the writing thread may
  /// call it.
  std::size_t takeDropped() { return std::exchange(dropped_, 0); }

  // Only the writing thread may call the functions from here to Reading.
  /// Returns the names, numbers and parents of all frames.
  const FrameTable& table() const { return table_; }
  const FrameHistory& history(std::uint32_t frame) const { return histories_[frame]; }
  /// Does the same as FrameTable::admit().
  std::uint32_t admit(std::string_view parent, std::string_view child);
  /// Does the same as FrameTable::again(). That changes nothing that a Reading can see, so it needs no lock.
  std::uint32_t again(std::string_view parent, std::string_view child) { return table_.again(parent, child); }
  /// Starts to load what is stored of a frame into the processor's cache. Changes nothing.
  void prefetch(std::uint32_t frame) const;
  /// Does the same as FrameTable::need().
  void need(const std::vector<std::string>& names);
  /// Does the same as FrameTable::setFree().
  bool setFree(std::set<std::string, std::less<>> names);
  /// Whether a free frame has only a static pose. Nobody may use this pose, because it says nothing about the joint:
  /// robot_state_publisher sends a planar joint as if it were fixed.
  bool isFreeButStatic(std::uint32_t frame) const { return table_.isFree(frame) && !histories_[frame].moves(); }
  /// Makes the frame static at this pose in its parent.
  void fix(std::uint32_t frame, std::string_view parent, const FramePose& parent_from_frame);
  /// Stores the newest sample of a frame that moves.
  /// @param sample  this function sets its `parent`
  /// @param now     current ROS time; a sample whose stamp is far ahead of it does not drop older samples
  void advance(std::uint32_t frame, std::string_view parent, PoseSample sample, Time now);
  /// Does the same for a frame whose parent has not changed.
  void advance(std::uint32_t frame, PoseSample sample, Time now);
  /// Does the same as FrameHistory::fill(), with the frame's newest parent as the parent of the sample.
  bool fill(std::uint32_t frame, PoseSample sample);
  /// Drops the stamps of all samples. Static poses stay.
  void forgetStamps();

  /// Makes several changes cheaper: other threads wait until the end of this object, instead of until the end of each
  /// change. Destroy it within microseconds. Only the writing thread may create one. There may be one inside another.
  class Writing {
   public:
    explicit Writing(TransformStore& store) : store_(store), is_outer_(!store.writing_) {
      if (is_outer_) store_.beginWriting();
    }
    ~Writing() {
      if (is_outer_) store_.endWriting();
    }
    Writing(const Writing&) = delete;
    Writing& operator=(const Writing&) = delete;

   private:
    TransformStore& store_;
    const bool is_outer_;
  };
  /// Lets other threads read while the writing thread does something that may take long, such as writing to the log.
  class Pause {
   public:
    explicit Pause(TransformStore& store) : store_(store), was_writing_(store.writing_) {
      if (was_writing_) store_.endWriting();
    }
    ~Pause() {
      if (was_writing_) store_.beginWriting();
    }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    TransformStore& store_;
    const bool was_writing_;
  };

  /// Gives any thread read access. The writing thread waits while a Reading exists, so destroy it within microseconds.
  class Reading {
   public:
    explicit Reading(const TransformStore& store) : store_(store), lock_(store.mutex_) {}
    const FrameTable& table() const { return store_.table_; }
    const FrameHistory& history(std::uint32_t frame) const { return store_.histories_[frame]; }
    bool isFreeButStatic(std::uint32_t frame) const { return store_.isFreeButStatic(frame); }

   private:
    const TransformStore& store_;
    std::lock_guard<std::mutex> lock_;
  };

 private:
  void beginWriting() {
    mutex_.lock();
    writing_ = true;
  }
  void endWriting() {
    writing_ = false;
    mutex_.unlock();
  }
  void makeRoom();
  std::uint32_t numberOfParent(std::uint32_t frame, std::string_view parent);
  void append(std::uint32_t frame, const PoseSample& sample, Time now);

  const Time cache_;
  const std::size_t max_samples_;
  std::size_t dropped_ = 0;
  bool writing_ = false;      // writing thread only: whether it holds mutex_
  mutable std::mutex mutex_;  // the writing thread holds it while it changes the members below
  FrameTable table_;
  std::deque<FrameHistory> histories_;  // indexed by frame number; may have more entries than the table
};

}  // namespace hgrid
