// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "broadphase/book/uniform_grid.h"

namespace hgrid {
namespace book {

/// A uniform grid in hash buckets without keys (Ericson, Real-Time Collision Detection, 2005, section 7.1.3).
///
/// The bucket of a cell is the list of its boxes. Different cells may share a bucket, so a list also holds foreign
/// boxes: a test of the boxes comes first and drops them. Several cells of one query may share a bucket, so each query
/// stamps the buckets that it has visited (section 7.7.2). There is nothing to delete but list entries.
///
/// Differs from the book: see HashedGrid, which treats large boxes and repeated pairs in the same way.
class BucketGrid final : public UniformGrid {
 public:
  explicit BucketGrid(CellRule rule = CellRule::objects) : UniformGrid("BucketGrid", rule) {}

 private:
  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId id, const Aabb& from) override;
  void findPairsInCells(PairSink& sink) const override;
  void candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  std::uint32_t bucketOf(const Cell& cell) const;
  void bucketsOf(const CellRange& cells, std::vector<std::uint32_t>& buckets) const;

  std::vector<std::vector<ProxyId>> buckets_;  // their number is a power of two
  std::vector<std::uint32_t> buckets_of_box_;  // buffer of changes
};

}  // namespace book
}  // namespace hgrid
