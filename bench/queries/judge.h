// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/measure/sample.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {

/// The right hits of the first queries of a set, from a look at every box.
///
/// A query is not judged if some box lies so near to the border between hit and miss that the rounding of float may
/// decide: see doubtOf(). Boxes are compared without rounding, so of those all are judged.
class Judge {
 public:
  static constexpr std::size_t kFirst = 1000;

  Judge(QueryKind kind, const QuerySet& queries, const std::vector<Aabb>& boxes);

  /// Queries from the first on that may be judged, and whether each one is.
  std::size_t size() const { return judged_.size(); }
  bool judges(std::size_t query) const { return judged_[query]; }
  std::size_t judgedCount() const { return judged_count_; }
  /// Number of the right hits and their checksum.
  std::uint64_t count() const { return count_; }
  std::uint64_t checksum() const { return checksum_.value(); }

  static std::uint64_t hit(std::size_t query, ProxyId id) { return std::uint64_t{query} << 32 | id; }

 private:
  std::vector<bool> judged_;
  std::size_t judged_count_ = 0;
  std::uint64_t count_ = 0;
  Checksum checksum_;
};

}  // namespace bench
}  // namespace hgrid
