// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "partitions/uniform_grid.h"

namespace hgrid {
namespace book {

/// A uniform grid in hash buckets without keys (Ericson, Real-Time Collision Detection, 2005, section 7.1.3).
///
/// A bucket is a list of the boxes of all cells that the hash maps to it. So a list may also hold boxes of other cells,
/// which the first test of the bounds drops. Several cells of one query may share a bucket, so each query stamps the
/// buckets that it has visited (section 7.7.2). No key has to be compared, and no slot has to be marked as reusable.
///
/// Differs from the book, apart from what UniformGrid and CellHash describe:
/// - A box is in a bucket only once, also if several of its cells share this bucket.
/// - A pair is reported in the bucket of its reporting cell.
/// - If the boxes become many more than the buckets, the grid is built again with more buckets.
/// - A query that covers more cells than there are buckets goes through all buckets instead.
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
  std::vector<std::uint32_t> buckets_of_box_;  // buffer of added() and removed()
};

}  // namespace book
}  // namespace hgrid
