// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>

#include "partitions/kd_nodes.h"
#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// A k-d tree of static boxes (Ericson, Real-Time Collision Detection, 2005, sections 7.3.7 and 7.4.1).
///
/// KdNodes describes the tree, its visits, and how they differ from the book. Every change of a box makes the next
/// search build the whole tree again.
///
/// - A segment visits near nodes first. firstAlong() stops where nothing nearer than the best hit can follow.
/// - A search for the nearest boxes begins with a sphere as large as the limit allows, often infinite. Once it has
///   `count` boxes, each nearer box shrinks the sphere.
/// - The search for all pairs queries the tree with each box. The book does not describe one.
class KdTree final : public Partition {
 public:
  KdTree() : Partition("KdTree") {}

  /// Finds the box that along() would list first, without looking at boxes behind it; nullopt if the segment touches no
  /// box. Several threads may call this at the same time.
  std::optional<SegmentHit> firstAlong(const Segment& segment) const;

 private:
  void build() override { tree_.build(boxes(), storedIds()); }
  void findPairs(PairSink& sink) const override { findPairsByQueries(sink); }
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void findNearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                   std::vector<NearHit>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override { return tree_.bytes(); }
  void draw(std::vector<Aabb>& regions) const override;

  KdNodes tree_;
};

}  // namespace book
}  // namespace hgrid
