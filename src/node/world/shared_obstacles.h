// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "node/world/obstacle_edits.h"

namespace hgrid {

/// The obstacles of the world. The tick thread changes them; any thread may look at them.
class SharedObstacles {
 public:
  /// The obstacles at one time.
  struct View {
    std::shared_ptr<const PlacedObstacles> obstacles;  ///< never null
    std::uint64_t revision = 0;                        ///< increases with each change
  };

  /// Returns the obstacles as they are now. Any thread may call this. The tick thread copies all obstacles if it
  /// changes them while a view exists, so do not keep it for long.
  View view() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {obstacles_, revision_};
  }
  /// Returns the obstacles, for the tick thread.
  const PlacedObstacles& all() const { return *obstacles_; }
  /// Returns View::revision of the obstacles, for the tick thread.
  std::uint64_t revision() const { return revision_; }

  /// Permission to change the obstacles, for the tick thread. While it exists, view() waits.
  class Access {
   public:
    /// May throw std::bad_alloc. Then nothing changes.
    explicit Access(SharedObstacles& shared) : shared_(shared), lock_(shared.mutex_) {
      if (shared_.obstacles_.use_count() > 1) {
        shared_.obstacles_ = std::make_shared<PlacedObstacles>(*shared_.obstacles_);
      }
    }
    ~Access() { ++shared_.revision_; }
    Access(const Access&) = delete;
    Access& operator=(const Access&) = delete;
    /// Returns the obstacles, which may be changed.
    PlacedObstacles& all() const { return *shared_.obstacles_; }

   private:
    SharedObstacles& shared_;
    std::lock_guard<std::mutex> lock_;
  };

  /// Replaces all obstacles by those in `next`, which gets the old ones. Does not throw. Only the tick thread may call
  /// this. @param next  not null
  void swap(std::shared_ptr<PlacedObstacles>& next) noexcept {
    const std::lock_guard<std::mutex> lock(mutex_);
    obstacles_.swap(next);
    ++revision_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<PlacedObstacles> obstacles_ = std::make_shared<PlacedObstacles>();
  std::uint64_t revision_ = 0;
};

}  // namespace hgrid
