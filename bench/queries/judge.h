// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/measure/sample.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {

/// The correct hits of the first kFirst queries of a set, found by testing every box.
///
/// A query is not judged if a box is so near to the border between hit and miss that float rounding may decide, see
/// doubtOf(). Box queries need no rounding, so all of them are judged.
class Judge {
 public:
  static constexpr std::size_t kFirst = 1000;

  Judge(QueryKind kind, const QuerySet& queries, const std::vector<Aabb>& boxes);

  /// Number of queries that were tested: the first ones of the set.
  std::size_t size() const { return judged_.size(); }
  /// Whether the query is judged.
  bool judges(std::size_t query) const { return judged_[query]; }
  std::size_t judgedCount() const { return judged_count_; }
  /// Number of the correct hits of all judged queries, and their checksum.
  std::uint64_t count() const { return count_; }
  std::uint64_t checksum() const { return checksum_.value(); }

  /// Returns a number for the checksum that stands for one hit of one query.
  static std::uint64_t hit(std::size_t query, ProxyId id) { return std::uint64_t{query} << 32 | id; }

 private:
  std::vector<bool> judged_;
  std::size_t judged_count_ = 0;
  std::uint64_t count_ = 0;
  Checksum checksum_;
};

}  // namespace bench
}  // namespace hgrid
