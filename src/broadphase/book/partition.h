// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include "broadphase/book/pair_sink.h"
#include "broadphase/book/query_shape.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace book {

/// The common part of the broad phases of chapter 7 in Ericson, Real-Time Collision Detection, 2005.
///
/// It holds the boxes in a table by id, checks what callers pass, and turns the candidates of a partition into exact
/// answers. A partition (a derived class) holds only its own structure, which it can always build again from the table.
///
/// - A change writes the table first, then lets the partition follow. If the partition cannot follow (it is static, it
///   would become slow, or memory ran out), the next search builds it again. So a change cannot leave it half changed.
/// - Several threads may search at the same time: a lock makes one of them build the structure, and the others wait.
class Partition : public BroadPhase {
 public:
  void insert(ProxyId id, const Aabb& box) final;
  void update(ProxyId id, const Aabb& box) final;
  void remove(ProxyId id) final;
  void clear() final;
  void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) final;
  void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) final;
  void setFixed(const std::vector<ProxyId>& ids) final;
  void setOverlapFilter(const OverlapFilter& filter) final { filter_ = filter; }
  void setPairBound(const PairBound& bound) final;

  std::size_t size() const final { return count_; }
  void overlappingPairs(std::vector<ProxyPair>& pairs) const final;
  bool boundedPairs(std::vector<ProxyPair>& pairs) const final;
  using BroadPhaseReader::along;
  using BroadPhaseReader::overlapping;
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) const final;
  void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const final;
  void along(const Segment& segment, std::vector<SegmentHit>& found) const final;
  void nearest(const Eigen::Vector3d& point, std::size_t count, double limit, std::vector<NearHit>& found) const final;
  void checkInvariants() const final;

  /// Returns the memory [bytes] of all stored data.
  std::size_t bytes() const;
  /// Returns the regions of the cells or nodes of the structure, for the drawings in the documentation.
  std::vector<Aabb> drawing() const;

 protected:
  /// What a partition made of a change. A later value asks for more work before the next search.
  enum class Followed {
    yes,     ///< the structure holds the change
    settle,  ///< as `yes`, but settle() must run before the next search
    no,      ///< the structure must be built again
  };

  /// @param name  name of the class, for error messages
  explicit Partition(const char* name) : name_(name) {}

  // What each partition implements. Functions without `const` run alone; the others may run at the same time.

  /// Discards the structure and makes it again from the boxes in the table. May throw std::bad_alloc.
  virtual void build() = 0;
  // The next three functions let the structure follow a change. A partition that throws is built again.
  /// Follows a new box, which the table already holds.
  virtual Followed added(ProxyId) { return Followed::no; }
  /// Follows the removal of a box. `from` is the box that the structure holds; moved() calls this when the table
  /// already holds another one.
  virtual Followed removed(ProxyId, const Aabb& from) {
    static_cast<void>(from);
    return Followed::no;
  }
  /// Follows the move of a box from `from` to the box in the table. By default it removes the box and adds it again.
  virtual Followed moved(ProxyId id, const Aabb& from) {
    const Followed gone = removed(id, from);
    return gone == Followed::no ? gone : std::max(gone, added(id));
  }
  /// Brings the structure up to date before a search, if a change asked for it.
  virtual void settle() {}
  /// Whether a structure whose pairs depend on the fixed flags has to be built again when they change.
  virtual bool tracksPairs() const { return false; }
  /// Whether to build again if most boxes move in one call.
  virtual bool rebuildsWhenMostMove() const { return true; }

  /// Adds all pairs to the sink.
  virtual void findPairs(PairSink& sink) const = 0;
  /// Appends the ids of all boxes that the shape touches, each once, and perhaps of boxes near it.
  virtual void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const = 0;
  /// Finds the nearest boxes; the arguments are checked. The default searches spheres of growing radius.
  virtual void findNearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                           std::vector<NearHit>& found) const;
  /// Checks the structure. Calls require().
  virtual void checkStructure() const = 0;
  /// Returns the memory [bytes] of the structure.
  virtual std::size_t structureBytes() const = 0;
  /// Appends the regions of the cells or nodes that drawing() returns.
  virtual void draw(std::vector<Aabb>& regions) const = 0;

  /// Brings the structure up to date. Every search calls this first; any thread may call it.
  void prepare() const;

  // The table, for the partitions.

  const std::vector<Aabb>& boxes() const { return boxes_; }
  const Aabb& box(ProxyId id) const { return boxes_[id]; }
  bool isStored(ProxyId id) const { return id < stored_.size() && stored_[id] != 0; }
  bool isFixed(ProxyId id) const { return fixed_[id] != 0; }
  /// All stored ids are below this number.
  std::size_t idEnd() const { return stored_.size(); }
  std::vector<ProxyId> storedIds() const;
  std::vector<Aabb> storedBoxes() const;
  /// The largest number of pairs that a partition should track: some more than a search may return, or no bound.
  std::size_t mostTrackedPairs() const;
  /// A box that contains all stored boxes.
  const Aabb& world() const { return world_; }
  /// findPairs() for partitions without a search for all pairs: queries the structure with each box that is not fixed.
  void findPairsByQueries(PairSink& sink) const;
  /// @throws std::logic_error that names the invariant, unless it holds
  void require(bool holds, const char* invariant) const;

  /// The order of the results of nearest().
  static bool isNearer(const NearHit& a, const NearHit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.id < b.id;
  }

 private:
  void requireValid(const Aabb& box) const;
  void requireStored(ProxyId id) const;
  void requireAscending(const std::vector<ProxyId>& ids) const;
  void requireBulk(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) const;
  void reserve(ProxyId id);
  template <class Follow>
  void follow(Follow&& follow) noexcept;
  void add(ProxyId id, const Aabb& box) noexcept;
  void erase(ProxyId id) noexcept;
  void shift(ProxyId id, const Aabb& box) noexcept;
  void replaceAll(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) noexcept;
  void rebuild();
  void collectInOrder(std::vector<ProxyPair>& pairs) const;

  const char* name_;
  std::vector<Aabb> boxes_;   // by id
  std::vector<char> stored_;  // by id
  std::vector<char> fixed_;   // by id
  std::size_t count_ = 0;
  std::vector<ProxyId> fixed_ids_;
  OverlapFilter filter_;
  PairBound bound_;
  Aabb world_;

  mutable std::mutex building_;
  std::atomic<bool> stale_{true};       // the structure does not match the table
  std::atomic<bool> unsettled_{false};  // settle() must run
  std::size_t changes_ = 0, built_with_ = 0;
};

}  // namespace book
}  // namespace hgrid
