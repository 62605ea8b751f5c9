// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

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

  /// Returns the obstacles as they are now. Any thread may call this. If the tick thread changes them while a view
  /// exists, it first copies all of them, so a thread should not keep a view longer than it needs it.
  View view() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    {
      const std::lock_guard<std::mutex> counting(content_->mutex);
      ++content_->views;
    }
    const auto end = [content = content_](const PlacedObstacles*) {
      const std::lock_guard<std::mutex> counting(content->mutex);
      --content->views;
    };
    return {std::shared_ptr<const PlacedObstacles>(&content_->obstacles, end), revision_};
  }
  /// Returns the obstacles. Only the tick thread may call this.
  const PlacedObstacles& all() const { return content_->obstacles; }
  /// Returns View::revision. Only the tick thread may call this.
  std::uint64_t revision() const { return revision_; }

 private:
  struct Content {
    PlacedObstacles obstacles;
    std::mutex mutex;
    std::size_t views = 0;  // guarded by `mutex`: number of views that exist
  };

 public:
  /// Lets the tick thread change the obstacles. While it exists, view() waits.
  class Access {
   public:
    /// Copies the obstacles if a view exists. May throw std::bad_alloc. Then nothing changes.
    explicit Access(SharedObstacles& shared) : shared_(shared), lock_(shared.mutex_) {
      if (!isViewed()) return;
      auto copy = std::make_shared<Content>();
      copy->obstacles = shared_.content_->obstacles;
      shared_.content_ = std::move(copy);
    }
    /// Increases the revision.
    ~Access() { ++shared_.revision_; }
    Access(const Access&) = delete;
    Access& operator=(const Access&) = delete;
    /// Returns the obstacles, which may be changed.
    PlacedObstacles& all() const { return shared_.content_->obstacles; }

   private:
    bool isViewed() const {
      const std::lock_guard<std::mutex> counting(shared_.content_->mutex);
      return shared_.content_->views != 0;
    }

    SharedObstacles& shared_;
    std::lock_guard<std::mutex> lock_;
  };

  /// Memory that clear() needs. It is separate, because clear() must not fail.
  class Spare {
   public:
    Spare() : content_(std::make_shared<Content>()) {}

   private:
    friend class SharedObstacles;
    std::shared_ptr<Content> content_;
  };
  /// Removes all obstacles. Only the tick thread may call this.
  void clear(Spare spare) noexcept {
    const std::lock_guard<std::mutex> lock(mutex_);
    content_.swap(spare.content_);
    ++revision_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<Content> content_ = std::make_shared<Content>();
  std::uint64_t revision_ = 0;
};

}  // namespace hgrid
