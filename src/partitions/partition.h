// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "partitions/pair_sink.h"
#include "partitions/query_shape.h"

namespace hgrid {
namespace book {

/// The common part of the broad phases of chapter 7 in Ericson, Real-Time Collision Detection, 2005.
///
/// It holds the boxes in a table by id and checks what callers pass. It turns the candidates of a partition into exact
/// answers. A partition (a derived class) holds only its own structure, which it can always build again from the table.
///
/// - A change writes the table first. Then it calls added(), removed() or moved(), and the structure follows the change
///   if it can. If it cannot, the structure is *stale*, and the next search calls build(). This happens if the
///   structure is static, if it would become slow, or if memory ran out. So no change leaves a structure half changed.
/// - Several threads may search at the same time. If the structure is stale, one of them builds it, and the others
/// wait.
///
/// How to read a partition: build() shows the structure, findPairs() and candidates() show the searches. The rest keeps
/// the structure up to date. partition.cpp has the table, partition_changes.cpp the changes, and partition_searches.cpp
/// the exact answers.
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
  /// Whether the structure has followed a change. A later value means more work before the next search.
  enum class Followed {
    yes,     ///< it matches the table
    settle,  ///< it matches the table after settle(), which the next search calls
    no,      ///< it is stale: the next search calls build()
  };

  /// @param name  name of the class, for error messages
  explicit Partition(const char* name) : name_(name) {}

  // What each partition implements. While a function without `const` runs, no other function runs. Several threads may
  // call functions with `const` at the same time.

  /// Discards the structure and makes it again from the boxes in the table. May throw std::bad_alloc.
  virtual void build() = 0;
  // The next three functions let the structure follow a change. If one of them throws, the structure is stale.
  /// Follows a new box. The table already holds it.
  virtual Followed added(ProxyId) { return Followed::no; }
  /// Follows the removal of a box. `from` is the box as the structure knows it. Do not use box(id): moved() calls
  /// this function when the table already holds the new box.
  virtual Followed removed(ProxyId, const Aabb& from) {
    static_cast<void>(from);
    return Followed::no;
  }
  /// Follows the move of a box from `from` to the box in the table. By default it removes the box and adds it again.
  virtual Followed moved(ProxyId id, const Aabb& from) {
    const Followed gone = removed(id, from);
    return gone == Followed::no ? gone : std::max(gone, added(id));
  }
  /// Brings the structure up to date before a search, if a change returned Followed::settle.
  virtual void settle() {}
  /// Whether the structure holds pairs. Then the fixed flags and the pair bound decide which ones, so a change of these
  /// settings makes it stale.
  virtual bool tracksPairs() const { return false; }
  /// Whether building is faster than following each move if most boxes move in one call.
  virtual bool rebuildsWhenMostMove() const { return true; }

  /// Adds each pair to the sink, once.
  virtual void findPairs(PairSink& sink) const = 0;
  /// Appends the ids of all boxes that the shape touches, each once, and perhaps of boxes near it.
  virtual void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const = 0;
  /// Finds the nearest boxes for valid arguments and 1 <= count <= size(). The default searches spheres of growing
  /// radius.
  virtual void findNearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                           std::vector<NearHit>& found) const;
  /// Checks the structure: calls require() for each invariant.
  virtual void checkStructure() const = 0;
  /// Returns the memory [bytes] of the structure.
  virtual std::size_t structureBytes() const = 0;
  /// Appends the regions of the cells or nodes that drawing() returns.
  virtual void draw(std::vector<Aabb>& regions) const = 0;

  /// Builds or settles the structure if this is necessary. The searches of this class call it first. A partition calls
  /// it only in a public search of its own. Any thread may call it.
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
  /// The largest number of pairs that a partition should track: 8 times the sum of pair bound and number of boxes, or
  /// PairBound::kNone. So the memory for tracked pairs is bounded like the search.
  std::size_t mostTrackedPairs() const;
  /// A box that contains all stored boxes. It is exact in build(). Afterwards it only grows, until the next build().
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
  // Each of these functions changes the table and lets the structure follow. Arguments are valid and room is reserved.
  void add(ProxyId id, const Aabb& box) noexcept;
  void erase(ProxyId id) noexcept;
  void shift(ProxyId id, const Aabb& box) noexcept;
  void replaceAll(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) noexcept;
  void rebuild();
  void collectInOrder(std::vector<ProxyPair>& pairs) const;

  const char* name_;
  std::vector<Aabb> boxes_;         // by id
  std::vector<char> stored_;        // by id
  std::vector<char> fixed_;         // by id; covers the same ids as `stored_`
  std::size_t count_ = 0;           // number of stored boxes
  std::vector<ProxyId> fixed_ids_;  // as given to setFixed(); an id may be above all stored ids
  OverlapFilter filter_;
  PairBound bound_;
  Aabb world_;

  mutable std::mutex building_;         // held while a search builds or settles the structure
  std::atomic<bool> stale_{true};       // the structure does not match the table
  std::atomic<bool> unsettled_{false};  // settle() must run
  std::size_t changes_ = 0;             // number of changes since the structure was built
  std::size_t built_with_ = 0;          // number of boxes when it was built
};

}  // namespace book
}  // namespace hgrid
