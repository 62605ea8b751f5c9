// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// A snapshot together with the broad phase that it refers to. Only Scene writes them, before it hands out the
/// snapshot.
struct PooledSnapshot {
  /// Replaces the broad phase, also in the snapshot.
  void setBroadPhase(std::unique_ptr<BroadPhase> next) {
    snapshot.broad_phase_ = next.get();
    broad_phase = std::move(next);
  }

  Snapshot snapshot;
  std::unique_ptr<BroadPhase> broad_phase;  ///< null until a commit fills this object, and after release()
  std::uint64_t grid_revision = 0;          ///< revision of the structure that `broad_phase` was set up for
  bool finished = false;  ///< whether a commit has filled the snapshot; if the commit failed, it is not used again

  /// Releases what the next commit does not need: the cells of maps, the rooms, and the structure before the last
  /// change. Also releases the structure, with its bodies, unless it is the newest one. Keeps the memory of the arrays,
  /// so that a tick with a new structure need not allocate it.
  /// @param revision  the revision of the newest structure
  void release(std::uint64_t revision) {
    snapshot.cells_.clear();
    snapshot.rooms_.reset();
    snapshot.events_.before.reset();
    if (!snapshot.structure_ || snapshot.structure_->revision == revision) return;
    setBroadPhase(nullptr);  // it refers to the structure
    grid_revision = 0;
    snapshot.structure_.reset();
  }
};

/// Keeps the snapshots that nobody reads any more, so that later ticks can fill them again without allocating memory.
/// Also keeps the memory blocks of the shared pointers to these snapshots. Any thread may call the functions: each call
/// holds a lock for a short time.
///
/// The snapshots in the pool keep no map alive, and no bodies but those of the newest structure.
class SnapshotPool {
 public:
  SnapshotPool() {
    free_.reserve(kMostKept);
    free_blocks_.reserve(kMostKept);
  }
  ~SnapshotPool() {
    for (void* block : free_blocks_) ::operator delete(block);
  }
  SnapshotPool(const SnapshotPool&) = delete;
  SnapshotPool& operator=(const SnapshotPool&) = delete;

  std::unique_ptr<PooledSnapshot> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_.empty()) return nullptr;
    std::unique_ptr<PooledSnapshot> snapshot = std::move(free_.back());
    free_.pop_back();
    return snapshot;
  }
  void giveBack(std::unique_ptr<PooledSnapshot> snapshot) {
    std::unique_lock<std::mutex> lock(mutex_);
    std::uint64_t revision = 0;
    do {
      revision = revision_;
      lock.unlock();
      snapshot->release(revision);  // takes long, so the lock is not held
      lock.lock();
    } while (revision != revision_);
    if (free_.size() < kMostKept) free_.push_back(std::move(snapshot));
  }
  /// Releases all structures except this one, now and in later calls of giveBack(). Allocates no memory.
  void keepOnly(std::uint64_t revision) {
    std::array<std::unique_ptr<PooledSnapshot>, kMostKept> kept;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (revision == revision_) return;
      revision_ = revision;
      std::move(free_.begin(), free_.end(), kept.begin());
      free_.clear();
    }
    for (std::unique_ptr<PooledSnapshot>& snapshot : kept) {
      if (snapshot) giveBack(std::move(snapshot));
    }
  }

  /// Returns memory for the control block of a shared pointer to a snapshot. `size` is the same in every call.
  void* takeBlock(std::size_t size) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_blocks_.empty()) return ::operator new(size);
    void* block = free_blocks_.back();
    free_blocks_.pop_back();
    return block;
  }
  void giveBlockBack(void* block) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_blocks_.size() < kMostKept) {
      free_blocks_.push_back(block);
    } else {
      ::operator delete(block);
    }
  }

 private:
  static constexpr std::size_t kMostKept = 4;
  std::mutex mutex_;
  std::uint64_t revision_ = 0;  // of the newest structure
  std::vector<std::unique_ptr<PooledSnapshot>> free_;
  std::vector<void*> free_blocks_;
};

/// An allocator that takes the control block of a shared pointer from the pool.
template <class T>
struct PoolAllocator {
  using value_type = T;
  explicit PoolAllocator(std::shared_ptr<SnapshotPool> from) : pool(std::move(from)) {}
  template <class U>
  PoolAllocator(const PoolAllocator<U>& other) : pool(other.pool) {}
  T* allocate(std::size_t count) { return static_cast<T*>(pool->takeBlock(count * sizeof(T))); }
  void deallocate(T* block, std::size_t) { pool->giveBlockBack(block); }
  std::shared_ptr<SnapshotPool> pool;
};
template <class T, class U>
bool operator==(const PoolAllocator<T>& a, const PoolAllocator<U>& b) {
  return a.pool == b.pool;
}
template <class T, class U>
bool operator!=(const PoolAllocator<T>& a, const PoolAllocator<U>& b) {
  return a.pool != b.pool;
}

}  // namespace hgrid
