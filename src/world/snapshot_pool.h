// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Snapshots that nobody reads any more, to be filled again, and the memory that shared pointers to them took: a
/// steady tick allocates nothing. The lock is held for a push or a pop only.
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

  std::unique_ptr<Snapshot> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_.empty()) return nullptr;
    std::unique_ptr<Snapshot> snapshot = std::move(free_.back());
    free_.pop_back();
    return snapshot;
  }
  void giveBack(std::unique_ptr<Snapshot> snapshot) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_.size() < kMostKept) free_.push_back(std::move(snapshot));
  }

  /// Memory for what a shared pointer keeps beside its snapshot; always of one size.
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
  std::vector<std::unique_ptr<Snapshot>> free_;
  std::vector<void*> free_blocks_;
};

/// Lets a shared pointer take its memory from the pool.
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
